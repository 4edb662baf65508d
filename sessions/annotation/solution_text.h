// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <span>
#include <string>

#include "sessions/annotation/solve_marks.h"

namespace boresight::sessions {

/// A solution for people: one line per mark (residuals in px and mm, how far the pose moves without
/// it), what is weak, the pose with one sigma, and the other pose of an ambiguous plane.
std::string solutionText(std::span<const MarkedView> views, const MarksSolution& solution);

}  // namespace boresight::sessions
