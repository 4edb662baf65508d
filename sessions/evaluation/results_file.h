// SPDX-License-Identifier: Apache-2.0
// Reading results files; their tables are in README.md.
#pragma once

#include <cstdint>
#include <filesystem>
#include <functional>
#include <memory>
#include <string>
#include <unordered_set>
#include <vector>

#include "sessions/evaluation/batch_facts.h"
#include "sessions/evaluation/run_result.h"
#include "sessions/evaluation/run_rows.h"
#include "sessions/evaluation/sqlite.h"
#include "sessions/io/files/file_lock.h"

namespace boresight::sessions {

/// Annotations an SQLite file as ours ("BSRT"), and of which form.
inline constexpr std::int64_t kResultsApplication = 0x42535254;
inline constexpr std::int64_t kResultsVersion = 5;

/// A results file but its runs.
struct ResultsFacts {
  std::filesystem::path file;
  DatasetFacts dataset;
  std::vector<MethodFacts> methods;  ///< by name
  std::vector<BatchRun> batch_runs;  ///< in the order in which they began
};

/// InputError unless the file is a results file of this version.
ResultsFacts readResultsFacts(const std::filesystem::path& file);

/// One run after the other, with tags and without steps, in the order of the dataset, then of
/// seeds, then of methods: whatever order they were run in. InputError.
void forEachRun(const std::filesystem::path& file, const std::function<void(RunResult&&)>& take);

/// The iterations of a file's runs, one run at a time.
class StepReader {
 public:
  /// InputError.
  explicit StepReader(const std::filesystem::path& file);
  StepReader(const StepReader&) = delete;
  StepReader& operator=(const StepReader&) = delete;

  /// In their order, without details of matches; empty when the file has no such run. InputError.
  std::vector<RunStep> stepsOf(const RunResult& run);

 private:
  SqlDatabase database_;
  RowReader<RunStep> reader_;
  SqlStatement statement_;
};

struct Results {
  ResultsFacts facts;
  std::vector<RunResult> runs;  ///< as forEachRun orders them
};
Results readResults(const std::filesystem::path& file);

/// Makes the tables of a new file, in a transaction.
void makeResultsTables(SqlDatabase& database, const DatasetFacts& dataset);
void addMethodFacts(SqlDatabase& database, const MethodFacts& method);
/// "a, b, c"
std::string joined(const std::vector<std::string>& names, const std::string& prefix = "");

/// A results file that grows: each run is a transaction that is on the disk when `add` returns, so
/// that a process may be killed at any time and another one goes on. A run is known by its case,
/// the number of its seed, and its method, whose options a file holds once: nothing is there twice.
/// Not for several threads at a time.
class ResultsWriter {
 public:
  /// Makes the file, or goes on with one that is there. OutputError when it cannot be written, is
  /// not a results file, another process is writing it, or its runs are of another dataset or
  /// version.
  ResultsWriter(const std::filesystem::path& file, const DatasetFacts& dataset);
  ~ResultsWriter();

  /// Runs of this method are to be added. OutputError when the file's runs of it have other
  /// options.
  void admit(const MethodFacts& method);
  /// What is added from now on is of this batch_run.
  void begin(BatchRun batch_run);
  /// Whether a run is there. One whose input was refused is not: it is to be tried again.
  bool has(const std::string& method, const std::string& case_id, std::int32_t reseed) const;
  /// Adds a run, in@dataset_index of one of the same whose input was refused. OutputError.
  void add(const RunResult& run);
  /// Notes that the batch_run ended by itself.
  void end();

 private:
  struct Insertions;
  void insert(const RunResult& run);
  void insertSteps(std::int64_t run_id, const RunResult& run);
  void noteBatchRun();

  std::unique_ptr<FileLock> lock_;
  SqlDatabase database_;
  std::unique_ptr<Insertions> insertions_;
  std::unordered_set<std::string> known_;  ///< runs that need not be done again
  BatchRun batch_run_;
  std::int64_t began_ns_ = 0;  ///< of the steady clock
};

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
