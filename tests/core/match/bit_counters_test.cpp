// SPDX-License-Identifier: Apache-2.0
#include "core/match/bit_counters.h"

#include <bit>
#include <cstddef>
#include <cstdint>
#include <utility>
#include <vector>

#include <gtest/gtest.h>

#include "core/match/pixel_words.h"
#include "tests/core/match/match_support.h"

namespace boresight::test {
namespace {

/// The tests below run for every available set of kernels.
class BitCounters : public testing::TestWithParam<Kernels> {
 protected:
  const BitKernels& kernels_ = bitKernels(GetParam());
  Dice dice;
};
INSTANTIATE_TEST_SUITE_P(Sets, BitCounters, testing::ValuesIn(availableKernels()), nameOfKernels);

constexpr int kWords = 7;
constexpr int kZeros = 4096;  ///< byte offset of zeros

struct OwnedRow {
  explicit OwnedRow(int plane_count)
      : words(static_cast<std::size_t>(kMaxPlanes * (kWords + kWordPadding))) {
    row.words = words.data();
    row.stride = kWords + kWordPadding;
    row.plane_count = plane_count;
  }
  int at(int x) const {
    int value = 0;
    for (int k = 0; k < row.plane_count; ++k) {
      value |= static_cast<int>((row.plane(k)[x / 64] >> (x % 64)) & 1u) << k;
    }
    return value;
  }
  void set(int x, int value) {
    for (int k = 0; k < row.plane_count; ++k) {
      if (((value >> k) & 1) != 0) row.plane(k)[x / 64] |= std::uint64_t{1} << (x % 64);
    }
  }
  std::vector<std::uint64_t> words;
  CounterRow row;
};

std::vector<std::uint8_t> randomBytes(Dice& dice) {
  std::vector<std::uint8_t> bytes(kZeros + 8 * (kWords + kWordPadding));
  for (int i = 0; i < kZeros; ++i)
    bytes[static_cast<std::size_t>(i)] = static_cast<std::uint8_t>(dice.bits());
  return bytes;
}

int bitOf(const std::vector<std::uint8_t>& bytes, int bit) {
  return (bytes[static_cast<std::size_t>(bit / 8)] >> (bit % 8)) & 1;
}

TEST(PlanesFor, HoldTheLargestCount) {
  for (const auto& [count, planes] :
       {std::pair{0, 0}, {1, 1}, {2, 2}, {255, 8}, {256, 9}, {512 * 512, kMaxPlanes}})
    EXPECT_EQ(planesFor(count), planes);
}

TEST_P(BitCounters, AddPixelsOneByOne) {
  const std::vector<std::uint8_t> bytes = randomBytes(dice);
  for (int count = 1; count <= 300; count += count < 70 ? 1 : 23) {
    std::vector<std::int32_t> offsets;
    for (int k = 0; k < count; ++k) offsets.push_back(dice.below(kZeros - 8 * kWords));
    std::vector<std::int32_t> padded = offsets;
    while (padded.size() % 4 != 0) padded.push_back(kZeros);
    for (int words = 1; words <= kWords; ++words) {
      const int shift = dice.below(8);
      OwnedRow row(12);
      std::vector<int> expected;
      for (int x = 0; x < 64 * words - 7; ++x) {
        const int start = dice.below(3000);
        row.set(x, start);
        expected.push_back(start);
        for (const std::int32_t offset : offsets) {
          expected.back() += bitOf(bytes, 8 * offset + x + shift);
        }
      }
      const PixelList pixels{padded.data(), static_cast<int>(padded.size()), planesFor(count),
                             shift};
      kernels_.addPixels(bytes.data(), pixels, words, row.row);
      for (int x = 0; x < 64 * words - 7; ++x) {
        ASSERT_EQ(row.at(x), expected[static_cast<std::size_t>(x)])
            << "count " << count << " words " << words << " shift " << shift << " x " << x;
      }
    }
  }
}

TEST_P(BitCounters, CountSignedPixelsOneByOne) {
  const std::vector<std::uint8_t> bytes = randomBytes(dice);
  for (int count = 1; count <= 200; count += count < 40 ? 1 : 31) {
    std::vector<int> bits;
    std::vector<bool> negative;
    std::vector<SignedPixel> pixels;
    for (int k = 0; k < count; ++k) {
      bits.push_back(dice.below(8 * (kZeros - 8 * kWords - 8)));
      negative.push_back(dice.below(2) == 1);
      pixels.push_back(makeSignedPixel(bits.back() / 8, bits.back() % 8, negative.back()));
    }
    while (pixels.size() % 4 != 0) pixels.push_back(makeSignedPixel(kZeros, 0, false));
    for (int words = 1; words <= kWords; ++words) {
      OwnedRow row(planesFor(count));
      kernels_.countSignedPixels(bytes.data(), pixels.data(), static_cast<int>(pixels.size()),
                                 words, row.row);
      for (int x = 0; x < 64 * words; ++x) {
        int expected = 0;
        for (std::size_t k = 0; k < bits.size(); ++k) {
          const int bit = bitOf(bytes, bits[k] + x);
          expected += negative[k] ? 1 - bit : bit;
        }
        ASSERT_EQ(row.at(x), expected) << "count " << count << " words " << words << " x " << x;
      }
    }
  }
}

TEST(CountOnes, CountsEveryBit) {
  Dice dice;
  std::vector<std::uint64_t> words = {0, ~std::uint64_t{0}};
  for (int k = 0; k < 64; ++k) words.push_back(std::uint64_t{1} << k);
  for (int trial = 0; trial < 1000; ++trial) words.push_back(dice.bits() & dice.bits());
  for (const std::uint64_t word : words) EXPECT_EQ(countOnes(word), std::popcount(word));
}

TEST_P(BitCounters, Lanes_HoldTheCounters) {
  for (int planes = 0; planes <= 16; ++planes) {
    OwnedRow row(planes);
    for (int x = 0; x < 64 * kWords; ++x) row.set(x, dice.below(1 << planes));
    for (int words = 1; words <= kWords; ++words) {
      std::uint16_t lanes[kLanes * kWords];
      kernels_.planesToLanes(row.row, words, lanes);
      for (int x = 0; x < 64 * words; ++x) {
        ASSERT_EQ(lanes[x / 64 * kLanes + laneIndex(x % 64)], row.at(x));
      }
      wordToLanes(row.row, words - 1, lanes);
      for (int x = 0; x < 64; ++x) ASSERT_EQ(lanes[laneIndex(x)], row.at(64 * (words - 1) + x));
    }
  }
}

TEST_P(BitCounters, PrefixSums_AddTheCountersToTheLeft) {
  for (int planes = 0; planes <= 10; ++planes) {
    OwnedRow row(planes);
    const int largest = planes == 10 ? 1020 : (1 << planes) - 1;
    for (int x = 0; x < 64 * kWords; ++x) row.set(x, x < 64 ? largest : dice.below(largest + 1));
    for (int words = 1; words <= kWords; ++words) {
      std::uint16_t lanes[kLanes * kWords];
      std::uint32_t totals[kWords + 1];
      totals[words] = 77;
      kernels_.planesToPrefixSums(row.row, words, lanes, totals);
      for (int word = 0; word < words; ++word) {
        std::uint32_t expected = 0;
        for (int x = 0; x < 64; ++x) {
          ASSERT_EQ(lanes[word * kLanes + laneIndex(x)], expected);
          expected += static_cast<std::uint32_t>(row.at(64 * word + x));
        }
        ASSERT_EQ(totals[word], expected);
      }
      ASSERT_EQ(totals[words], 77u) << "nothing beyond the words";
    }
  }
}

TEST(PixelsAt, ReadsAnyColumn) {
  Dice dice;
  const OwnedBits bits = noise(200, 3, 0.5, dice);
  for (int x = 0; x < 260; ++x) {
    const std::uint64_t pixels = pixelsAt(bits.image, x, 1);
    for (int k = 0; k < 64; ++k) {
      const bool expected = x + k < 200 && bits.image.get(x + k, 1);
      ASSERT_EQ(((pixels >> k) & 1u) != 0, expected) << x << " " << k;
    }
  }
}

TEST(ByteOrdered, PutsPixelsInAscendingBytes) {
  const std::uint64_t word = byteOrdered(0x0807060504030201u);
  std::uint8_t bytes[8];
  storeWord(bytes, word);
  for (int k = 0; k < 8; ++k) EXPECT_EQ(bytes[k], k + 1);
  EXPECT_EQ(byteOrdered(word), 0x0807060504030201u);
}

}  // namespace
}  // namespace boresight::test
