// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <vector>

#include "core/geometry/pose.h"
#include "sessions/run/trace.h"
#include "sessions/text/units.h"

namespace boresight::sessions {

enum class AlternativeKind : std::uint8_t {
  kRolled,     ///< a hypothesis of an iteration, turned about the ray to the station
  kCandidate,  ///< a pose that the search found
  kRival,      ///< a pose under which the model's edges look like those of the run's result
};

/// A pose that a run weighed against the one that it went on with. Figures that its kind does not
/// have are NaN.
struct Alternative {
  AlternativeKind kind = AlternativeKind::kRolled;
  std::int32_t iteration = -1;  ///< that weighed it, an index into the run's; -1: of a rival
  std::int32_t number = 1;      ///< in its iteration, or among the rivals; from 1
  bool chosen = false;          ///< what the run went on with
  bool has_pose = false;        ///< else there is nothing to draw
  /// What came out of it; of a rival without a pose, where it began.
  Pose camera_from_station;
  /// What the run went on with in that iteration; of a rival, the run's result.
  Pose camera_from_station_chosen;
  double apart_m = kUnknown;  ///< between the two, of the station's origin
  double apart_rad = kUnknown;
  double roll_rad = kUnknown;
  std::int32_t matches = 0;
  std::int32_t inliers = 0;
  double evidence_nats = kUnknown;  ///< of a candidate's contours, PoseCandidate::rank_nats()
  double similarity = kUnknown;     ///< of a rival's edges to the result's, [0, 1]
  double margin_nats = kUnknown;    ///< evidence of the result beyond a converged rival's
  LocalizationStatus ended = LocalizationStatus::kRunning;  ///< kRunning: a rival not tried
};

/// Of a run as far as it has come: its rivals, the candidates of its search, then iteration by
/// iteration the rolled hypotheses of those that had several.
std::vector<Alternative> alternativesOf(const LocalizationTrace& run);

/// The rival that an iteration (an index into the run's) worked on, as an index into
/// `alternatives`; -1: none.
int rivalOfIteration(const LocalizationTrace& run, const std::vector<Alternative>& alternatives,
                     int iteration);

}  // namespace boresight::sessions
