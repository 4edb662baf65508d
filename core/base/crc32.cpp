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

/// The remainder after four bytes more, the first of them the lowest.
std::uint32_t afterWord(std::uint32_t c, std::uint32_t four) {
  c ^= four;
  return kTables[3][c & 0xffu] ^ kTables[2][c >> 8 & 0xffu] ^ kTables[1][c >> 16 & 0xffu] ^
         kTables[0][c >> 24];
}

std::uint32_t afterByte(std::uint32_t c, std::uint8_t byte) {
  return kTables[0][(c ^ byte) & 0xffu] ^ (c >> 8);
}

std::uint32_t reversed(std::uint32_t value) {
  return value << 24 | (value & 0xff00u) << 8 | (value >> 8 & 0xff00u) | value >> 24;
}

}  // namespace

std::uint32_t crc32(std::span<const std::uint8_t> bytes, std::uint32_t before) {
  std::uint32_t c = ~before;
  std::size_t at = 0;
  for (; at + 4 <= bytes.size(); at += 4) c = afterWord(c, word(bytes.data() + at));
  for (; at < bytes.size(); ++at) c = afterByte(c, bytes[at]);
  return ~c;
}

void Crc32::updateBigEndian(std::uint8_t value) { sum_ = ~afterByte(~sum_, value); }

void Crc32::updateBigEndian(std::uint32_t value) { sum_ = ~afterWord(~sum_, reversed(value)); }

}  // namespace boresight
