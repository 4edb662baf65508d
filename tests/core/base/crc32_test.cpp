// SPDX-License-Identifier: Apache-2.0
#include "core/base/crc32.h"

#include <array>
#include <cstdint>
#include <span>
#include <string_view>
#include <vector>

#include <gtest/gtest.h>

#include "core/base/random.h"

namespace boresight {
namespace {

/// Division by the polynomial, a bit at a time.
std::uint32_t bitByBit(std::span<const std::uint8_t> bytes) {
  std::uint32_t c = 0xffffffffu;
  for (const std::uint8_t byte : bytes) {
    c ^= byte;
    for (int bit = 0; bit < 8; ++bit) c = (c & 1u) != 0 ? 0xedb88320u ^ (c >> 1) : c >> 1;
  }
  return ~c;
}

std::vector<std::uint8_t> randomBytes(Random& random, std::size_t size) {
  std::vector<std::uint8_t> bytes(size);
  for (std::uint8_t& byte : bytes) byte = static_cast<std::uint8_t>(random.below(256));
  return bytes;
}

TEST(Crc32, GivesThePublishedCheckValue) {
  constexpr std::string_view kText = "123456789";
  EXPECT_EQ(crc32({reinterpret_cast<const std::uint8_t*>(kText.data()), kText.size()}),
            0xcbf43926u);
  EXPECT_EQ(crc32({}), 0u);
}

TEST(Crc32, EqualsTheDivisionBitByBit_AlsoInPieces) {
  Random random(7);
  for (std::size_t size = 0; size < 40; ++size) {
    const std::vector<std::uint8_t> bytes = randomBytes(random, size);
    const std::uint32_t expected = bitByBit(bytes);
    for (std::size_t split = 0; split <= size; ++split)
      ASSERT_EQ(crc32(std::span(bytes).subspan(split), crc32(std::span(bytes).first(split))),
                expected)
          << size << " " << split;
  }
}

TEST(Crc32, ValuesCountAsTheirBytes_MostSignificantFirst) {
  Random random(9);
  for (int run = 0; run < 50; ++run) {
    Crc32 sum;
    std::vector<std::uint8_t> bytes;
    for (int i = 0; i < 20; ++i) {
      const std::uint64_t high = random.below(0xffffffffu);
      const std::uint64_t value = high << 32 | random.below(0xffffffffu);
      const std::size_t size = std::array{1, 4, 8, 5}[random.below(4)];
      if (size == 1) sum.updateBigEndian(static_cast<std::uint8_t>(value));
      if (size == 4) sum.updateBigEndian(static_cast<std::uint32_t>(value));
      if (size == 8) sum.updateBigEndian(value);
      for (std::size_t k = size; k-- > 0;)
        bytes.push_back(static_cast<std::uint8_t>(value >> (8 * k)));
      if (size == 5) sum.update(std::span(bytes).last(5));
    }
    ASSERT_EQ(sum.value(), bitByBit(bytes)) << run;
  }
}

}  // namespace
}  // namespace boresight
