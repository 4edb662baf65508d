// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <optional>

#include "sessions/trace/trace.h"

namespace boresight::sessions {

/// Below this probability a rejected pose is not worth comparing with the image.
inline constexpr double kLeastDoubtfulProbability = 0.05;

/// The best pose of a run that was rejected for its probability alone. It is shown as the start of
/// an annotation: it is neither the run's result nor accepted.
struct DoubtfulPose {
  Pose camera_from_station;
  double probability = 0.0;  ///< that it is right, in [0.05, support.min_probability)
};

/// Of a run of one view that ended kNotSupported with such a probability; otherwise empty.
std::optional<DoubtfulPose> doubtfulPose(const LocalizationTrace& trace);

}  // namespace boresight::sessions
