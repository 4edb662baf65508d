// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>
#include <vector>

namespace boresight::sessions {

/// Columns of equal width for a terminal: the first column left, the others right aligned. A cell
/// stays on its line, whatever text from outside is in it.
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

}  // namespace boresight::sessions
