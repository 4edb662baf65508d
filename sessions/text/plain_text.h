// SPDX-License-Identifier: Apache-2.0
// Sanitizes text from outside (names, comments, paths) for printing.
#pragma once

#include <charconv>
#include <optional>
#include <string>
#include <string_view>

namespace boresight::sessions {

/// `text` with a blank in place of all characters that control a terminal: control characters (C0
/// with line feed and tab, DEL, C1), marks of writing direction, line separators, and bytes that
/// are not UTF-8. Nothing else changes.
std::string plainText(std::string_view text);

/// `plainText`, and a line feed.
std::string plainLine(std::string_view text);

/// `plainText` with runs of blanks as one blank and none at either end.
std::string oneLine(std::string_view text);

/// The text without leading and trailing blanks, tabs and line ends.
std::string_view trimmed(std::string_view text);

/// A to Z as a to z, and the reverse, in any locale.
std::string lowerCase(std::string_view text);
std::string upperCase(std::string_view text);

/// Parses the whole text as a number, integers also in another base; empty when it is none.
/// Independent of the locale; a plus sign or blanks are not accepted.
template <class Number, class... Base>
std::optional<Number> numberIn(std::string_view text, Base... base) {
  Number value{};
  const char* const end = text.data() + text.size();
  const auto [stop, error] = std::from_chars(text.data(), end, value, base...);
  if (error != std::errc() || stop != end) return std::nullopt;
  return value;
}

}  // namespace boresight::sessions
