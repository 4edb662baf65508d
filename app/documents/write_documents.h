// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <filesystem>
#include <string>

#include "app/documents/program.h"

namespace boresight::documents {

/// Writes man1/NAME.1, bash/NAME, zsh/_NAME, fish/NAME.fish and the manual's page manual/NAME.md
/// below the folder, which is made when it is not there. What went wrong, or "".
[[nodiscard]] std::string writeDocuments(const Program& program, const std::string& version,
                                         const std::filesystem::path& folder);

}  // namespace boresight::documents
