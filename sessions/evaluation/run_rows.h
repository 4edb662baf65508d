// SPDX-License-Identifier: Apache-2.0
// The rows of a results file. Each table's columns are stated once, in run_rows.cpp.
#pragma once

#include <algorithm>
#include <filesystem>
#include <functional>
#include <string>
#include <vector>

#include "sessions/evaluation/batch_facts.h"
#include "sessions/evaluation/run_result.h"
#include "sessions/evaluation/sqlite.h"

namespace boresight::sessions {

/// A column: how it is declared, written, and read back (empty: it is not).
template <class Row>
struct Column {
  std::string name;
  const char* type;
  std::function<SqlValue(const Row&)> write;
  /// InputError (the file) where a pose or a requirement is not what it should be.
  std::function<void(Row&, const SqlValue&, const std::filesystem::path&)> read = {};
};

/// The columns of a table, without id, keys and references, and rows made of them.
template <class Row>
struct RowTable {
  std::vector<Column<Row>> columns;

  /// As CREATE TABLE takes them.
  std::string sql() const {
    std::string text;
    for (const Column<Row>& column : columns)
      text += (text.empty() ? "" : ", ") + column.name + " " + column.type;
    return text;
  }
  std::vector<std::string> names() const {
    std::vector<std::string> all;
    for (const Column<Row>& column : columns) all.push_back(column.name);
    return all;
  }
  /// In the order of the names.
  std::vector<SqlValue> values(const Row& row) const {
    std::vector<SqlValue> all;
    for (const Column<Row>& column : columns) all.push_back(column.write(row));
    return all;
  }
  /// `names` are those of the columns that were asked for, in any order; others than this table's
  /// are passed over. InputError.
  Row read(const std::filesystem::path& file, const std::vector<std::string>& names,
           const std::vector<SqlValue>& values) const {
    Row row;
    for (const Column<Row>& column : columns)
      for (std::size_t i = 0; column.read && i < std::min(names.size(), values.size()); ++i)
        if (names[i] == column.name) column.read(row, values[i], file);
    return row;
  }
};

const RowTable<MethodFacts>& methodTable();
const RowTable<BatchRun>& batchRunTable();
/// Without tags and steps.
const RowTable<RunResult>& runTable();
/// Without details of matches.
const RowTable<RunStep>& stepTable();
const RowTable<MatchDetails>& matchTable();

}  // namespace boresight::sessions
