// SPDX-License-Identifier: Apache-2.0
#include "sessions/review/precision_checks.h"

#include <algorithm>
#include <cmath>
#include <numbers>
#include <optional>
#include <string>

#include "sessions/evaluation/pose_sigma.h"
#include "sessions/review/calibration_share.h"
#include "sessions/review/check_making.h"

namespace boresight::sessions {
namespace {

constexpr CheckName kNormal{"covariance_normal", "Covariance along the view axis"};
constexpr CheckName kLateral{"covariance_lateral", "Covariance across the view axis"};
constexpr CheckName kRotation{"covariance_rotation", "Covariance of the axis's direction"};
constexpr CheckName kProjection{"covariance_projection", "Covariance in the image"};

constexpr const char* kNotRequired = "The requirement does not name it.";
constexpr const char* kNoCovariance = "The pose has no covariance.";
constexpr const char* kRemedy =
    "The edges seen do not fix the pose so well: take a nearer image, or one that shows more of "
    "the station.";
constexpr const char* kCalibrationRemedy =
    "Without the calibration's share it would pass: calibrate the camera better.";
/// So many places give the sums to a percent.
constexpr std::size_t kPlaces = 4000;

/// One sigma of what is judged, of the matching alone and with the calibration.
struct Sigmas {
  double alone = 0.0;
  double with_calibration = 0.0;
  bool calibration_known = false;
};

/// "3", "2.5".
std::string sigmasText(double sigmas) {
  std::string text = sentenceNumber(sigmas);
  if (text.find('.') == std::string::npos) return text;
  text.erase(text.find_last_not_of('0') + 1);
  if (text.ends_with('.')) text.pop_back();
  return text;
}

std::string shareText(const Sigmas& sigma, const CheckLimits& limits, const std::string& unit) {
  if (!sigma.calibration_known) return " The calibration's share is not known and left out.";
  const double share = std::sqrt(
      std::max(0.0, sigma.with_calibration * sigma.with_calibration - sigma.alone * sigma.alone));
  return " The calibration's share of it is " + sentenceNumber(limits.sigmas * share) + " " + unit +
         ".";
}

Check sigmaCheck(const CheckName& name, const std::optional<Sigmas>& sigma,
                 std::optional<double> required, const std::string& unit,
                 const CheckLimits& limits) {
  if (!required) return notAskedCheck(name, kNotRequired);
  if (!sigma) return notAskedCheck(name, kNoCovariance);
  const double figure = limits.sigmas * sigma->with_calibration;
  const bool calibration_only = limits.sigmas * sigma->alone <= *required;
  return measuredCheck(name, unit, figure, *required, LimitSide::kAtMost,
                       sigmasText(limits.sigmas) + " sigma are " + sentenceNumber(figure) + " " +
                           unit + "." + shareText(*sigma, limits, unit),
                       calibration_only ? kCalibrationRemedy : kRemedy);
}

/// Root of the mean variance of a place's two coordinates together, px.
std::optional<double> projectionSigma(const ReviewSubject& subject,
                                      const std::vector<PredictedPlace>& places,
                                      const Matrix6d& covariance) {
  double variance = 0.0;
  double seen = 0.0;
  for (const PredictedPlace& place : places) {
    PlaceDerivative by;
    if (!placeDerivative(subject.loaded->source.camera, subject.camera_from_station,
                         place.point_in_station_m, by))
      continue;
    variance += (by.by_pose * covariance * by.by_pose.transpose()).trace();
    seen += 1.0;
  }
  if (seen == 0.0 || !(variance >= 0.0)) return {};
  return std::sqrt(variance / seen);
}

/// A pose's sigmas with and without the calibration.
class SigmaPair {
 public:
  SigmaPair(const ReviewSubject& subject, const CheckLimits& limits, const PredictedEdges& edges)
      : subject_(subject), places_(thinned(edges.places, kPlaces)) {
    const bool asked = limits.focal_sigma_px > 0.0 || limits.centre_sigma_px > 0.0;
    std::optional<Matrix6d> calibration;
    if (asked && subject.loaded != nullptr)
      calibration =
          calibrationCovariance(places_, subject.loaded->source.camera, subject.camera_from_station,
                                limits.focal_sigma_px, limits.centre_sigma_px);
    known_ = calibration.has_value();
    whole_ = subject.covariance;
    if (calibration) whole_ += *calibration;
    alone_sigma_ = poseSigma(subject.covariance, endEffector());
    if (alone_sigma_) whole_sigma_ = poseSigma(whole_, endEffector());
  }

  std::optional<Sigmas> of(double PoseSigma::*member) const {
    if (!alone_sigma_ || !whole_sigma_) return {};
    return Sigmas{*alone_sigma_.*member, *whole_sigma_.*member, known_};
  }

  std::optional<Sigmas> ofProjection() const {
    if (!alone_sigma_ || subject_.loaded == nullptr) return {};
    const auto alone = projectionSigma(subject_, places_, subject_.covariance);
    const auto with_calibration = projectionSigma(subject_, places_, whole_);
    if (!alone || !with_calibration) return {};
    return Sigmas{*alone, *with_calibration, known_};
  }

 private:
  std::optional<Pose> endEffector() const {
    if (subject_.loaded == nullptr) return {};
    return subject_.loaded->source.camera_from_end_effector;
  }

  const ReviewSubject& subject_;
  std::vector<PredictedPlace> places_;
  bool known_ = false;
  Matrix6d whole_ = Matrix6d::Zero();
  std::optional<PoseSigma> alone_sigma_;
  std::optional<PoseSigma> whole_sigma_;
};

}  // namespace

void addPrecisionChecks(const ReviewSubject& subject, const CheckLimits& limits,
                        const PredictedEdges& edges, std::vector<Check>& checks) {
  const SigmaPair sigmas(subject, limits, edges);
  const Requirement& required = subject.requirement;
  std::optional<double> rotation_mrad;
  if (required.rotation_deg)
    rotation_mrad = *required.rotation_deg * 1e3 * std::numbers::pi / 180.0;
  checks.push_back(
      sigmaCheck(kNormal, sigmas.of(&PoseSigma::normal_mm), required.normal_mm, "mm", limits));
  checks.push_back(
      sigmaCheck(kLateral, sigmas.of(&PoseSigma::lateral_mm), required.lateral_mm, "mm", limits));
  checks.push_back(sigmaCheck(kRotation, sigmas.of(&PoseSigma::out_of_plane_mrad), rotation_mrad,
                              "mrad", limits));
  const auto in_image = required.projection_px ? sigmas.ofProjection() : std::nullopt;
  checks.push_back(sigmaCheck(kProjection, in_image, required.projection_px, "px", limits));
}

}  // namespace boresight::sessions
