// SPDX-License-Identifier: Apache-2.0
// What the figures draw, as numbers.
#pragma once

#include <array>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "sessions/evaluation/run_result.h"

namespace boresight::sessions {

using CurvePoints = std::vector<std::array<double, 2>>;

/// The corners of the staircase that says what percent of `of` runs have a value of at most x:
/// from (smallest, its percent) on; it stays at the last one's percent. Values that are not finite
/// are left out.
CurvePoints shareBelow(std::vector<double> values, std::size_t of);

/// Percent of judged runs that completed within x times the requirement, for each factor. Empty
/// when none has a requirement.
CurvePoints successAgainstTolerance(std::span<const RunResult* const> runs,
                                    std::span<const double> factors);

/// How far a seed is from the truth: millimetres (normal and lateral together) or milliradians (the
/// whole angle).
enum class SeedMeasure { kDistance_mm, kAngle_mrad };
std::optional<double> seedMeasure(const RunResult& run, SeedMeasure measure);

/// Judged runs in `bins` groups of equal size (as far as they divide), by how far their seeds are:
/// the mean of that, and the percent of successful ones.
CurvePoints successAgainstSeed(std::span<const RunResult* const> runs, SeedMeasure measure,
                               int bins);

/// Of each completed run with truth: seconds, and lateral error in mm.
CurvePoints timeAgainstError(std::span<const RunResult* const> runs);

/// `count` numbers from `low` to `high`, each the same multiple of the one before.
std::vector<double> geometricSteps(double low, double high, int count);

}  // namespace boresight::sessions
