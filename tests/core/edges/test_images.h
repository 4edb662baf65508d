// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <cstdint>
#include <ostream>
#include <vector>

#include "core/base/arena.h"
#include "core/base/image.h"
#include "core/base/random.h"

namespace boresight {

enum class Pattern : int { kNoise, kRamp, kBlocks, kDisks, kConstant, kCheckers, kSpecks };
inline constexpr Pattern kPatterns[] = {Pattern::kNoise, Pattern::kRamp,     Pattern::kBlocks,
                                        Pattern::kDisks, Pattern::kConstant, Pattern::kCheckers,
                                        Pattern::kSpecks};

struct Size {
  int width;
  int height;
};

/// Tiny ones, and ones around the 64 pixels of a word.
inline constexpr Size kSizes[] = {{1, 1},   {1, 7},     {9, 1},     {2, 2},   {3, 3},
                                  {17, 5},  {5, 40},    {63, 64},   {64, 63}, {65, 66},
                                  {128, 9}, {130, 127}, {200, 333}, {321, 97}};

struct TestImage {
  int width = 0;
  int height = 0;
  std::vector<std::uint8_t> pixels;

  ImageView view() const { return {pixels.data(), width, height, width}; }
  std::uint8_t& at(int x, int y) {
    return pixels[static_cast<std::size_t>(y) * static_cast<std::size_t>(width) +
                  static_cast<std::size_t>(x)];
  }
  bool operator==(const TestImage&) const = default;
};

inline TestImage makeImage(Pattern pattern, Size size, Random& random) {
  TestImage image{size.width, size.height, {}};
  image.pixels.resize(static_cast<std::size_t>(size.width) * static_cast<std::size_t>(size.height));
  const int level = static_cast<int>(random.below(256));
  const int cell = 3 + static_cast<int>(random.below(20));
  const auto inDisk = [](int x, int y) {
    const int dx = x % 48 - 24;
    const int dy = y % 40 - 19;
    return dx * dx + dy * dy < 15 * 15;
  };
  for (int y = 0; y < size.height; ++y) {
    for (int x = 0; x < size.width; ++x) {
      int value = level;
      if (pattern == Pattern::kNoise) value = static_cast<int>(random.below(256));
      if (pattern == Pattern::kRamp) value = (2 * x + 3 * y + level) % 256;
      if (pattern == Pattern::kBlocks) value = (x / cell * 7919 + y / cell * 104729) * 31 % 256;
      if (pattern == Pattern::kDisks)
        value = (inDisk(x, y) ? 190 : 40 + x % 60) + static_cast<int>(random.below(13));
      if (pattern == Pattern::kCheckers) value = (x + y) % 2 == 0 ? 0 : 255;
      if (pattern == Pattern::kSpecks) value = random.below(9) == 0 ? 255 : level / 8;
      image.at(x, y) = static_cast<std::uint8_t>(value);
    }
  }
  return image;
}

/// An arena over its own memory.
class TestArena {
 public:
  explicit TestArena(std::size_t bytes = std::size_t{3} << 20) : memory_(bytes), arena_(memory_) {}
  Arena& operator*() { return arena_; }

 private:
  std::vector<std::byte> memory_;
  Arena arena_;
};

/// A binary image over its own memory.
class TestBits {
 public:
  TestBits(int width, int height)
      : words_(static_cast<std::size_t>(BitImage::wordsPerRow(width)) *
               static_cast<std::size_t>(height)) {
    bits_ = {words_, width, height, BitImage::wordsPerRow(width)};
  }
  TestBits(const TestBits&) = delete;
  TestBits& operator=(const TestBits&) = delete;
  BitImage& operator*() { return bits_; }
  BitImage* operator->() { return &bits_; }

 private:
  std::vector<std::uint64_t> words_;
  BitImage bits_;
};

inline void fillAtRandom(BitImage& bits, std::uint32_t one_in, Random& random) {
  for (int y = 0; y < bits.height; ++y)
    for (int x = 0; x < bits.width; ++x)
      if (random.below(one_in) == 0) bits.set(x, y);
}

/// Some rectangles, as a gripper or dropped packets would leave them.
inline void ignoreRectangles(BitImage& bits, Random& random) {
  for (int i = 0; i < 4; ++i) {
    const int left = static_cast<int>(random.below(static_cast<std::uint32_t>(bits.width)));
    const int top = static_cast<int>(random.below(static_cast<std::uint32_t>(bits.height)));
    const int right = left + 1 + static_cast<int>(random.below(40));
    const int bottom = top + 1 + static_cast<int>(random.below(25));
    for (int y = top; y < bottom && y < bits.height; ++y)
      for (int x = left; x < right && x < bits.width; ++x) bits.set(x, y);
  }
}

/// Other content of ignored pixels.
inline void scramble(TestImage& image, const BitImage& ignore, Random& random) {
  for (int y = 0; y < image.height; ++y)
    for (int x = 0; x < image.width; ++x)
      if (ignore.get(x, y)) image.at(x, y) = static_cast<std::uint8_t>(random.below(256));
}

inline void PrintTo(const Size& size, std::ostream* out) {
  *out << size.width << " x " << size.height;
}

}  // namespace boresight
