// SPDX-License-Identifier: Apache-2.0
// Reading results files; their tables are in README.md.
#pragma once

#include <cstdint>
#include <filesystem>
#include <functional>
#include <memory>
#include <optional>
#include <span>
#include <stop_token>
#include <string>
#include <vector>

#include "sessions/evaluation/batch_facts.h"
#include "sessions/evaluation/run_result.h"
#include "sessions/evaluation/run_rows.h"
#include "sessions/evaluation/sqlite.h"
#include "sessions/io/files/file_lock.h"

namespace boresight::sessions {

/// SQLite application id ("BSRT") and version of results files; files of the version before are
/// read and merged, but not continued.
inline constexpr std::int64_t kResultsApplication = 0x42535254;
inline constexpr std::int64_t kResultsVersion = 6;
inline constexpr std::int64_t kOldestResultsVersion = 5;

/// Contents of a results file except the runs.
struct ResultsFacts {
  std::filesystem::path file;
  DatasetFacts dataset;
  std::vector<MethodFacts> methods;  ///< by name
  std::vector<BatchRun> batch_runs;  ///< in the order in which they began
  std::int64_t format_version = kResultsVersion;
};

/// InputError unless the file is a results file of a version that is read.
ResultsFacts readResultsFacts(const std::filesystem::path& file);

/// Calls `take` for each run, with tags and without steps, ordered by dataset, then seed, then
/// method. InputError.
void forEachRun(const std::filesystem::path& file, const std::function<void(RunResult&&)>& take);

/// Sets the steps of runs of the file, in their order, without details of matches; none for a run
/// that the file does not have. InputError.
void readSteps(const std::filesystem::path& file, std::span<RunResult* const> runs);

struct Results {
  ResultsFacts facts;
  std::vector<RunResult> runs;  ///< as forEachRun orders them
};
Results readResults(const std::filesystem::path& file);

/// The right to write a results file, held as long as the lock lives. OutputError when another
/// process writes the file.
std::unique_ptr<FileLock> lockResults(const std::filesystem::path& file);

/// Creates the tables of a new file, in a transaction.
void makeResultsTables(SqlDatabase& database, const DatasetFacts& dataset);
void addMethodFacts(SqlDatabase& database, const MethodFacts& method);

/// A results file that grows. Each run is a transaction that is on the disk when `add` returns: a
/// process may be killed at any time, and another one may continue. Case, seed number and method
/// identify a run; there are no duplicates. A file holds the options of a method once. Not
/// thread-safe.
class ResultsWriter {
 public:
  /// Creates the file, or continues an existing one. OutputError when it cannot be written, is not
  /// a results file, is being written by another process, or has runs of another dataset or
  /// version.
  ResultsWriter(const std::filesystem::path& file, const DatasetFacts& dataset);

  /// Announces runs of this method. OutputError when the file's runs of the method have other
  /// options.
  void admit(const MethodFacts& method);
  /// Runs added from now on belong to this batch run.
  void begin(BatchRun batch_run);
  /// RunResult::inputs_sha256 of a run; empty when the file does not have the run. A run whose
  /// input was rejected does not count, so that it is repeated.
  std::optional<std::string> inputsOf(const std::string& method, const std::string& case_id,
                                      std::int32_t reseed) const;
  /// Adds a run; replaces the same run if its input was rejected before. OutputError.
  void add(const RunResult& run);
  /// Records that the batch run ended normally.
  void end();

 private:
  void insert(const RunResult& run);
  void noteBatchRun();

  std::unique_ptr<FileLock> lock_;
  SqlDatabase database_;
  BatchRun batch_run_;
  std::int64_t batch_run_id_ = 0;
  std::int64_t began_ns_ = 0;  ///< of the steady clock
};

struct MergeCounts {
  std::int64_t runs = 0;   ///< in the merged file
  std::int64_t equal = 0;  ///< duplicates with the same result, left out
};

/// Merges the runs of results files, e.g. of shards, into `out`; an existing `out` is merged as
/// well, so that its runs are kept. Runs in several files are taken once when status, success and
/// digest (pose, for a method without digest) are equal; times may differ. A completed run replaces
/// one whose input was rejected. The file is written whole or not at all: empty, and `out` as it
/// was, after a stop.
///
/// InputError, naming both files, when they are of different datasets, versions or options, or a
/// run has different results in them; OutputError when `out` cannot be written or another process
/// writes it.
std::optional<MergeCounts> mergeResults(const std::filesystem::path& out,
                                        const std::vector<std::filesystem::path>& inputs,
                                        const std::stop_token& stop = {});

}  // namespace boresight::sessions
