// SPDX-License-Identifier: Apache-2.0
#include "core/base/arena.h"

#include <cstdint>
#include <vector>

#include <gtest/gtest.h>

namespace boresight {
namespace {

struct Cell {
  double value = 1.5;
  std::uint8_t flag = 3;
};

TEST(Arena, HandsOutInitializedObjectsThatDoNotOverlap) {
  std::vector<std::byte> block(4096, std::byte{0xff});
  Arena arena(block);
  const auto bytes = arena.allocate<std::uint8_t>(5);
  const auto cells = arena.allocate<Cell>(7);
  const auto words = arena.allocate<std::uint64_t>(3);
  ASSERT_EQ(bytes.size(), 5u);
  ASSERT_EQ(cells.size(), 7u);
  ASSERT_EQ(words.size(), 3u);
  for (const std::uint8_t byte : bytes) EXPECT_EQ(byte, 0);
  for (const Cell& cell : cells) EXPECT_EQ(cell.value, 1.5);
  for (const std::uint64_t word : words) EXPECT_EQ(word, 0u);
  EXPECT_LE(static_cast<const void*>(bytes.data() + 5), static_cast<const void*>(cells.data()));
  EXPECT_LE(static_cast<const void*>(cells.data() + 7), static_cast<const void*>(words.data()));
  EXPECT_EQ(arena.used() % Arena::kAlignment, 0u);
}

TEST(Arena, CountingGivesExactlyWhatUsingNeeds) {
  const auto allocateAll = [](Arena& arena) {
    (void)arena.allocate<std::uint8_t>(1);
    const std::size_t mark = arena.mark();
    (void)arena.allocate<Cell>(100);
    arena.rewind(mark);
    (void)arena.allocate<double>(9);
  };
  Arena counter;
  allocateAll(counter);
  EXPECT_TRUE(counter.countsOnly());
  EXPECT_FALSE(counter.exhausted());
  EXPECT_LT(counter.used(), counter.highWater());

  std::vector<std::byte> block(counter.highWater());
  Arena exact(block);
  allocateAll(exact);
  EXPECT_FALSE(exact.exhausted());
  EXPECT_EQ(exact.highWater(), counter.highWater());

  Arena short_by_one(std::span<std::byte>(block).first(block.size() - 1));
  allocateAll(short_by_one);
  EXPECT_TRUE(short_by_one.exhausted());
}

TEST(Arena, ExhaustedArena_GivesEmptySpans) {
  std::vector<std::byte> block(64);
  Arena arena(block);
  EXPECT_EQ(arena.allocate<double>(8).size(), 8u);
  EXPECT_TRUE(arena.allocate<std::uint8_t>(1).empty());
  arena.rewind(0);
  EXPECT_TRUE(arena.allocate<std::uint8_t>(1).empty()) << "one failure spoils the whole layout";
}

TEST(Arena, ReusesMemoryAfterRewinding) {
  std::vector<std::byte> block(256);
  Arena arena(block);
  const std::size_t mark = arena.mark();
  std::uint32_t* first = arena.allocate<std::uint32_t>(4).data();
  first[0] = 77;
  arena.rewind(mark);
  const auto again = arena.allocate<std::uint32_t>(4);
  EXPECT_EQ(again.data(), first);
  EXPECT_EQ(again[0], 0u) << "fresh objects, not the old ones";
}

}  // namespace
}  // namespace boresight
