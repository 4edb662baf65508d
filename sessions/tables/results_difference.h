// SPDX-License-Identifier: Apache-2.0
// Two sets of results, run by run.
#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "sessions/review/run_difference.h"
#include "sessions/tables/results_set.h"
#include "sessions/tables/table.h"

namespace boresight::sessions {

/// The same case from the same seed, in both.
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
};

/// Pairs runs by case, seed and method; by case and seed alone where each set has one method.
/// Where truth and requirement are known a right pose is better than a run that failed, and that is
/// better than a wrong pose, and of two wrong ones the nearer by a tenth of the requirement; else a
/// run that completed is better than one that did not.
ResultsDifference compareResults(const ResultsSet& before, const ResultsSet& after);

/// The pairs that changed or, with `all`, all of them.
Table differenceTable(const ResultsDifference& difference, bool all);
/// "120 runs in both: 3 better, 2 worse, 115 the same (90 bit for bit); 1 only in the first."
std::string differenceSentence(const ResultsDifference& difference);

}  // namespace boresight::sessions
