// SPDX-License-Identifier: Apache-2.0
#include "core/base/image.h"

#include <array>
#include <set>
#include <utility>
#include <vector>

#include <gtest/gtest.h>

#include "core/base/random.h"

namespace boresight {
namespace {

TEST(ImageView, ReadsRowsAtItsStride) {
  const std::array<std::uint8_t, 12> pixels = {1, 2, 3, 99, 4, 5, 6, 99, 7, 8, 9, 99};
  const ImageView image{pixels.data(), 3, 3, 4};
  EXPECT_EQ(image.at(0, 0), 1);
  EXPECT_EQ(image.at(2, 1), 6);
  EXPECT_EQ(image.row(2)[1], 8);
  const ImageView upside_down{pixels.data() + 8, 3, 3, -4};
  EXPECT_EQ(upside_down.at(0, 0), 7);
  EXPECT_EQ(upside_down.at(2, 2), 3);
}

TEST(BitImage, KeepsEveryPixelApart) {
  std::vector<std::byte> block(1 << 16);
  Random random(31);
  for (const int width : {1, 63, 64, 65, 200}) {
    Arena arena(block);
    BitImage image = BitImage::create(arena, width, 9);
    ASSERT_EQ(image.words_per_row, (width + 63) / 64);
    std::set<std::pair<int, int>> set;
    for (int i = 0; i < 300; ++i) {
      const int x = static_cast<int>(random.below(static_cast<std::uint32_t>(width)));
      const int y = static_cast<int>(random.below(9));
      if (random.below(3) > 0) {
        image.set(x, y);
        set.insert({x, y});
      } else {
        image.reset(x, y);
        set.erase({x, y});
      }
    }
    for (int y = 0; y < 9; ++y)
      for (int x = 0; x < width; ++x) EXPECT_EQ(image.get(x, y), set.contains({x, y}));
    image.clear();
    for (const std::uint64_t word : image.words) EXPECT_EQ(word, 0u);
  }
}

TEST(BitImage, PixelIsBitXModulo64OfWordXOver64) {
  std::vector<std::byte> block(1024);
  Arena arena(block);
  BitImage image = BitImage::create(arena, 130, 2);
  image.set(65, 1);
  EXPECT_EQ(image.words[3 + 1], std::uint64_t{2});
  EXPECT_EQ(image.row(1)[1], std::uint64_t{2});
}

TEST(BitImage, ContainsItsPixelsOnly) {
  const BitImage image{{}, 10, 5, 1};
  EXPECT_TRUE(image.contains(0, 0));
  EXPECT_TRUE(image.contains(9, 4));
  for (const auto& [x, y] : {std::pair{-1, 0}, {0, -1}, {10, 0}, {0, 5}})
    EXPECT_FALSE(image.contains(x, y));
}

}  // namespace
}  // namespace boresight
