// SPDX-License-Identifier: Apache-2.0
// Text from outside (names, comments, paths) made harmless where it is printed.
#pragma once

#include <string>
#include <string_view>

namespace boresight::sessions {

/// `text` with a blank in place of everything that a terminal acts on rather than shows: control
/// characters (C0 with line feed and tab, DEL, C1), marks of writing direction, line separators,
/// and bytes that are not UTF-8. Nothing else changes.
std::string plainText(std::string_view text);

/// `plainText`, and a line feed.
std::string plainLine(std::string_view text);

/// `plainText` with runs of blanks as one blank and none at either end.
std::string oneLine(std::string_view text);

}  // namespace boresight::sessions
