// SPDX-License-Identifier: Apache-2.0
#include "sessions/trace/doubtful_pose.h"

#include "sessions/trace/run_text.h"

namespace boresight::sessions {

std::optional<DoubtfulPose> doubtfulPose(const LocalizationTrace& trace) {
  // With several views the probability is that of the rig's pose.
  const bool is_judged = trace.status == LocalizationStatus::kNotSupported &&
                         hasProbability(trace) && trace.views.empty() && !trace.iterations.empty();
  if (!is_judged || trace.probability < kLeastDoubtfulProbability ||
      trace.probability >= trace.lastOptions().support.min_probability)
    return std::nullopt;
  // The run repeats the last iteration of its best hypothesis before it judges the pose.
  return DoubtfulPose{trace.lastPose(), trace.probability};
}

}  // namespace boresight::sessions
