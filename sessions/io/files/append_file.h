// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <filesystem>
#include <string_view>

namespace boresight::sessions {

/// Appends to a file that is `size_bytes` long; the text is stored when this returns. OutputError,
/// also when the file has another size; then it is unchanged.
void appendToFile(const std::filesystem::path& file, std::uint64_t size_bytes,
                  std::string_view text);

}  // namespace boresight::sessions
