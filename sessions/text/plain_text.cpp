// SPDX-License-Identifier: Apache-2.0
#include "sessions/text/plain_text.h"

#include <algorithm>
#include <bit>
#include <cstdarg>
#include <cstdint>
#include <cstdio>

#include <locale.h>

namespace boresight::sessions {
namespace {

struct Character {
  std::uint32_t code = 0;
  std::size_t bytes = 1;
  bool valid = false;
};

/// The first character of `text`, which is not empty; a single byte where it is not UTF-8.
Character firstCharacter(std::string_view text) {
  const auto lead = static_cast<unsigned char>(text.front());
  if (lead < 0x80) return {lead, 1, true};
  const auto bytes = static_cast<std::size_t>(std::countl_one(lead));
  if (bytes < 2 || bytes > 4 || bytes > text.size()) return {};
  std::uint32_t code = lead & (0x7fU >> bytes);
  for (const char c : text.substr(1, bytes - 1)) {
    const auto next = static_cast<unsigned char>(c);
    if ((next & 0xc0U) != 0x80U) return {};
    code = code << 6U | (next & 0x3fU);
  }
  constexpr std::uint32_t kLeast[] = {0, 0, 0x80, 0x800, 0x10000};
  return {code, bytes, code >= kLeast[bytes]};
}

bool isShown(const Character& character) {
  const std::uint32_t code = character.code;
  const auto within = [code](std::uint32_t first, std::uint32_t last) {
    return code >= first && code <= last;
  };
  const bool control = code < 0x20 || within(0x7f, 0x9f) || within(0x2028, 0x2029);
  const bool direction =
      code == 0x61c || within(0x200e, 0x200f) || within(0x202a, 0x202e) || within(0x2066, 0x2069);
  return character.valid && !control && !direction;
}

/// The calling thread formats numbers as in the C locale while this lives.
class PlainLocale {
 public:
  PlainLocale() : before_(::uselocale(plain())) {}
  PlainLocale(const PlainLocale&) = delete;
  PlainLocale& operator=(const PlainLocale&) = delete;
  ~PlainLocale() { ::uselocale(before_); }

 private:
  static locale_t plain() {
    static const locale_t c_locale = ::newlocale(LC_ALL_MASK, "C", nullptr);
    return c_locale;
  }
  locale_t before_;
};

/// Blanks, and characters without a glyph of their own (Unicode: White_Space,
/// Default_Ignorable_Code_Point, control characters, the blank Braille pattern).
bool isInvisible(const Character& character) {
  struct Range {
    std::uint32_t first, last;
  };
  constexpr Range kRanges[] = {
      {0x00, 0x20},       {0x7f, 0xa0},      {0xad, 0xad},     {0x34f, 0x34f},   {0x61c, 0x61c},
      {0x115f, 0x1160},   {0x1680, 0x1680},  {0x17b4, 0x17b5}, {0x180b, 0x180f}, {0x2000, 0x200f},
      {0x2028, 0x202f},   {0x205f, 0x206f},  {0x2800, 0x2800}, {0x3000, 0x3000}, {0x3164, 0x3164},
      {0xfe00, 0xfe0f},   {0xfeff, 0xfeff},  {0xffa0, 0xffa0}, {0xfff0, 0xfffb}, {0x1bca0, 0x1bca3},
      {0x1d173, 0x1d17a}, {0xe0000, 0xe0fff}};
  return character.valid && std::ranges::any_of(kRanges, [&character](const Range& range) {
           return range.first <= character.code && character.code <= range.last;
         });
}

/// Of ASCII letters and digits, beyond it all that is visible but General Punctuation.
bool isLetter(const Character& character) {
  const std::uint32_t code = character.code;
  if (!character.valid) return true;
  if (code < 0x80)
    return (code >= '0' && code <= '9') || (code >= 'A' && code <= 'Z') ||
           (code >= 'a' && code <= 'z');
  return !isInvisible(character) && !(code >= 0x2010 && code <= 0x205e);
}

}  // namespace

std::string trimmedVisible(std::string_view text) {
  std::size_t begin = text.size(), end = 0;
  for (std::size_t at = 0; at < text.size();) {
    const Character character = firstCharacter(text.substr(at));
    const std::size_t next = at + (character.valid ? character.bytes : 1);
    if (!isInvisible(character)) {
      begin = std::min(begin, at);
      end = next;
    }
    at = next;
  }
  return begin < end ? std::string(text.substr(begin, end - begin)) : std::string();
}

std::string lettersOf(std::string_view text) {
  std::string letters;
  while (!text.empty()) {
    const Character first = firstCharacter(text);
    const std::size_t bytes = first.valid ? first.bytes : 1;
    if (isLetter(first)) letters += text.substr(0, bytes);
    text.remove_prefix(bytes);
  }
  return lowerCase(letters);
}

std::string plainText(std::string_view text) {
  std::string plain;
  plain.reserve(text.size());
  while (!text.empty()) {
    const Character first = firstCharacter(text);
    plain += isShown(first) ? text.substr(0, first.bytes) : std::string_view(" ");
    text.remove_prefix(first.valid ? first.bytes : 1);
  }
  return plain;
}

std::string plainLine(std::string_view text) { return plainText(text) + "\n"; }

std::string oneLine(std::string_view text) {
  std::string line = plainText(text);
  line.erase(
      std::unique(line.begin(), line.end(), [](char a, char b) { return a == ' ' && b == ' '; }),
      line.end());
  if (line.ends_with(' ')) line.pop_back();
  return line.starts_with(' ') ? line.substr(1) : line;
}

std::string_view trimmed(std::string_view text) {
  constexpr const char* kBlanks = " \t\r\n";
  const auto first = text.find_first_not_of(kBlanks);
  if (first == std::string_view::npos) return {};
  return text.substr(first, text.find_last_not_of(kBlanks) - first + 1);
}

std::string joined(const std::vector<std::string>& texts) {
  std::string all;
  for (const std::string& text : texts) all += (all.empty() ? "" : ", ") + text;
  return all;
}

std::string listText(const std::vector<std::string>& names) {
  std::string text;
  for (std::size_t i = 0; i < names.size(); ++i)
    text += (i == 0 ? "" : i + 1 == names.size() ? " and " : ", ") + names[i];
  return text;
}

std::string countText(std::int64_t count, const std::string& item) {
  return std::to_string(count) + " " + item + (count == 1 ? "" : "s");
}

std::string sizeText(std::int64_t width, std::int64_t height) {
  return std::to_string(width) + " x " + std::to_string(height);
}

std::string asSentence(std::string clause) {
  if (clause.empty()) return clause;
  if (clause.front() >= 'a' && clause.front() <= 'z')
    clause.front() = static_cast<char>(clause.front() - 'a' + 'A');
  return clause.ends_with('.') ? clause : clause + ".";
}

std::string formatText(const char* pattern, ...) {
  const PlainLocale plain;
  va_list arguments;
  va_start(arguments, pattern);
  va_list measured;
  va_copy(measured, arguments);
  const int length = std::vsnprintf(nullptr, 0, pattern, measured);
  va_end(measured);
  std::string text(static_cast<std::size_t>(std::max(length, 0)), '\0');
  std::vsnprintf(text.data(), text.size() + 1, pattern, arguments);
  va_end(arguments);
  return text;
}

std::string threeDigits(double value) { return formatText("%.3g", value); }

std::string lowerCase(std::string_view text) {
  std::string lower(text);
  for (char& c : lower)
    if (c >= 'A' && c <= 'Z') c = static_cast<char>(c - 'A' + 'a');
  return lower;
}

std::string upperCase(std::string_view text) {
  std::string upper(text);
  for (char& c : upper)
    if (c >= 'a' && c <= 'z') c = static_cast<char>(c - 'a' + 'A');
  return upper;
}

}  // namespace boresight::sessions
