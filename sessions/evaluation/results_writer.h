// SPDX-License-Identifier: Apache-2.0
// Writing results files, run by run.
#pragma once

#include <cstdint>
#include <filesystem>
#include <memory>
#include <string>
#include <unordered_set>

#include "sessions/evaluation/batch_facts.h"
#include "sessions/evaluation/run_result.h"
#include "sessions/evaluation/sqlite.h"
#include "sessions/io/file_lock.h"

namespace boresight::sessions {

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
  /// What is added from now on is of this sitting.
  void begin(Sitting sitting);
  /// Whether a run is there. One whose input was refused is not: it is to be tried again.
  bool has(const std::string& method, const std::string& case_id, std::int32_t reseed) const;
  /// Adds a run, in place of one of the same whose input was refused. OutputError.
  void add(const RunResult& run);
  /// Notes that the sitting ended by itself.
  void end();

  std::int64_t runs() const { return static_cast<std::int64_t>(known_.size()); }

 private:
  struct Insertions;
  void insert(const RunResult& run);
  void insertSteps(std::int64_t run_id, const RunResult& run);
  void noteSitting();

  std::unique_ptr<FileLock> lock_;
  SqlDatabase database_;
  std::unique_ptr<Insertions> insertions_;
  std::unordered_set<std::string> known_;  ///< runs that need not be done again
  Sitting sitting_;
  std::int64_t began_ns_ = 0;  ///< of the steady clock
};

}  // namespace boresight::sessions
