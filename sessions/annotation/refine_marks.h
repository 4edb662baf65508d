// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <span>

#include "sessions/annotation/mark_equations.h"

namespace boresight::sessions {

/// Least squares over marks from a start: damped Gauss-Newton steps until one is negligible. False
/// when the marks do not determine the pose there; the pose is then left as it was.
[[nodiscard]] bool refineMarks(std::span<const MarkedView> views,
                               std::span<const MarkAddress> marks, std::span<const double> weight,
                               Pose& rig_from_station, NormalEquations& equations);

}  // namespace boresight::sessions
