// SPDX-License-Identifier: Apache-2.0
#include "sessions/text/text_reading.h"

#include <algorithm>
#include <charconv>
#include <limits>
#include <string>

namespace boresight::sessions {
namespace {

/// The number before an exponent of Fortran, as C writes it: "1.5D+02" as "1.5e+02".
std::string withPlainExponent(std::string_view text) {
  std::string plain(text);
  std::ranges::replace_if(
      plain, [](char c) { return c == 'd' || c == 'D'; }, 'e');
  return plain;
}

bool hasDigit(std::string_view text) {
  return text.find_first_of("0123456789") != std::string_view::npos;
}

bool hasDigitAboveZero(std::string_view text) {
  return text.find_first_of("123456789") != std::string_view::npos;
}

/// A number that std::from_chars takes whole, or that exceeds a double.
std::optional<double> plainReal(std::string_view text) {
  double value = 0.0;
  const char* const end = text.data() + text.size();
  const auto [stop, error] = std::from_chars(text.data(), end, value);
  if (stop != end || error == std::errc::invalid_argument) return std::nullopt;
  if (error == std::errc()) return value;
  const std::size_t exponent = text.find_first_of("eE");
  const bool small = exponent == std::string_view::npos
                         ? !hasDigitAboveZero(text.substr(0, text.find('.')))
                         : text.substr(exponent + 1).starts_with('-');
  if (small) return 0.0;
  constexpr double kInfinity = std::numeric_limits<double>::infinity();
  return text.starts_with('-') ? -kInfinity : kInfinity;
}

}  // namespace

std::string_view takeWord(std::string_view& rest) {
  rest.remove_prefix(std::min(rest.find_first_not_of(kTextBlanks), rest.size()));
  const std::string_view word = rest.substr(0, rest.find_first_of(kTextBlanks));
  rest.remove_prefix(word.size());
  return word;
}

std::string shortWord(std::string_view word) { return oneLine(word.substr(0, 40)); }

std::optional<double> realIn(std::string_view text) {
  if (text.starts_with('+') && !text.starts_with("+-")) text.remove_prefix(1);
  if (text.find_first_not_of("0123456789.+-eEdD") != std::string_view::npos || !hasDigit(text))
    return std::nullopt;
  if (text.find_first_of("dD") == std::string_view::npos) return plainReal(text);
  return plainReal(withPlainExponent(text));
}

bool isNotFiniteText(std::string_view text) {
  if (text.starts_with('+') || text.starts_with('-')) text.remove_prefix(1);
  const std::string word = lowerCase(text);
  return word.starts_with("nan") || word == "inf" || word == "infinity" || word.starts_with("1.#");
}

std::string noNumberText(std::string_view text) {
  const std::string quoted = "'" + shortWord(text) + "' is not a ";
  if (isNotFiniteText(text)) return quoted + "finite number";
  const bool ascii = std::ranges::all_of(text, [](char c) { return c >= 0; });
  if (!ascii) return quoted + "number: write its digits, sign and the blanks around it in ASCII";
  const bool comma = hasDigit(text) && std::ranges::count(text, ',') == 1;
  return quoted + (comma ? "number: write a decimal point" : "number");
}

std::string_view withoutPadding(std::string_view text) {
  using namespace std::string_view_literals;
  constexpr std::string_view kPadding = "\0\x1a"sv;
  const std::size_t end = text.find_last_not_of("\0\x1a \t\r\n"sv) + 1;
  return text.substr(0, std::min(text.find_first_of(kPadding, end), text.size()));
}

bool endsItsLine(std::string_view text) {
  return text.empty() || text.ends_with('\n') || text.ends_with('\r');
}

std::int64_t lineAt(std::string_view text, std::size_t offset) {
  const std::string_view before = text.substr(0, offset);
  std::int64_t line = 1;
  for (std::size_t i = 0; i < before.size(); ++i)
    if (before[i] == '\n' || (before[i] == '\r' && !before.substr(i + 1).starts_with('\n'))) ++line;
  return line;
}

bool TextLines::next() {
  if (rest_.empty()) return false;
  const std::size_t end = std::min(rest_.find_first_of("\r\n"), rest_.size());
  line_ = rest_.substr(0, end);
  const std::size_t end_bytes = rest_.substr(end).starts_with("\r\n") ? 2 : 1;
  rest_.remove_prefix(std::min(end + end_bytes, rest_.size()));
  ++number_;
  return true;
}

}  // namespace boresight::sessions
