// SPDX-License-Identifier: Apache-2.0
// Minutes on the paper's flight processor, from counted instructions.
#pragma once

#include <array>
#include <filesystem>
#include <span>
#include <string>
#include <utility>
#include <vector>

#include "sessions/tables/table.h"

namespace boresight::sessions {

/// Instructions of one run, stage by stage, as tests/benchmarks/instructions.sh counts them.
struct InstructionCount {
  std::string method;  ///< as it is listed, e.g. "whs paper"
  std::string station;
  std::string case_id;
  double initialization = 0.0;
  double search = 0.0;
  double rendering = 0.0;
  double matching = 0.0;
  double pose = 0.0;
  double refinement = 0.0;

  double total() const;
};

/// The stages by their names in files and tables.
inline constexpr std::pair<const char*, double InstructionCount::*> kCountedStages[] = {
    {"initialization", &InstructionCount::initialization},
    {"search", &InstructionCount::search},
    {"rendering", &InstructionCount::rendering},
    {"matching", &InstructionCount::matching},
    {"pose", &InstructionCount::pose},
    {"refinement", &InstructionCount::refinement}};

/// Reads {"format": "boresight-instructions", "version": 1, "runs": [{"method", "station", "case",
/// and a count for each stage}]}. InputError.
std::vector<InstructionCount> readInstructionCounts(const std::filesystem::path& file);

/// Minutes at 200 MHz and one instruction per cycle: the means of each station's runs, added up
/// over the stations, as in the paper's Table III; with the paper's rows if requested.
Table flightTable(std::span<const InstructionCount> counts, bool with_paper);

}  // namespace boresight::sessions
