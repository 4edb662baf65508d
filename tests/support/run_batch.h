// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <algorithm>
#include <stop_token>
#include <utility>
#include <vector>

#include "sessions/evaluation/batch.h"

namespace boresight::test {

/// Plans and runs a batch. The results are in the order of the plan; after a stop, runs that were
/// not done are missing.
inline std::vector<sessions::RunResult> runBatch(const sessions::Dataset& dataset,
                                                 const sessions::BatchOptions& options,
                                                 const sessions::BatchProgress& progress = {},
                                                 const std::stop_token& stop = {}) {
  std::vector<sessions::RunResult> results;
  runPlanned(
      dataset, options, planBatch(dataset, options),
      [&](std::size_t done, std::size_t total, const sessions::RunResult& result) {
        results.push_back(result);
        if (progress) progress(done, total, result);
      },
      stop);
  std::ranges::sort(results, {}, [](const sessions::RunResult& result) {
    return std::pair(result.dataset_index, result.reseed);
  });
  return results;
}

}  // namespace boresight::test
