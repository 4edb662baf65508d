// SPDX-License-Identifier: Apache-2.0
#include <array>
#include <limits>
#include <vector>

#include <gtest/gtest.h>

#include "core/base/bytes.h"

namespace boresight {
namespace {

TEST(Bytes, AreBigEndian) {
  std::array<std::uint8_t, 27> block{};
  ByteWriter writer(block);
  writer.u8(0x01);
  writer.u16(0x0203);
  writer.u32(0x04050607);
  writer.u64(0x08090a0b0c0d0e0f);
  writer.f32(1.0f);
  writer.f64(-2.0);
  EXPECT_EQ(writer.written(), block.size());
  for (std::uint8_t i = 0; i < 15; ++i) EXPECT_EQ(block[i], i + 1);
  EXPECT_EQ(block[15], 0x3f);  // 1.0f is 3f800000
  EXPECT_EQ(block[16], 0x80);
  EXPECT_EQ(block[19], 0xc0);  // -2.0 is c000000000000000
}

TEST(Bytes, WrittenValues_AreReadBack) {
  const double tiny = -std::numeric_limits<double>::denorm_min();
  std::array<std::uint8_t, 64> block{};
  ByteWriter writer(block);
  writer.i32(-5);
  writer.f64(tiny);
  writer.f32(-0.0f);
  const std::array<std::uint8_t, 3> text = {7, 8, 9};
  writer.bytes(text);
  ByteReader reader(std::span<const std::uint8_t>(block).first(writer.written()));
  EXPECT_EQ(reader.i32(), -5);
  EXPECT_EQ(reader.f64(), tiny);
  EXPECT_EQ(std::bit_cast<std::uint32_t>(reader.f32()), 0x80000000u);
  const auto taken = reader.take(3);
  EXPECT_EQ(std::vector<std::uint8_t>(taken.begin(), taken.end()),
            std::vector<std::uint8_t>(text.begin(), text.end()));
  EXPECT_EQ(reader.left(), 0u);
  EXPECT_FALSE(reader.failed());
}

TEST(Bytes, WriterWithoutABlock_CountsBytes) {
  ByteWriter counter;
  counter.u64(1);
  counter.u16(1);
  EXPECT_EQ(counter.written(), 10u);
  std::array<std::uint8_t, 4> block = {9, 9, 9, 9};
  ByteWriter writer(std::span<std::uint8_t>(block).first(2));
  writer.u32(0x01020304);
  EXPECT_EQ(block, (std::array<std::uint8_t, 4>{1, 2, 9, 9}));
}

TEST(Bytes, ReadsPastTheEnd_GiveZeroAndFail) {
  const std::array<std::uint8_t, 3> block = {1, 2, 3};
  ByteReader reader(block);
  EXPECT_TRUE(reader.fits(3, 1));
  EXPECT_FALSE(reader.fits(2, 2));
  EXPECT_FALSE(reader.fits(std::numeric_limits<std::uint64_t>::max(), 8));
  EXPECT_EQ(reader.u32(), 0u);
  EXPECT_TRUE(reader.failed());
  EXPECT_EQ(reader.u8(), 0u);  // nothing more, although three bytes are there
  EXPECT_TRUE(reader.take(0).empty());
  EXPECT_FALSE(reader.fits(0, 1));
}

}  // namespace
}  // namespace boresight
