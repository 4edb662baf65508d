// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <cstdint>
#include <filesystem>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "sessions/io/input_files.h"

namespace boresight::sessions {

inline constexpr std::size_t kMegabyte = std::size_t{1} << 20;

/// The whole file, read once: what is hashed is what is parsed. InputError when it is missing, a
/// folder, a pipe or a device, not readable, empty, or longer than `max_bytes`. From then on no
/// output replaces it (input_files.h).
std::vector<std::uint8_t> readFileBytes(const std::filesystem::path& file, std::size_t max_bytes,
                                        FileUse use = FileUse::kInput);

/// At most the first `count` bytes of the file; refuses the same files.
std::vector<std::uint8_t> readBeginning(const std::filesystem::path& file, std::size_t count);

std::string_view asText(std::span<const std::uint8_t> bytes);

/// SHA-256 as 64 lower-case hexadecimal digits.
std::string sha256Text(std::span<const std::uint8_t> bytes);

}  // namespace boresight::sessions
