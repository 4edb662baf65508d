// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <span>

namespace boresight::sessions {

/// Whether `count` bytes from `offset` on exist.
inline bool holds(std::span<const std::uint8_t> bytes, std::uint64_t offset, std::uint64_t count) {
  return offset <= bytes.size() && count <= bytes.size() - offset;
}

/// Unsigned number of `size` bytes (1 .. 8) at `offset`, which must exist.
inline std::uint64_t readUnsigned(std::span<const std::uint8_t> bytes, std::uint64_t offset,
                                  int size, bool big_endian) {
  std::uint64_t value = 0;
  for (int i = 0; i < size; ++i) {
    const auto place = offset + static_cast<std::uint64_t>(big_endian ? i : size - 1 - i);
    value = value << 8 | bytes[static_cast<std::size_t>(place)];
  }
  return value;
}

}  // namespace boresight::sessions
