// SPDX-License-Identifier: Apache-2.0
// A table as numbers, and as text, CSV or LaTeX.
#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <utility>
#include <vector>

namespace boresight::sessions {

/// A column; of several parts ("mean", "std", "max") where it holds several numbers.
struct TableColumn {
  std::string name;  ///< with its unit
  std::vector<std::string> parts = {};
  int decimals = 0;  ///< of its numbers, as text
};

/// Text, or the numbers of a column's parts; a part without a number shows as "-".
struct TableCell {
  // NOLINTBEGIN: rows are lists of texts and numbers
  TableCell(std::string shown) : text(std::move(shown)) {}
  TableCell(const char* shown) : text(shown) {}
  TableCell(std::int64_t count) : text(std::to_string(count)) {}
  TableCell(double value) : values{value} {}
  TableCell(std::optional<double> value) : values{value} {}
  TableCell(std::nullopt_t) : values{std::nullopt} {}
  TableCell(std::vector<std::optional<double>> parts) : values(std::move(parts)) {}
  // NOLINTEND

  std::string text;
  std::vector<std::optional<double>> values;
};

struct Table {
  std::string name;  ///< one word, for file names and labels
  std::string title;
  std::vector<TableColumn> columns;
  std::vector<std::vector<TableCell>> rows;
  std::vector<std::string> notes;  ///< sentences below the table
};

enum class TableFormat { kText, kCsv, kLatex };

/// Text: columns of equal width, parts as "a / b / c", notes below. CSV (RFC 4180): one column per
/// part, numbers in full precision, empty where there is none, notes left out. LaTeX: a `table`
/// with a `tabular` that needs no packages.
std::string tableText(const Table& table, TableFormat format);

}  // namespace boresight::sessions
