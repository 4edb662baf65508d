// SPDX-License-Identifier: Apache-2.0
#include "core/edges/bit_rows.h"

#include <gtest/gtest.h>

#include <algorithm>

#include "tests/core/edges/test_images.h"

namespace boresight {
namespace {

bool anyWithin(const BitImage& bits, int x, int y, int margin_px) {
  for (int v = std::max(y - margin_px, 0); v <= std::min(y + margin_px, bits.height - 1); ++v)
    for (int u = std::max(x - margin_px, 0); u <= std::min(x + margin_px, bits.width - 1); ++u)
      if (bits.get(u, v)) return true;
  return false;
}

TEST(DilateRow, SetsPixelsWithinTheMargin) {
  Random random(31);
  for (const Size size : kSizes) {
    for (const int margin_px : {0, 1, 2, 3, 5, 13, 63, 64}) {
      TestBits bits(size.width, size.height);
      fillAtRandom(*bits, 400, random);
      TestBits row(size.width, 1);
      for (int y = 0; y < size.height; ++y) {
        dilateRow(*bits, y, margin_px, row->row(0));
        for (int x = 0; x < size.width; ++x)
          ASSERT_EQ(row->get(x, 0), anyWithin(*bits, x, y, margin_px))
              << testing::PrintToString(size) << " margin " << margin_px;
      }
    }
  }
}

TEST(PoolRows, IsTheOrOfTwoByTwoPixels) {
  Random random(32);
  for (const Size size : kSizes) {
    TestBits fine(size.width, size.height);
    fillAtRandom(*fine, 6, random);
    TestBits coarse((size.width + 1) / 2, (size.height + 1) / 2);
    fillAtRandom(*coarse, 1, random);  // must be overwritten
    const int middle = coarse->height / 2;
    poolRows(*fine, 0, middle, *coarse);
    poolRows(*fine, middle, coarse->height, *coarse);
    TestBits expected(coarse->width, coarse->height);
    for (int y = 0; y < size.height; ++y)
      for (int x = 0; x < size.width; ++x)
        if (fine->get(x, y)) expected->set(x / 2, y / 2);
    // No bit beyond the width either.
    ASSERT_TRUE(std::ranges::equal(coarse->words, expected->words)) << testing::PrintToString(size);
  }
}

}  // namespace
}  // namespace boresight
