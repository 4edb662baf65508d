// SPDX-License-Identifier: Apache-2.0
#include "sessions/checks/pose_quality.h"

#include <algorithm>
#include <cmath>

#include "sessions/decision/check_limits.h"
#include "sessions/evaluation/pose_error.h"
#include "sessions/text/plain_text.h"
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

/// Standard deviation in the image; without figures where it is not limited or the covariance is
/// not `known`.
PrecisionFigure imageFigure(const ReviewSubject& subject, double sigmas, bool known) {
  PrecisionFigure figure{
      kProjection, "in the image", "px", subject.requirement.projection_px, {}, {}, {}};
  if (!figure.required || !known || subject.loaded == nullptr) return figure;
  const PoseComparer comparer = subject.comparer();
  const auto sigma_px = [&](const Matrix6d& covariance) -> std::optional<double> {
    const auto one_sigma_px = comparer.projectionSigma_px(subject.camera_from_station, covariance);
    return one_sigma_px ? std::optional(sigmas * *one_sigma_px) : std::nullopt;
  };
  figure.found = sigma_px(subject.covariance.total());
  figure.by_image = sigma_px(subject.covariance.picture);
  if (!figure.by_image) figure.found.reset();
  return figure;
}

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
  const std::optional<Pose> end_effector = subject.endEffector();
  const std::string place = std::string(" at the ") + judgedPlace(end_effector);
  std::optional<PoseSigma> by_image, total;
  if (subject.covariance.known()) {
    by_image = poseSigma(subject.determined(subject.covariance.picture), end_effector);
    total = poseSigma(subject.determined(subject.covariance.total()), end_effector);
  }
  const bool known = by_image && total;
  const auto figure = [&](const CheckName& check, const char* where, const char* unit,
                          double PoseSigma::*member, std::optional<double> limit,
                          const std::string& at) {
    PrecisionFigure result{check, where, unit, limit, {}, {}, at};
    if (!known) return result;
    result.found = sigmas * (*total.*member);
    result.by_image = sigmas * (*by_image.*member);
    return result;
  };
  const Requirement& required = subject.requirement;
  PoseQuality quality;
  quality.sigmas = sigmas;
  quality.figures = {figure(kNormal, "along the view axis", "mm", &PoseSigma::normal_mm,
                            required.normal_mm, place),
                     figure(kLateral, "across the view axis", "mm", &PoseSigma::lateral_mm,
                            required.lateral_mm, place),
                     figure(kRotation, "of the view axis", "mrad", &PoseSigma::out_of_plane_mrad,
                            rotationLimit_mrad(required), ""),
                     imageFigure(subject, sigmas, known)};
  return quality;
}

std::string unconfirmedSigmasText(int degrees_of_freedom) {
  constexpr int kLeast = 6;
  if (degrees_of_freedom >= kLeast) return "";
  return "The annotations have " + countText(degrees_of_freedom, "degree") +
         " of freedom, which cannot confirm their sigmas: annotate more points.";
}

PoseQuality runQuality(const Session& session, const std::shared_ptr<const LoadedCase>& loaded,
                       const LocalizationTrace& run) {
  const ReviewSubject subject = runSubject(loaded, requirementOf(session, loaded->source), run);
  return poseQuality(subject, checkLimits(session.review.preset, session.review.limits).sigmas);
}

}  // namespace boresight::sessions
