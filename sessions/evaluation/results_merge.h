// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <filesystem>
#include <vector>

namespace boresight::sessions {

struct MergeCounts {
  std::int64_t runs = 0;   ///< in the merged file
  std::int64_t equal = 0;  ///< that were left out: the same run, with the same result, was there
};

/// Makes `out` of the runs of results files, e.g. of shards; an `out` that is there already counts
/// as one of them, so that nothing of it is lost. Runs that are in several files are taken once
/// when they ended alike: in status, success and digest (where a method has none, in the pose);
/// times may differ. A run whose input was refused gives way to one that was done. The file is
/// whole or as it was before.
///
/// InputError, naming both files, when they are of different datasets, versions or options, or a
/// run ended otherwise in them; OutputError when `out` cannot be written.
MergeCounts mergeResults(const std::filesystem::path& out,
                         const std::vector<std::filesystem::path>& inputs);

}  // namespace boresight::sessions
