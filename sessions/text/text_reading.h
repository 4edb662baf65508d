// SPDX-License-Identifier: Apache-2.0
// Lines, words and numbers in text files of other programs, in any locale.
#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <string_view>

#include "sessions/text/plain_text.h"

namespace boresight::sessions {

/// Blanks, tabs and ends of lines.
inline constexpr std::string_view kTextBlanks = " \t\r\n\v\f";

/// The first word of `rest`, which loses it; "" at its end. Words are separated by kTextBlanks.
std::string_view takeWord(std::string_view& rest);

/// The first 40 bytes of a word for messages, on one line.
std::string shortWord(std::string_view word);

/// The number that the whole text is: with a plus sign, without digits on one side of its point,
/// with an exponent behind e, E, d or D (Fortran). Infinite beyond a double, 0 too close to it.
/// Empty for other text, also for "nan" and "inf".
std::optional<double> realIn(std::string_view text);

/// The whole number that the text is, also with a plus sign; empty for other text.
template <class Number>
std::optional<Number> wholeIn(std::string_view text) {
  if (text.starts_with('+') && !text.starts_with("+-")) text.remove_prefix(1);
  return numberIn<Number>(text);
}

/// Whether programs write an undefined or infinite number like this: nan, -nan(ind), inf, 1.#IND.
bool isNotFiniteText(std::string_view text);

/// Why realIn is empty, and what to do: "'1,5' is not a number: write a decimal point".
std::string noNumberText(std::string_view text);

/// The text without zero bytes and Ctrl-Z, the end mark of DOS and CP/M, behind its end.
std::string_view withoutPadding(std::string_view text);

/// Whether the last line has its end; without it a text of lines may be cut.
bool endsItsLine(std::string_view text);
/// The refusal of such a text where its last number may have lost digits.
inline constexpr const char* kOpenEnd =
    "the last line has no line end: the file may be truncated; add the line end if it is whole";

/// The line, from 1, that the byte at `offset` is in.
std::int64_t lineAt(std::string_view text, std::size_t offset);

/// The lines of a text, which end in LF, CR LF, or CR alone (old Mac). The text must outlive it.
class TextLines {
 public:
  explicit TextLines(std::string_view text) : rest_(text) {}

  /// Goes to the next line; false at the end of the text.
  bool next();
  /// Without its end.
  std::string_view line() const { return line_; }
  /// From 1.
  std::int64_t number() const { return number_; }
  /// Whether it is the last line.
  bool isLast() const { return rest_.empty(); }

 private:
  std::string_view rest_;
  std::string_view line_;
  std::int64_t number_ = 0;
};

}  // namespace boresight::sessions
