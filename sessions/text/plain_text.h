// SPDX-License-Identifier: Apache-2.0
// Text from outside (names, comments, paths) sanitized for printing, and short texts for sentences.
#pragma once

#include <charconv>
#include <cstdint>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

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

/// The text without blanks and invisible characters of Unicode at both ends: a text of these alone
/// is empty. Bytes that are not UTF-8 count as visible.
std::string trimmedVisible(std::string_view text);

/// The letters and digits of a text, for comparing names: without blanks, invisible characters and
/// punctuation of ASCII and of Unicode's General Punctuation; A to Z as a to z. Letters of two
/// scripts that look alike stay different.
std::string lettersOf(std::string_view text);

/// Several texts as one, separated by ", ".
std::string joined(const std::vector<std::string>& texts);

/// "A", "A and B", "A, B and C".
std::string listText(const std::vector<std::string>& names);

/// "1 case", "2 cases".
std::string countText(std::int64_t count, const std::string& item);

/// An image's size in pixels: "1024 x 768".
std::string sizeText(std::int64_t width, std::int64_t height);

/// A clause with its first letter in upper case and a full stop at its end; "" stays "".
std::string asSentence(std::string clause);

/// As printf in the C locale, whatever locale the program or the calling thread has.
[[gnu::format(printf, 1, 2)]] std::string formatText(const char* pattern, ...);

/// "%.3g": at most three significant digits, such as "0.02".
std::string threeDigits(double value);

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
