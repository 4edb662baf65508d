// SPDX-License-Identifier: Apache-2.0
// Values of labels as they were written: with units, blanks, line ends inside texts, numbers as
// texts, and words for missing values.
#pragma once

#include <cstdint>
#include <initializer_list>
#include <optional>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include <nlohmann/json_fwd.hpp>

#include "sessions/text/plain_text.h"

#include "sessions/io/images/labels/label_files.h"

namespace boresight::sessions {

/// Blanks, tabs and line ends.
inline bool isBlank(char c) { return c == ' ' || (c >= '\t' && c <= '\r'); }
/// The text after its leading blanks.
inline std::string_view skipBlanks(std::string_view text) {
  while (!text.empty() && isBlank(text.front())) text.remove_prefix(1);
  return text;
}

/// The elements of a list; a single value is a list of one, no value an empty list.
std::vector<const nlohmann::json*> labelList(const nlohmann::json* value);
/// Whether the text is one of these words.
bool isOneOf(std::string_view text, std::initializer_list<std::string_view> words);
/// A member of an object; nullptr when either is missing.
const nlohmann::json* labelMember(const nlohmann::json* object, std::string_view key);
/// The member of the first of these keys that exists.
const nlohmann::json* labelMember(const nlohmann::json* object,
                                  std::initializer_list<std::string_view> keys);
/// A nested member, by the keys from the outside inwards.
const nlohmann::json* labelPath(const nlohmann::json* object,
                                std::initializer_list<std::string_view> keys);

/// The text on one line without blanks around it; empty for "", N/A, NULL, UNK and UNKNOWN; NONE is
/// kept. Numbers become text.
std::optional<std::string> labelText(const nlohmann::json* value);
/// Every text of a list, "" where one is absent; a single value is a list of one.
std::vector<std::string> labelTexts(const nlohmann::json* value);
/// A finite number, also one written as a text, with a unit, or with D for E.
std::optional<double> labelNumber(const nlohmann::json* value);
/// All numbers of a list; empty when an element is not a number. A single value is a list of one.
std::vector<double> labelNumbers(const nlohmann::json* value);
std::optional<std::int64_t> labelInteger(const nlohmann::json* value);
/// The unit of a value, upper case, "" without one; all units of a list, each once.
std::string labelUnit(const nlohmann::json* value);

/// Bits of a number as labels write them: 16#FF7FFFFB#, 0xFF7FFFFB or 2#1101#.
struct BitPattern {
  std::uint64_t bits = 0;
  int width = 0;  ///< of the digits written, in bits
};
std::optional<BitPattern> bitPattern(std::string_view text);

/// Groups of a VICAR label (its properties) or a PDS3 label (groups and objects) by name; a name
/// may occur twice. Empty for PDS4.
std::vector<std::pair<std::string, const nlohmann::json*>> labelGroups(LabelFormat format,
                                                                       const nlohmann::json& label);
/// The first value of `key` in these groups, in this order; null without one. Of several groups of
/// one name only the first counts.
const nlohmann::json* labelItem(LabelFormat format, const nlohmann::json& label,
                                std::initializer_list<std::string_view> groups,
                                std::string_view key);

/// Elements of this name anywhere in a PDS4 label except under `except`, in order; at most 1000.
std::vector<const nlohmann::json*> elementsNamed(const nlohmann::json& label, std::string_view name,
                                                 std::string_view except = {});

}  // namespace boresight::sessions
