// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <span>
#include <string>

#include "sessions/annotation/geometry_meter.h"
#include "sessions/annotation/solve_marks.h"

namespace boresight::sessions {

/// A solution for people: one line per mark (residuals in px and mm, how far the pose moves without
/// it), what is weak, the pose with one sigma (of several views the rig's and each camera's), and
/// the other pose of an ambiguous plane. `left_out` by mark, as `leaveOneOut` gives them.
std::string solutionText(std::span<const MarkedView> views, const MarksSolution& solution,
                         std::span<const LeftOut> left_out,
                         std::span<const GeometryWarning> warnings);

}  // namespace boresight::sessions
