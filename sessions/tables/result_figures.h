// SPDX-License-Identifier: Apache-2.0
// The figures of an evaluation, drawn without a display.
#pragma once

#include <array>
#include <cstdint>
#include <filesystem>
#include <optional>
#include <span>
#include <stop_token>
#include <string>
#include <vector>

#include "sessions/evaluation/run_result.h"
#include "sessions/report/pdf_canvas.h"
#include "sessions/tables/results_set.h"

namespace boresight::sessions {

using CurvePoints = std::vector<std::array<double, 2>>;

/// The corners of the cumulative distribution: percent of `of` runs with a value of at most x, from
/// (smallest, its percent) on, constant after the last one. Values that are not finite are left
/// out.
CurvePoints shareBelow(std::vector<double> values, std::size_t of);

/// Percent of judged runs that completed within x times the requirement, for each factor. Empty
/// when none has a requirement.
CurvePoints successAgainstTolerance(std::span<const RunResult* const> runs,
                                    std::span<const double> factors);

/// Distance of a seed from the truth: millimetres (normal and lateral together) or milliradians
/// (the whole angle).
enum class SeedMeasure { kDistance_mm, kAngle_mrad };
std::optional<double> seedMeasure(const RunResult& run, SeedMeasure measure);

/// Judged runs in `bins` groups of about equal size by seed error: the mean seed error and the
/// percent of successful runs of each.
CurvePoints successAgainstSeed(std::span<const RunResult* const> runs, SeedMeasure measure,
                               int bins);

/// Of each completed run with truth: seconds, and lateral error in mm.
CurvePoints timeAgainstError(std::span<const RunResult* const> runs);

/// `count` numbers from `low` to `high`, each the same multiple of the one before.
std::vector<double> geometricSteps(double low, double high, int count);

/// Percent of the runs that completed with an error of at most x: normal, lateral and rotation side
/// by side, a row for each station, near and far apart.
inline constexpr const char* kErrorFigure = "error_distribution";
/// Success against multiples of the requirement.
inline constexpr const char* kToleranceFigure = "success_tolerance";
/// Success against the seed's error, in mm and in mrad.
inline constexpr const char* kSeedFigure = "success_seed_error";
/// Lateral error against seconds: each run, and the medians of each method.
inline constexpr const char* kTimeFigure = "time_accuracy";

struct Figure {
  std::string name;  ///< one of those above: a file's name without extension
  std::vector<std::uint8_t> bytes;
};

/// All four. Each method has its own colour and dashes, WHS a solid blue line. std::bad_alloc or
/// std::runtime_error when they cannot be drawn.
std::vector<Figure> resultFigures(std::span<const RunResult> runs, CanvasFormat format);

/// ".pdf", ".svg", ".png".
const char* extensionOf(CanvasFormat format);

/// How far an unsuccessful run approached the truth, by its iterations' errors.
enum class Astray {
  kNotBegun,   ///< its input was rejected, or the station is not visible from its seed
  kNoTruth,    ///< without truth
  kLedAway,    ///< no iteration was nearer to the truth than the seed
  kPartOfWay,  ///< some iteration was nearer, none near
  kCameNear,   ///< an iteration left less than a tenth of the seed's error, but it did not complete
  kBeyondNeed,  ///< it completed, with an error beyond the requirement
};
Astray whereAstray(const RunResult& run);

/// One to three sentences: how it ended and why, the course of its error (seed, first iteration,
/// nearest, end), and its Astray. Needs the run's steps.
std::string failureStory(const RunResult& run);

/// The iteration that was nearest to the truth, by the larger remaining share of the seed's
/// distance and angle; nullptr without truth or iterations.
const RunStep* nearestStep(const RunResult& run);

struct Failure {
  RunResult run;                  ///< with its steps
  std::filesystem::path dataset;  ///< as its results file names it
  std::string mesh_note;          ///< "WRONG mesh ..." where the method was given one; else empty
  std::string mesh_of = {};       ///< the station of that mesh; else empty
  std::filesystem::path results = {};
};

/// The runs of the files that meet the filter and did not complete, or completed beyond their
/// requirement; in the order of the files, and in theirs. InputError.
std::vector<Failure> failuresOf(const std::vector<std::filesystem::path>& files,
                                const ResultsFilter& filter = {});

inline constexpr const char* kFailureFigure = "failures";

/// Each failure's image around its station with the edges of the seed (red), of the truth (blue)
/// and of the final pose (green; of a run that did not complete: its iteration nearest to the
/// truth, its first one where none was nearer than the seed, or its last without truth), and its
/// story below. One PDF, "failures", or a picture a page, "failures_1", ... Where images cannot be
/// read (or the dataset was a BOP folder) the reason replaces the picture. Empty without failures;
/// after a stop the pages drawn so far. std::bad_alloc or std::runtime_error when they cannot be
/// drawn.
std::vector<Figure> failureSheets(std::span<const Failure> failures, CanvasFormat format,
                                  const std::stop_token& stop = {});

}  // namespace boresight::sessions
