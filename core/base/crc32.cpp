// SPDX-License-Identifier: Apache-2.0
#include "core/base/crc32.h"

#include <array>
#include <cstddef>

namespace boresight {
namespace {

/// Row k: remainders of a byte that k bytes follow.
using Tables = std::array<std::array<std::uint32_t, 256>, 4>;

constexpr Tables crcTables() {
  Tables tables{};
  for (std::uint32_t n = 0; n < 256; ++n) {
    std::uint32_t c = n;
    for (int bit = 0; bit < 8; ++bit) c = (c & 1u) != 0 ? 0xedb88320u ^ (c >> 1) : c >> 1;
    tables[0][n] = c;
  }
  for (std::size_t k = 1; k < tables.size(); ++k)
    for (std::size_t n = 0; n < 256; ++n) {
      const std::uint32_t c = tables[k - 1][n];
      tables[k][n] = tables[0][c & 0xffu] ^ (c >> 8);
    }
  return tables;
}

constexpr Tables kTables = crcTables();

/// Four bytes, the first the lowest, whatever the processor's order.
std::uint32_t word(const std::uint8_t* bytes) {
  return std::uint32_t{bytes[0]} | std::uint32_t{bytes[1]} << 8 | std::uint32_t{bytes[2]} << 16 |
         std::uint32_t{bytes[3]} << 24;
}

}  // namespace

std::uint32_t crc32(std::span<const std::uint8_t> bytes, std::uint32_t before) {
  std::uint32_t c = ~before;
  std::size_t at = 0;
  for (; at + 4 <= bytes.size(); at += 4) {
    c ^= word(bytes.data() + at);
    c = kTables[3][c & 0xffu] ^ kTables[2][c >> 8 & 0xffu] ^ kTables[1][c >> 16 & 0xffu] ^
        kTables[0][c >> 24];
  }
  for (; at < bytes.size(); ++at) c = kTables[0][(c ^ bytes[at]) & 0xffu] ^ (c >> 8);
  return ~c;
}

}  // namespace boresight
