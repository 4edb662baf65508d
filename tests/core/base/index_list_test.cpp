// SPDX-License-Identifier: Apache-2.0
#include "core/base/index_list.h"

#include <cstddef>
#include <vector>

#include <gtest/gtest.h>

#include "core/base/random.h"

namespace boresight {
namespace {

std::vector<std::byte> blockFor(std::size_t count, std::size_t bound) {
  Arena counter;
  (void)IndexList::create(count, bound, counter);
  return std::vector<std::byte>(counter.used());
}

TEST(IndexList, HoldsAllIndicesBelowItsBound) {
  Random random(1);
  for (const std::size_t bound : {1u, 2u, 300u, 65534u, 65535u, 65536u, 65537u, 1u << 20}) {
    constexpr std::size_t kCount = 500;
    std::vector<std::byte> block = blockFor(kCount, bound);
    Arena arena(block);
    IndexList list = IndexList::create(kCount, bound, arena);
    ASSERT_EQ(list.size(), kCount);
    for (std::size_t i = 0; i < kCount; ++i) ASSERT_EQ(list[i], -1);
    const auto last = static_cast<std::int32_t>(bound) - 1;
    std::vector<std::int32_t> expected(kCount, -1);
    expected[0] = last;
    expected[1] = 0;
    for (std::size_t i = 2; i < kCount; ++i)
      expected[i] =
          static_cast<std::int32_t>(random.below(static_cast<std::uint32_t>(bound) + 1)) - 1;
    for (std::size_t i = 0; i < kCount; ++i) list.set(i, last);
    for (std::size_t i = 0; i < kCount; ++i) list.set(i, expected[i]);
    for (std::size_t i = 0; i < kCount; ++i) ASSERT_EQ(list[i], expected[i]) << bound;
  }
}

TEST(IndexList, TakesTwoBytesWhereTheyAreEnough) {
  EXPECT_EQ(blockFor(800, 65535).size(), 1600u);
  EXPECT_EQ(blockFor(800, 65536).size(), 3200u);
}

}  // namespace
}  // namespace boresight
