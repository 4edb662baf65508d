// SPDX-License-Identifier: Apache-2.0
#include "sessions/evaluation/requirement_share.h"

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <limits>
#include <numbers>

#include "sessions/evaluation/pose_sigma.h"

namespace boresight::sessions {
namespace {

constexpr double kMradPerDegree = 1e3 * std::numbers::pi / 180.0;

/// Three significant digits.
std::string shortNumber(double value) {
  char text[32];
  (void)std::snprintf(text, sizeof text, "%.3g", value);
  return text;
}

}  // namespace

double requirementShare(const PoseError& error, const Requirement& requirement) {
  constexpr double kInfinite = std::numeric_limits<double>::infinity();
  double share = 0.0;
  const auto note = [&share](double value, const std::optional<double>& allowed) {
    if (allowed) share = std::max(share, *allowed > 0.0 ? std::abs(value) / *allowed : kInfinite);
  };
  note(error.normal_mm, requirement.normal_mm);
  note(error.lateral_mm, requirement.lateral_mm);
  note(error.rotation_mrad / kMradPerDegree, requirement.rotation_deg);
  note(error.projection_px.value_or(kInfinite), requirement.projection_px);
  return share;
}

std::string sigmaExcessText(const Matrix6d& covariance,
                            const std::optional<Pose>& camera_from_end_effector,
                            const Requirement& requirement) {
  const auto sigma = poseSigma(covariance, camera_from_end_effector);
  if (!sigma) return "";
  const std::string place = std::string(" at the ") + judgedPlace(camera_from_end_effector);
  double most = 1.0;
  std::string text;
  const auto note = [&](double value, const std::optional<double>& allowed, const char* unit,
                        const std::string& where) {
    if (!allowed || !(value > most * *allowed)) return;
    most = value / *allowed;
    text = shortNumber(value) + unit + where + ", " + shortNumber(most) + " times the " +
           shortNumber(*allowed) + unit + " required";
  };
  note(sigma->normal_mm, requirement.normal_mm, " mm", " along the view axis" + place);
  note(sigma->lateral_mm, requirement.lateral_mm, " mm", " across the view axis" + place);
  note(sigma->out_of_plane_mrad / kMradPerDegree, requirement.rotation_deg, " deg",
       " of the view axis");
  return text;
}

}  // namespace boresight::sessions
