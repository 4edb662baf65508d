// SPDX-License-Identifier: Apache-2.0
// Success by the conditions of the images, and the success rate that the runs demonstrate.
#pragma once

#include <span>

#include "sessions/evaluation/run_result.h"
#include "sessions/tables/table.h"

namespace boresight::sessions {

/// Runs by stratum, for each station, near or far, and method:
/// - sun, sleeve, hard: the case's tags "sun_low", "sleeve_rim", "hard_dusty", ...; runs without
///   such a tag are a stratum "none" where others have one;
/// - distance: thirds of the runs by the seed's distance from camera to station.
/// A kind of stratum with one group only is left out.
Table strataTable(std::span<const RunResult> runs);

/// Whether the runs demonstrate a success rate, for each station, near or far, and method: the rate
/// demonstrated (one-sided 95 % Clopper-Pearson), the runs that the required rate needs with this
/// number of failures, and the number missing. `required`: share, above 0 and below 1.
Table demonstrationTable(std::span<const RunResult> runs, double required);

}  // namespace boresight::sessions
