// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include "sessions/evaluation/pose_error.h"
#include "sessions/io/dataset_file.h"
#include "sessions/run/match_details.h"
#include "sessions/run/trace.h"

namespace boresight::sessions {

/// What is kept of one iteration of a run.
struct RunStep {
  std::int32_t index = 0;    ///< over all attempts, from 0
  std::int32_t attempt = 0;  ///< as in IterationTrace, from which the rest is taken, too
  std::string kind;          ///< "match" or "refine"
  std::int32_t level = 0;
  std::string status;  ///< as localizationStatusText says
  double threshold_px = 0.0;
  std::int32_t templates = 0;
  std::int32_t matches = 0;  ///< templates that were searched for
  std::int32_t support = 0;  ///< inliers, or edge places used by a refinement
  double rms_px = 0.0;
  double best_score = 0.0;
  double mean_score = 0.0;
  double correction_mm = 0.0;
  double correction_mrad = 0.0;
  double correction_px = 0.0;
  StageSeconds seconds;
  Pose camera_from_station;           ///< after
  std::optional<PoseError> error;     ///< of that pose, without the projection's
  std::vector<MatchDetails> details;  ///< one per template, where the trace has them
};

/// One per iteration of the trace; errors where the case's truth is known. Matches come along when
/// the trace was recorded in full.
std::vector<RunStep> runSteps(const LocalizationTrace& trace, const Case& one);

}  // namespace boresight::sessions
