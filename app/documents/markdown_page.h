// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>

#include "app/documents/program.h"

namespace boresight::documents {

/// Text that a Markdown reader shows as it is, also in a cell of a table.
std::string markdownText(const std::string& text);

/// A page of the manual: the program, each of its commands under a heading of its own, and every
/// option with its value, limits and default. The same program makes the same bytes.
std::string markdownPage(const Program& program);

}  // namespace boresight::documents
