// SPDX-License-Identifier: Apache-2.0
// The paper's Figure 4 for our runs.
#pragma once

#include <span>

#include "sessions/evaluation/run_result.h"
#include "sessions/report/pdf_canvas.h"
#include "sessions/tables/result_figures.h"

namespace boresight::sessions {

inline constexpr const char* kStripsFigure = "error_strips";

/// Errors of one method, as its strip shows them.
struct ErrorStrip {
  std::vector<double> completed;  ///< errors where completed runs ended
  std::vector<double> failed;     ///< errors of failed runs: those of their seeds
};

/// The strip of a method's runs for one error. Runs without truth are left out.
ErrorStrip errorStrip(std::span<const RunResult* const> runs, double PoseError::*part);

/// A scale that is linear near 0 and logarithmic beyond, odd, in decades: sign(v) log10(1 + |v| /
/// unit).
double signedDecades(double value, double unit);

/// Normal (signed), lateral and rotation errors side by side, a row for each station, near and far
/// apart. Strips: the seeds' errors (blue), then a method each: completed runs (green dots), failed
/// runs at their seeds' errors (red crosses); the requirement dotted. A strip shows at most 400 of
/// each, evenly by rank with the extremes.
Figure errorStripsFigure(std::span<const RunResult> runs, CanvasFormat format);

}  // namespace boresight::sessions
