// SPDX-License-Identifier: Apache-2.0
// Pictures of runs that did not succeed, six to a page.
#pragma once

#include <span>

#include "sessions/tables/failures.h"
#include "sessions/tables/result_figures.h"

namespace boresight::sessions {

inline constexpr const char* kFailureFigure = "failures";

/// Each failure's image around its station with the edges of the seed (red), of the truth (blue)
/// and of what the run ended with (green; where it did not complete, of its iteration nearest to
/// the truth, of its first one where none was nearer than the seed, or of its last without truth),
/// and its story beneath. One PDF, "failures", or a picture a page, "failures_1", ... Where images
/// cannot be read (or the dataset was a BOP folder) the reason stands in the picture's place. Empty
/// without failures. std::bad_alloc or std::runtime_error when they cannot be drawn.
std::vector<Figure> failureSheets(std::span<const Failure> failures, CanvasFormat format);

}  // namespace boresight::sessions
