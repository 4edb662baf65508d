// SPDX-License-Identifier: Apache-2.0
#include "sessions/checks/pose_quality.h"

#include <algorithm>
#include <cmath>

#include "sessions/checks/pose_uncertainty.h"
#include "sessions/decision/check_limits.h"
#include "sessions/evaluation/pose_error.h"
#include "sessions/text/text_table.h"

namespace boresight::sessions {
namespace {

constexpr CheckName kNormal{"covariance_normal", "Covariance along the view axis"};
constexpr CheckName kLateral{"covariance_lateral", "Covariance across the view axis"};
constexpr CheckName kRotation{"covariance_rotation", "Covariance of the axis's direction"};
constexpr CheckName kProjection{"covariance_projection", "Covariance in the image"};

/// "3", "2.5".
std::string plainNumber(double value) {
  std::string text = fixedText(value, 3);
  text.erase(text.find_last_not_of('0') + 1);
  if (text.ends_with('.')) text.pop_back();
  return text;
}

int decimalsOfTwoDigits(double value) {
  if (!(value > 0.0)) return 2;
  return std::clamp(1 - static_cast<int>(std::floor(std::log10(value))), 0, 4);
}

class Figures {
 public:
  Figures(const ReviewSubject& subject, double sigmas) : subject_(subject), sigmas_(sigmas) {
    std::optional<Pose> end_effector;
    if (subject.loaded != nullptr) end_effector = subject.loaded->source.camera_from_end_effector;
    place_ = std::string(" at the ") + judgedPlace(end_effector);
    if (!subject.covariance.known()) return;
    image_ = poseSigma(subject.covariance.picture, end_effector);
    total_ = poseSigma(subject.covariance.total(), end_effector);
  }

  PrecisionFigure ofTranslation(const CheckName& check, const char* where,
                                double PoseSigma::*member,
                                std::optional<double> required_mm) const {
    PrecisionFigure figure = of(check, where, "mm", member, required_mm);
    figure.place = place_;
    return figure;
  }

  PrecisionFigure of(const CheckName& check, const char* where, const char* unit,
                     double PoseSigma::*member, std::optional<double> required) const {
    PrecisionFigure figure{check, where, unit, required, {}, {}, {}};
    if (!image_ || !total_) return figure;
    figure.found = sigmas_ * (*total_.*member);
    figure.by_image = sigmas_ * (*image_.*member);
    return figure;
  }

  PrecisionFigure inImage(std::optional<double> required_px) const {
    PrecisionFigure figure{kProjection, "in the image", "px", required_px, {}, {}, {}};
    if (!required_px || !image_ || !total_ || subject_.loaded == nullptr) return figure;
    const auto vertices = matchedVertices(subject_.loaded->scene.view());
    const auto sigma_px = [&](const Matrix6d& covariance) -> std::optional<double> {
      const auto one = projectionSigma(subject_.loaded->source.camera, subject_.camera_from_station,
                                       vertices, covariance);
      return one ? std::optional(sigmas_ * *one) : std::nullopt;
    };
    figure.found = sigma_px(subject_.covariance.total());
    figure.by_image = sigma_px(subject_.covariance.picture);
    if (!figure.by_image) figure.found.reset();
    return figure;
  }

 private:
  const ReviewSubject& subject_;
  double sigmas_;
  std::string place_;
  std::optional<PoseSigma> image_;
  std::optional<PoseSigma> total_;
};

}  // namespace

std::string ofLimitText(double found, double limit, const std::string& unit) {
  constexpr int kMost = 6;
  int decimals = decimalsOfTwoDigits(limit);
  while (found != limit && decimals < kMost &&
         fixedText(found, decimals) == fixedText(limit, decimals))
    ++decimals;
  return fixedText(found, decimals) + " of " + fixedText(limit, decimals) + " " + unit;
}

const PrecisionFigure* PoseQuality::worst() const {
  const PrecisionFigure* worst = nullptr;
  for (const PrecisionFigure& figure : figures)
    if (figure.judged() &&
        (!worst || *figure.found * *worst->required > *worst->found * *figure.required))
      worst = &figure;
  return worst;
}

bool PoseQuality::holds() const {
  return worst() != nullptr && std::ranges::all_of(figures, [](const PrecisionFigure& figure) {
           return !figure.required || figure.holds();
         });
}

std::string PoseQuality::sigmasText() const { return plainNumber(sigmas) + " sigma"; }

std::string PoseQuality::text() const {
  const PrecisionFigure* figure = worst();
  if (figure == nullptr) {
    const bool limited = std::ranges::any_of(
        figures, [](const PrecisionFigure& each) { return each.required.has_value(); });
    return limited ? "The pose has no covariance" : "The requirement has no limits";
  }
  return figure->text() + " (" + sigmasText() + " " + figure->where + figure->place + ")";
}

PoseQuality poseQuality(const ReviewSubject& subject, double sigmas) {
  const Figures figures(subject, sigmas);
  const Requirement& required = subject.requirement;
  PoseQuality quality;
  quality.sigmas = sigmas;
  quality.figures = {figures.ofTranslation(kNormal, "along the view axis", &PoseSigma::normal_mm,
                                           required.normal_mm),
                     figures.ofTranslation(kLateral, "across the view axis", &PoseSigma::lateral_mm,
                                           required.lateral_mm),
                     figures.of(kRotation, "of the view axis", "mrad",
                                &PoseSigma::out_of_plane_mrad, rotationLimit_mrad(required)),
                     figures.inImage(required.projection_px)};
  return quality;
}

PoseQuality runQuality(const Session& session, const std::shared_ptr<const LoadedCase>& loaded,
                       const LocalizationTrace& run) {
  ReviewSubject subject;
  subject.loaded = loaded;
  subject.requirement = requirementOf(session, loaded->source);
  subject.camera_from_station = run.camera_from_station;
  subject.covariance =
      poseCovariance(loaded->source, loaded->scene.view(), run.camera_from_station, run.covariance);
  return poseQuality(subject, checkLimits(session.review.preset, session.review.limits).sigmas);
}

}  // namespace boresight::sessions
