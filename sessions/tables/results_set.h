// SPDX-License-Identifier: Apache-2.0
// Results files taken together, as tables and figures need them.
#pragma once

#include <cstdint>
#include <filesystem>
#include <map>
#include <string>
#include <vector>

#include "sessions/evaluation/results_file.h"
#include "sessions/evaluation/run_result.h"
#include "sessions/review/run_difference.h"
#include "sessions/tables/table.h"

namespace boresight::sessions {

/// Runs of any number of methods. A run's `method` is its displayed name. Where files have a method
/// with different options or versions, what sets its variant apart follows: profile, version, or
/// file name, with a number where two files have one name.
struct ResultsSet {
  std::vector<ResultsFacts> files;
  std::vector<RunResult> runs;
  std::map<std::string, MethodFacts> methods;  ///< by displayed name

  /// The methods in the order of the paper, others before WHS by name.
  std::vector<std::string> methodNames() const;
};

/// Filter of runs: a run must match each filter that is not empty.
struct ResultsFilter {
  std::vector<std::string> stations = {};
  std::vector<std::string> tags = {};
  std::vector<std::string> methods = {};

  bool takes(const RunResult& run) const;
};

/// InputError when a file is not a results file, or two files hold the same run with the same
/// options: it would count twice.
ResultsSet readResultsSet(const std::vector<std::filesystem::path>& files,
                          const ResultsFilter& filter = {});

/// Whether a method comes before another in tables: seed, orb, ssd, ncc, loftr-r, loftr-s, others
/// by name, whs.
bool methodBefore(const std::string& a, const std::string& b);

/// Runs of the same case from the same seed, in both sets.
struct RunPairing {
  RunResult before;
  RunResult after;
  RunChange change = RunChange::kSame;
  std::string why;
};

struct ResultsDifference {
  std::vector<RunPairing> pairs;  ///< in the order of the first
  std::int64_t only_before = 0;
  std::int64_t only_after = 0;
  std::int64_t better = 0;
  std::int64_t worse = 0;
  std::int64_t same = 0;
  std::int64_t equal = 0;  ///< of these, bit for bit

  /// Whether runs were compared, none became worse and none is missing after.
  bool holds() const { return !pairs.empty() && worse == 0 && only_before == 0; }
};

/// Pairs runs by case, seed and method; by case and seed alone where each set has one method. With
/// truth and requirement known, a correct pose is better than a failed run, which is better than a
/// wrong pose (a false positive); of two wrong poses the nearer one is better, if nearer by a tenth
/// of the requirement. A pose found with a deliberately wrong mesh is wrong at any distance.
/// Otherwise a run that completed is better than one that did not.
///
/// InputError when the sets are of different datasets, of different deliberately wrong meshes or
/// of seeds drawn at different distances, or one case is in several datasets.
ResultsDifference compareResults(const ResultsSet& before, const ResultsSet& after);

/// The pairs that changed or, with `all`, all of them.
Table differenceTable(const ResultsDifference& difference, bool all);
/// "120 runs in both: 3 better, 2 worse, 115 the same (90 bit for bit); 1 only in the first."
std::string differenceSentence(const ResultsDifference& difference);

}  // namespace boresight::sessions
