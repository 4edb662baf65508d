// SPDX-License-Identifier: Apache-2.0
// Runs that did not succeed, and where each of them went astray.
#pragma once

#include <filesystem>
#include <span>
#include <string>
#include <vector>

#include "sessions/evaluation/run_result.h"
#include "sessions/tables/result_figures.h"
#include "sessions/tables/results_set.h"

namespace boresight::sessions {

/// Where a run that did not succeed went astray, as far as its iterations' errors show it.
enum class Astray {
  kNotBegun,   ///< its input was refused, or there is nothing to see from its seed
  kUnknown,    ///< without truth
  kLedAway,    ///< no iteration was nearer to the truth than the seed
  kPartOfWay,  ///< some iteration was nearer, none near
  kCameNear,   ///< an iteration left less than a tenth of the seed's error, but it did not complete
  kBeyondNeed,  ///< it completed, with an error beyond the requirement
};
Astray whereAstray(const RunResult& run);

/// One to three sentences: how it ended and why, the way that its error took (seed, first
/// iteration, nearest, end), and where it went astray. Needs the run's steps.
std::string failureStory(const RunResult& run);

/// The iteration that was nearest to the truth, by the larger share of the seed's distance and
/// angle that it left; nullptr without truth or iterations.
const RunStep* nearestStep(const RunResult& run);

struct Failure {
  RunResult run;                  ///< with its steps
  std::filesystem::path dataset;  ///< as its results file names it
  std::string mesh_note;          ///< "WRONG mesh ..." where the method was given one; else empty
};

/// The runs of the files that meet the filter and did not complete, or completed beyond their
/// requirement; in the order of the files, and in theirs. InputError.
std::vector<Failure> failuresOf(const std::vector<std::filesystem::path>& files,
                                const ResultsFilter& filter = {});

inline constexpr const char* kFailureFigure = "failures";

/// Each failure's image around its station with the edges of the seed (red), of the truth (blue)
/// and of what the run ended with (green; where it did not complete, of its iteration nearest to
/// the truth, of its first one where none was nearer than the seed, or of its last without truth),
/// and its story beneath. One PDF, "failures", or a picture a page, "failures_1", ... Where images
/// cannot be read (or the dataset was a BOP folder) the reason stands in the picture's place. Empty
/// without failures. std::bad_alloc or std::runtime_error when they cannot be drawn.
std::vector<Figure> failureSheets(std::span<const Failure> failures, CanvasFormat format);

}  // namespace boresight::sessions
