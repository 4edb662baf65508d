// SPDX-License-Identifier: Apache-2.0
#include "sessions/evaluation/requirement_share.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>

namespace boresight::sessions {
namespace {

constexpr double kMradPerDegree = 1e3 * std::numbers::pi / 180.0;

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

}  // namespace boresight::sessions
