// SPDX-License-Identifier: Apache-2.0
// The figures of an evaluation, drawn without a display.
#pragma once

#include <cstdint>
#include <span>
#include <string>
#include <vector>

#include "sessions/evaluation/run_result.h"
#include "sessions/report/pdf_canvas.h"

namespace boresight::sessions {

/// What percent of the runs completed with an error of at most x: normal, lateral and rotation side
/// by side, a row for each station, near and far apart.
inline constexpr const char* kErrorFigure = "error_distribution";
/// Success against multiples of the requirement.
inline constexpr const char* kToleranceFigure = "success_tolerance";
/// Success against how far the seed was, in mm and in mrad.
inline constexpr const char* kSeedFigure = "success_seed_error";
/// Lateral error against seconds: each run, and the medians of each method.
inline constexpr const char* kTimeFigure = "time_accuracy";

struct Figure {
  std::string name;  ///< one of those above: a file's name without extension
  std::vector<std::uint8_t> bytes;
};

/// All four. Methods have colours and dashes of their own, WHS a whole blue line. std::bad_alloc or
/// std::runtime_error when they cannot be drawn.
std::vector<Figure> resultFigures(std::span<const RunResult> runs, CanvasFormat format);

/// ".pdf", ".svg", ".png".
const char* extensionOf(CanvasFormat format);

}  // namespace boresight::sessions
