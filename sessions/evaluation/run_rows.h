// SPDX-License-Identifier: Apache-2.0
// Runs as rows of a results file. Each table's columns are stated once, in run_rows.cpp.
#pragma once

#include <filesystem>
#include <string>
#include <vector>

#include "sessions/evaluation/run_result.h"
#include "sessions/evaluation/sqlite.h"

namespace boresight::sessions {

/// The columns of a table as CREATE TABLE takes them, without id, keys and references.
std::string runColumnsSql();
std::string stepColumnsSql();
std::string matchColumnsSql();

/// Their names, in the order of the values below.
std::vector<std::string> runColumnNames();
std::vector<std::string> stepColumnNames();
std::vector<std::string> matchColumnNames();

std::vector<SqlValue> runValues(const RunResult& run);
std::vector<SqlValue> stepValues(const RunStep& step);
std::vector<SqlValue> matchValues(const MatchDetails& match);

/// A run from its row: `names` are those of the columns that were asked for, in any order; others
/// than runColumnNames() are passed over. Tags and steps stay empty. InputError where a pose or a
/// requirement is not what it should be.
RunResult runFromRow(const std::filesystem::path& file, const std::vector<std::string>& names,
                     const std::vector<SqlValue>& row);

/// The same for an iteration; its details stay empty.
RunStep stepFromRow(const std::filesystem::path& file, const std::vector<std::string>& names,
                    const std::vector<SqlValue>& row);

}  // namespace boresight::sessions
