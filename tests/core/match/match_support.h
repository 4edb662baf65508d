// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <cstdint>
#include <random>
#include <string>
#include <vector>

#include <gtest/gtest.h>

#include "core/base/arena.h"
#include "core/base/image.h"
#include "core/match/whs.h"

namespace boresight::test {

/// Raw engine output only: the library's distributions differ between implementations.
class Dice {
 public:
  /// Seeded by the running test, so that tests do not depend on their order.
  explicit Dice(std::uint32_t salt = 0) {
    const auto* info = testing::UnitTest::GetInstance()->current_test_info();
    const std::string name = std::string(info->test_suite_name()) + info->name();
    std::seed_seq seed(name.begin(), name.end());
    engine_.seed(seed);
    engine_.discard(salt);
  }
  std::uint64_t bits() { return engine_(); }
  int below(int bound) { return static_cast<int>(engine_() % static_cast<std::uint64_t>(bound)); }
  int between(int low, int high) { return low + below(high - low + 1); }
  double uniform() { return static_cast<double>(engine_() >> 11) * 0x1.0p-53; }
  double uniform(double low, double high) { return low + (high - low) * uniform(); }

 private:
  std::mt19937_64 engine_;
};

/// A bit image with memory of its own.
struct OwnedBits {
  OwnedBits(int width, int height)
      : words(static_cast<std::size_t>(BitImage::wordsPerRow(width) * height)) {
    image.words = words;
    image.width = width;
    image.height = height;
    image.words_per_row = BitImage::wordsPerRow(width);
  }
  OwnedBits(const OwnedBits& other) : words(other.words), image(other.image) {
    image.words = words;
  }
  OwnedBits& operator=(const OwnedBits&) = delete;

  std::vector<std::uint64_t> words;
  BitImage image;
};

/// The pixels (x, y) that are `in`, asked row by row.
template <class In>
OwnedBits drawn(int width, int height, const In& in) {
  OwnedBits bits(width, height);
  for (int y = 0; y < height; ++y) {
    for (int x = 0; x < width; ++x) {
      if (in(x, y)) bits.image.set(x, y);
    }
  }
  return bits;
}

/// Every pixel set with probability `density`.
inline OwnedBits noise(int width, int height, double density, Dice& dice) {
  return drawn(width, height, [&](int, int) { return dice.uniform() < density; });
}

/// A WhsSearch with memory of its own.
struct OwnedSearch {
  OwnedSearch(int max_side_px, int max_window_px, Kernels kernels = Kernels::kPortable) {
    Arena count;
    (void)search.create(max_side_px, max_window_px, kernels, count);  // counting cannot fail
    memory.resize(count.highWater());
    Arena arena{memory};
    EXPECT_EQ(search.create(max_side_px, max_window_px, kernels, arena), Status::kOk);
  }
  std::vector<std::byte> memory;
  WhsSearch search;
};

/// Every set of kernels that this build has.
inline std::vector<Kernels> availableKernels() {
  std::vector<Kernels> available;
  for (int k = 0; k < kKernelSets; ++k) {
    if (kernelsAvailable(static_cast<Kernels>(k))) available.push_back(static_cast<Kernels>(k));
  }
  return available;
}

inline std::string nameOfKernels(const testing::TestParamInfo<Kernels>& set) {
  return kernelsName(set.param);
}

}  // namespace boresight::test

namespace boresight {
inline void PrintTo(const WhsPeak& peak, std::ostream* stream) {
  *stream << "best (" << peak.x << ", " << peak.y << ") " << peak.counts.edge_hits << " + "
          << peak.counts.empty_hits;
  if (!peak.has_second) return;
  *stream << ", second (" << peak.second_x << ", " << peak.second_y << ") "
          << peak.second_counts.edge_hits << " + " << peak.second_counts.empty_hits;
}
}  // namespace boresight
