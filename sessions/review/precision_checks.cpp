// SPDX-License-Identifier: Apache-2.0
#include "sessions/review/precision_checks.h"

#include <algorithm>
#include <cmath>
#include <numbers>
#include <optional>
#include <string>

#include "sessions/evaluation/pose_sigma.h"
#include "sessions/review/check_making.h"
#include "sessions/session/input_sigmas.h"

namespace boresight::sessions {
namespace {

constexpr CheckName kNormal{"covariance_normal", "Covariance along the view axis"};
constexpr CheckName kLateral{"covariance_lateral", "Covariance across the view axis"};
constexpr CheckName kRotation{"covariance_rotation", "Covariance of the axis's direction"};
constexpr CheckName kProjection{"covariance_projection", "Covariance in the image"};

constexpr const char* kNotRequired = "The requirement does not name it.";
constexpr const char* kNoCovariance = "The pose has no covariance.";
constexpr const char* kPictureRemedy =
    "The edges seen do not fix the pose so well: take a nearer image, or one that shows more of "
    "the station.";
constexpr const char* kInputsRemedy =
    "The picture alone would pass: measure the part, calibrate the camera, and state how well "
    "(mesh_scale_sigma, calibration_sigma); or take a nearer image.";

/// One sigma of what is judged, of the picture alone and with mesh and camera.
struct Sigmas {
  double picture = 0.0;
  double total = 0.0;
};

/// "3", "2.5".
std::string sigmasText(double sigmas) {
  std::string text = sentenceNumber(sigmas);
  if (text.find('.') == std::string::npos) return text;
  text.erase(text.find_last_not_of('0') + 1);
  if (text.ends_with('.')) text.pop_back();
  return text;
}

class PrecisionChecks {
 public:
  PrecisionChecks(const ReviewSubject& subject, const CheckLimits& limits)
      : subject_(subject), limits_(limits) {
    if (!subject.covariance.known()) return;
    picture_ = poseSigma(subject.covariance.picture, endEffector());
    total_ = poseSigma(subject.covariance.total(), endEffector());
  }

  /// At the end effector, or at the camera.
  Check ofTranslation(const CheckName& name, double PoseSigma::*member,
                      std::optional<double> required_mm) const {
    return check(name, sigmasOf(member), required_mm, "mm",
                 std::string(" at the ") + judgedPlace(endEffector()));
  }

  Check ofRotation(std::optional<double> required_deg) const {
    std::optional<double> required_mrad;
    if (required_deg) required_mrad = *required_deg * 1e3 * std::numbers::pi / 180.0;
    return check(kRotation, sigmasOf(&PoseSigma::out_of_plane_mrad), required_mrad, "mrad", "");
  }

  Check inImage(std::optional<double> required_px) const {
    std::optional<Sigmas> sigmas;
    if (required_px && picture_ && total_ && subject_.loaded != nullptr) {
      const auto vertices = matchedVertices(subject_.loaded->scene.view());
      const auto sigma_px = [&](const Matrix6d& covariance) {
        return projectionSigma(subject_.loaded->source.camera, subject_.camera_from_station,
                               vertices, covariance);
      };
      const auto picture_px = sigma_px(subject_.covariance.picture);
      const auto total_px = sigma_px(subject_.covariance.total());
      if (picture_px && total_px) sigmas = {*picture_px, *total_px};
    }
    return check(kProjection, sigmas, required_px, "px", "");
  }

 private:
  std::optional<Pose> endEffector() const {
    if (subject_.loaded == nullptr) return {};
    return subject_.loaded->source.camera_from_end_effector;
  }

  std::optional<Sigmas> sigmasOf(double PoseSigma::*member) const {
    if (!picture_ || !total_) return {};
    return Sigmas{*picture_.*member, *total_.*member};
  }

  Check check(const CheckName& name, const std::optional<Sigmas>& sigma,
              std::optional<double> required, const std::string& unit,
              const std::string& place) const {
    if (!required) return notAskedCheck(name, kNotRequired);
    if (!sigma) return notAskedCheck(name, kNoCovariance);
    const double figure = limits_.sigmas * sigma->total;
    const bool by_inputs = limits_.sigmas * sigma->picture <= *required;
    return measuredCheck(name, unit, figure, *required, LimitSide::kAtMost,
                         sigmasText(limits_.sigmas) + " sigma" + place + " are " +
                             sentenceNumber(figure) + " " + unit + ". " + inputsText(*sigma, unit),
                         by_inputs ? kInputsRemedy : kPictureRemedy);
  }

  std::string inputsText(const Sigmas& sigma, const std::string& unit) const {
    const double inputs =
        std::sqrt(std::max(0.0, sigma.total * sigma.total - sigma.picture * sigma.picture));
    std::string text = "The picture alone says " + sentenceNumber(limits_.sigmas * sigma.picture) +
                       " " + unit + "; the pose is no better than the mesh's scale";
    if (subject_.loaded == nullptr) return text + " and the camera's calibration allow.";
    const InputSigmas known(subject_.loaded->source);
    return text + " (" + meshScaleText(known) + ") and the camera's calibration (" +
           calibrationText(known) + ") allow: " + sentenceNumber(limits_.sigmas * inputs) + " " +
           unit + ".";
  }

  const ReviewSubject& subject_;
  const CheckLimits& limits_;
  std::optional<PoseSigma> picture_;
  std::optional<PoseSigma> total_;
};

}  // namespace

void addPrecisionChecks(const ReviewSubject& subject, const CheckLimits& limits,
                        std::vector<Check>& checks) {
  const PrecisionChecks made(subject, limits);
  const Requirement& required = subject.requirement;
  checks.push_back(made.ofTranslation(kNormal, &PoseSigma::normal_mm, required.normal_mm));
  checks.push_back(made.ofTranslation(kLateral, &PoseSigma::lateral_mm, required.lateral_mm));
  checks.push_back(made.ofRotation(required.rotation_deg));
  checks.push_back(made.inImage(required.projection_px));
}

}  // namespace boresight::sessions
