// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <filesystem>
#include <functional>

namespace boresight::sessions {

/// Makes a folder with all its files or not at all: `write` fills a folder beside it, which gets
/// the name when it returns; when it throws, nothing is left behind. OutputError when there is
/// something of this name already, unless it is an empty folder, or it cannot be made.
void writeFolderAtomically(const std::filesystem::path& folder,
                           const std::function<void(const std::filesystem::path&)>& write);

}  // namespace boresight::sessions
