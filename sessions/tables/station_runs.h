// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "sessions/evaluation/run_result.h"
#include "sessions/tables/method_tables.h"

// Runs of a station, grouped for the panels of a figure.
namespace boresight::sessions {

/// Runs of one station, near or far.
struct StationRuns {
  std::string title;  ///< "bc", "bc, far"
  std::vector<RunGroup> methods;
  std::vector<const RunResult*> all;  ///< of all methods
};

/// By station, near before far. Runs whose input was rejected are left out.
std::vector<StationRuns> stationRuns(std::span<const RunResult> runs);

/// A limit of a requirement; empty when the requirement lacks it.
using RequirementLimit = std::optional<double> (*)(const Requirement&);
/// One of the three errors that are judged.
struct ErrorAxis {
  const char* label;
  double PoseError::*part;
  RequirementLimit limit;
  bool is_signed;
};
/// Normal, lateral, rotation.
extern const std::array<ErrorAxis, 3> kErrorAxes;

/// The limit where all runs share it; empty when they differ.
std::optional<double> sharedLimit(std::span<const RunResult* const> runs, RequirementLimit limit);

}  // namespace boresight::sessions
