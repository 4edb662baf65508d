// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <vector>

#include "core/geometry/pose.h"
#include "sessions/text/units.h"
#include "sessions/trace/trace.h"

namespace boresight::sessions {

enum class AlternativeKind : std::uint8_t {
  kRolled,     ///< a hypothesis of an iteration, turned about the ray to the station
  kCompared,   ///< a pose that was refined and compared with the run's result
  kCompeting,  ///< a pose that shows about the same edges as the run's result
};

/// A pose compared with the pose with which the run continued. Figures that its kind lacks are NaN.
struct Alternative {
  AlternativeKind kind = AlternativeKind::kRolled;
  std::int32_t iteration = -1;  ///< that compared it, an index into the run's; -1: competing
  std::int32_t number = 1;      ///< in its iteration, of its origin or of its kind; from 1
  bool chosen = false;          ///< the run continued with it
  bool has_pose = false;        ///< else there is nothing to draw
  Pose camera_from_station{};
  /// The pose with which the run continued in that iteration; for a competing pose, the run's
  /// result.
  Pose camera_from_station_chosen{};
  double apart_m = kUnknown;  ///< between the two, of the station's origin
  double apart_rad = kUnknown;
  double roll_rad = kUnknown;
  std::int32_t matches = 0;
  std::int32_t inliers = 0;
  double similarity = kUnknown;   ///< of a competing pose's edges to the result's, [0, 1]
  double margin_nats = kUnknown;  ///< evidence of the result beyond a competing pose's
  bool mirrored = false;          ///< a competing pose of the mesh's mirror image
  double score = kUnknown;        ///< of a compared pose, PoseEvidence::score()
  double probability = kUnknown;  ///< that a compared pose is correct
  HypothesisOrigin origin = HypothesisOrigin::kCandidate;  ///< of a compared pose
};

/// The alternatives of a run so far: its competing poses, the poses that it compared (the best one
/// that is not the result first, the others by descending score), then by iteration the rolled
/// hypotheses, where there were several.
std::vector<Alternative> alternativesOf(const LocalizationTrace& run);

}  // namespace boresight::sessions
