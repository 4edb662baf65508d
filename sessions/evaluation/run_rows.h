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
};

/// Reads rows of a statement that selects columns of these names; names that are not in the table
/// are ignored.
template <class Row>
class RowReader {
 public:
  RowReader(const RowTable<Row>& table, const std::vector<std::string>& names) {
    for (const std::string& name : names) {
      const auto found =
          std::find_if(table.columns.begin(), table.columns.end(),
                       [&](const Column<Row>& column) { return column.name == name; });
      columns_.push_back(found != table.columns.end() && found->read ? &*found : nullptr);
    }
  }

  /// The current row of the statement. InputError.
  Row read(const SqlStatement& statement, const std::filesystem::path& file) const {
    Row row;
    for (std::size_t i = 0; i < columns_.size(); ++i)
      if (columns_[i] != nullptr) columns_[i]->read(row, statement.cell(static_cast<int>(i)), file);
    return row;
  }

 private:
  std::vector<const Column<Row>*> columns_;  ///< nullptr: not read back
};

const RowTable<MethodFacts>& methodTable();
const RowTable<BatchRun>& batchRunTable();
/// Without tags and steps.
const RowTable<RunResult>& runTable();
/// Without details of matches.
const RowTable<RunStep>& stepTable();
const RowTable<MatchDetails>& matchTable();

}  // namespace boresight::sessions
