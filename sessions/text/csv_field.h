// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>

namespace boresight::sessions {

/// A cell of a CSV file (RFC 4180): quoted where it must be. Text that a spreadsheet would take for
/// a formula (it begins with = + - @, a tab or a line end, and is not a number) gets a ' in front.
std::string csvField(const std::string& text);

/// The text of a cell, without the ' that `csvField` puts in front of formulas. Quotes are already
/// resolved.
std::string textOfCsvField(const std::string& field);

}  // namespace boresight::sessions
