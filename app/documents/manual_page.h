// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>
#include <utility>
#include <vector>

#include "app/documents/program.h"

namespace boresight::documents {

/// A page of section 1, in roff's man macros: its file's name, "whs-localize.1", and its text.
using ManualPage = std::pair<std::string, std::string>;

/// The program's page, and one for each of its commands. The same program makes the same bytes: no
/// dates.
std::vector<ManualPage> manualPages(const Program& program, const std::string& version);

}  // namespace boresight::documents
