// SPDX-License-Identifier: Apache-2.0
#include "sessions/text/text_table.h"

#include <algorithm>
#include <cmath>

#include "sessions/text/plain_text.h"

namespace boresight::sessions {
namespace {

bool isNumber(std::string_view text) {
  if (text.starts_with('+')) text.remove_prefix(1);
  return numberIn<double>(text).has_value();
}

/// Whether `text` begins like a formula, behind any number of '.
bool beginsFormula(const std::string& text) {
  const std::size_t first = text.find_first_not_of('\'');
  return first != std::string::npos &&
         std::string_view("=+-@\t\r\n").find(text[first]) != std::string_view::npos;
}

}  // namespace

std::string fixedText(double value, int decimals) {
  if (!std::isfinite(value)) return "-";
  return formatText("%.*f", decimals, value);
}

std::string percentText(double share, int decimals) {
  return fixedText(100.0 * share, decimals) + " %";
}

void TextTable::add(const std::vector<std::string>& row) {
  std::vector<std::string>& cells = rows_.emplace_back();
  for (const std::string& cell : row) cells.push_back(plainText(cell));
}

std::string TextTable::text() const {
  std::vector<std::size_t> widths;
  for (const auto& row : rows_) {
    widths.resize(std::max(widths.size(), row.size()), 0);
    for (std::size_t i = 0; i < row.size(); ++i) widths[i] = std::max(widths[i], row[i].size());
  }
  std::string text;
  for (std::size_t r = 0; r < rows_.size(); ++r) {
    std::string line;
    for (std::size_t i = 0; i < rows_[r].size(); ++i) {
      const std::string& cell = rows_[r][i];
      const std::string padding(widths[i] - cell.size(), ' ');
      line += (i > 0 ? "  " : "") + (i == 0 ? cell + padding : padding + cell);
    }
    line.erase(line.find_last_not_of(' ') + 1);
    text += line + "\n";
    if (r > 0) continue;
    const std::size_t gaps = 2 * (widths.size() - 1);
    text += std::string(std::accumulate(widths.begin(), widths.end(), gaps), '-') + "\n";
  }
  return text;
}

std::string probabilityPercent(double probability) {
  constexpr double kMostShown = 0.9995;
  return probability >= kMostShown ? "> 99.9 %" : percentText(probability, 1);
}

std::string csvField(const std::string& text) {
  const std::string shown = beginsFormula(text) && !isNumber(text) ? "'" + text : text;
  if (shown.find_first_of(",\"\r\n") == std::string::npos) return shown;
  std::string quoted = "\"";
  for (const char c : shown) quoted += c == '"' ? "\"\"" : std::string(1, c);
  return quoted + "\"";
}

std::string textOfCsvField(const std::string& field) {
  return field.starts_with('\'') && beginsFormula(field) ? field.substr(1) : field;
}

}  // namespace boresight::sessions
