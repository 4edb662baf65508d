// SPDX-License-Identifier: Apache-2.0
// Results files taken together, as tables and figures need them.
#pragma once

#include <filesystem>
#include <map>
#include <string>
#include <vector>

#include "sessions/evaluation/results_file.h"
#include "sessions/evaluation/run_result.h"

namespace boresight::sessions {

/// Runs of any number of methods. A run's `method` is the name under which it is shown: where files
/// have a method with other options, its profile follows, and where that does not tell them apart,
/// the file's name.
struct ResultsSet {
  std::vector<ResultsFacts> files;
  std::vector<RunResult> runs;
  std::map<std::string, MethodFacts> methods;  ///< by the name under which it is shown

  /// The methods in the order of the paper, others before WHS by name.
  std::vector<std::string> methodNames() const;
};

/// What runs are taken: those that meet each filter that is not empty.
struct ResultsFilter {
  std::vector<std::string> stations = {};
  std::vector<std::string> tags = {};
  std::vector<std::string> methods = {};

  bool takes(const RunResult& run) const;
};

/// InputError when a file is not a results file, or the same run is in two of them with the same
/// options: it would count twice.
ResultsSet readResultsSet(const std::vector<std::filesystem::path>& files,
                          const ResultsFilter& filter = {});

/// Whether a method comes before another in tables: seed, orb, ssd, ncc, loftr-r, loftr-s, others
/// by name, whs.
bool methodBefore(const std::string& a, const std::string& b);

}  // namespace boresight::sessions
