// SPDX-License-Identifier: Apache-2.0
#include "sessions/text/csv_field.h"

#include <charconv>

namespace boresight::sessions {
namespace {

bool isNumber(const std::string& text) {
  const char* begin = text.data();
  const char* end = begin + text.size();
  if (text.starts_with('+')) ++begin;
  double value = 0.0;
  const auto [stop, error] = std::from_chars(begin, end, value);
  return error == std::errc() && stop == end;
}

/// Whether `text` begins like a formula, behind any number of '.
bool beginsFormula(const std::string& text) {
  const std::size_t first = text.find_first_not_of('\'');
  return first != std::string::npos &&
         std::string_view("=+-@\t\r\n").find(text[first]) != std::string_view::npos;
}

}  // namespace

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
