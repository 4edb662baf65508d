// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <vector>

#include <Eigen/Core>

#include "sessions/text/units.h"
#include "sessions/trace/trace.h"

namespace boresight::sessions {

/// A match is ambiguous when its best score exceeds the second by less than this share of itself.
/// For display only.
inline constexpr double kLowMargin = 0.05;

/// Result of one template. Positions are pixels of the full image; values that the iteration has
/// not reached, or could not measure, are NaN.
struct MatchDetails {
  std::int32_t index = 0;  ///< into the iteration's templates
  double depth_m = 0.0;
  double distinctness = 0.0;  ///< as in Template
  Eigen::Vector3d point_in_station_m = Eigen::Vector3d::Zero();
  Eigen::Vector2d predicted_px = Eigen::Vector2d::Zero();
  Eigen::Vector2d found_px = Eigen::Vector2d::Constant(kUnknown);  ///< sub-pixel
  bool searched = false;
  bool at_border = false;          ///< the peak lies on the window's border
  double score = kUnknown;         ///< S = edge_share + empty_share, in [0, 2]
  double edge_share = kUnknown;    ///< S+ / c+
  double empty_share = kUnknown;   ///< S- / c-
  double second_score = kUnknown;  ///< of the second peak; NaN where there is none
  double margin = kUnknown;        ///< (best - second) / best, of the integers that are compared
  bool solved = false;             ///< the match was used to solve for a pose
  bool inlier = false;
  double residual_px = kUnknown;  ///< distance from the solved pose's projection

  Eigen::Vector2d moved_px() const { return found_px - predicted_px; }
  bool hasLowMargin() const { return margin < kLowMargin; }
};

/// One per template of an iteration that was recorded in full.
std::vector<MatchDetails> matchDetails(const IterationTrace& iteration);

}  // namespace boresight::sessions
