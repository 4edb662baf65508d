// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>
#include <vector>

namespace boresight::sessions {

/// Columns of equal width for a terminal: the first column left, the others right aligned. Cells
/// are sanitized and stay on one line.
class TextTable {
 public:
  explicit TextTable(const std::vector<std::string>& header) { add(header); }
  void add(const std::vector<std::string>& row);
  /// One line per row, two blanks between columns, a rule under the header.
  std::string text() const;

 private:
  std::vector<std::vector<std::string>> rows_;
};

/// printf's %.*f; "-" for a value that is not finite.
std::string fixedText(double value, int decimals);
/// A share (0 to 1) as "46 %".
std::string percentText(double share, int decimals = 0);

/// "98.7 %"; "> 99.9 %" where rounding would claim certainty.
std::string probabilityPercent(double probability);

/// A cell of a CSV file (RFC 4180): quoted where it must be. A ' is put before text that a
/// spreadsheet would read as a formula (it begins with = + - @, a tab or a line end, and is not a
/// number).
std::string csvField(const std::string& text);

/// The text of a cell, without the ' that `csvField` puts in front of formulas. Quotes are already
/// resolved.
std::string textOfCsvField(const std::string& field);

}  // namespace boresight::sessions
