// SPDX-License-Identifier: Apache-2.0
// The rows of a results file. Each table's columns are stated once, in run_rows.cpp.
#pragma once

#include <cstdint>
#include <filesystem>
#include <functional>
#include <string>
#include <vector>

#include "sessions/evaluation/batch_facts.h"
#include "sessions/evaluation/run_result.h"
#include "sessions/evaluation/sqlite.h"

namespace boresight::sessions {

/// A column with its declaration, writer and reader (empty: not read back).
template <class Row>
struct Column {
  std::string name;
  const char* type;
  std::function<SqlValue(const Row&)> write;
  /// InputError (for the file) when a pose or a requirement is invalid.
  std::function<void(Row&, const SqlValue&, const std::filesystem::path&)> read = {};
};

/// The columns of a table, without id, keys and references, and rows built from them.
template <class Row>
struct RowTable {
  std::vector<Column<Row>> columns;

  /// The column declarations of CREATE TABLE.
  std::string sql() const {
    std::string text;
    for (const Column<Row>& column : columns)
      text += (text.empty() ? "" : ", ") + column.name + " " + column.type;
    return text;
  }
  /// Names of the columns, after those of keys.
  std::vector<std::string> names(std::vector<std::string> all = {}) const {
    for (const Column<Row>& column : columns) all.push_back(column.name);
    return all;
  }
  /// Values of the columns in the order of the names, after those of keys.
  std::vector<SqlValue> values(const Row& row, std::vector<SqlValue> all = {}) const {
    for (const Column<Row>& column : columns) all.push_back(column.write(row));
    return all;
  }
  /// The current row of a statement that selects names() first. InputError.
  Row read(const SqlStatement& statement, const std::filesystem::path& file) const {
    Row row;
    for (int i = 0; const Column<Row>& column : columns) {
      if (column.read) column.read(row, statement.cell(i), file);
      ++i;
    }
    return row;
  }
};

const RowTable<MethodFacts>& methodTable();
const RowTable<BatchRun>& batchRunTable();
/// Without tags and steps.
const RowTable<RunResult>& runTable();
/// Without details of matches.
const RowTable<RunStep>& stepTable();
/// Both as in results files of a version: 5 has neither `inputs_sha256` nor the steps'
/// `projection_px`.
const RowTable<RunResult>& runTableOf(std::int64_t version);
const RowTable<RunStep>& stepTableOf(std::int64_t version);
const RowTable<MatchDetails>& matchTable();

}  // namespace boresight::sessions
