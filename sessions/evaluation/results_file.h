// SPDX-License-Identifier: Apache-2.0
// Reading results files; README.md beside this has their tables.
#pragma once

#include <filesystem>
#include <functional>
#include <string>
#include <vector>

#include "sessions/evaluation/batch_facts.h"
#include "sessions/evaluation/run_result.h"
#include "sessions/evaluation/sqlite.h"

namespace boresight::sessions {

/// Marks an SQLite file as ours ("BSRT"), and of which form.
inline constexpr std::int64_t kResultsApplication = 0x42535254;
inline constexpr std::int64_t kResultsVersion = 2;

/// A results file but its runs.
struct ResultsFacts {
  std::filesystem::path file;
  DatasetFacts dataset;
  std::vector<MethodFacts> methods;  ///< by name
  std::vector<Sitting> sittings;     ///< in the order in which they began
};

/// InputError unless the file is a results file of this version.
ResultsFacts readResultsFacts(const std::filesystem::path& file);

/// One run after the other, with tags and without steps, in the order of the dataset, then of
/// seeds, then of methods: whatever order they were run in. InputError.
void forEachRun(const std::filesystem::path& file,
                const std::function<void(const RunResult&)>& take);

/// The iterations of a run that the file lists, in their order, without details of matches. Empty
/// when the file has no such run. InputError.
std::vector<RunStep> readSteps(const std::filesystem::path& file, const RunResult& run);

struct Results {
  ResultsFacts facts;
  std::vector<RunResult> runs;  ///< as forEachRun orders them
};
Results readResults(const std::filesystem::path& file);

/// Of an open file that is one: what it says.
ResultsFacts factsOf(SqlDatabase& database);
/// Throws what the database's access calls for, unless it is a results file of this version with
/// the tables and indexes of one and nothing else.
void requireResultsFile(SqlDatabase& database);
/// Whether nothing was written into it yet.
bool isEmptyDatabase(SqlDatabase& database);
/// Makes the tables of a new file, in a transaction.
void makeResultsTables(SqlDatabase& database, const DatasetFacts& dataset);
/// Rows for a method and a sitting, which gets an id of this file.
void addMethodFacts(SqlDatabase& database, const MethodFacts& method);
void addSitting(SqlDatabase& database, Sitting& sitting);
/// INSERT INTO table (names) VALUES (?1, ...).
std::string insertSql(const std::string& table, const std::vector<std::string>& names);
/// "a, b, c"
std::string joined(const std::vector<std::string>& names, const std::string& prefix = "");

}  // namespace boresight::sessions
