// SPDX-License-Identifier: Apache-2.0
#include "core/edges/gradient.h"

#include <algorithm>
#include <array>
#include <cmath>

#include "core/base/nth.h"
#include "core/edges/border.h"

namespace boresight {
namespace {

constexpr int kReach = 16;  ///< columns past a block that the along-row sums need, rounded up

/// Largest |dx| of an 8-bit image: 255 times the kernel's positive half.
constexpr std::int32_t kMaxDerivative = 255 * 4;

/// One block of derivatives; a, b, c: rows above, at and below, at the pixel before the block.
/// Inlined, the promise that the rows do not overlap gets lost, and with it the vector code.
[[gnu::noinline]] void sobel3(const std::uint8_t* __restrict a, const std::uint8_t* __restrict b,
                              const std::uint8_t* __restrict c, std::int16_t* __restrict dx,
                              std::int16_t* __restrict dy) {
  std::int16_t smooth[kRowBlock + kReach];
  std::int16_t derive[kRowBlock + kReach];
  for (int i = 0; i < kRowBlock + kReach; ++i) {
    smooth[i] = static_cast<std::int16_t>(a[i] + 2 * b[i] + c[i]);
    derive[i] = static_cast<std::int16_t>(c[i] - a[i]);
  }
  for (int i = 0; i < kRowBlock; ++i) {
    dx[i] = static_cast<std::int16_t>(smooth[i + 2] - smooth[i]);
    dy[i] = static_cast<std::int16_t>(derive[i] + 2 * derive[i + 1] + derive[i + 2]);
  }
}

void magnitudeBlock(const std::int16_t* dx, const std::int16_t* dy,
                    std::int32_t* __restrict magnitude) {
  for (int i = 0; i < kRowBlock; ++i) magnitude[i] = dx[i] * dx[i] + dy[i] * dy[i];
}

/// Smallest r with r * r >= squared, for 0 <= squared < 2^30. The root of a number that is no
/// square is at least 1.5e-5 away from an integer, far more than double precision rounds.
inline std::int32_t ceilRoot(std::int32_t squared) {
  return static_cast<std::int32_t>(std::sqrt(static_cast<double>(squared)) + (1.0 - 1e-6));
}

}  // namespace

void GradientRows::begin(int width, int height, Arena& arena) {
  *this = GradientRows();
  width_ = width;
  height_ = height;
  columns_ = roundUpToBlock(width);
  const std::size_t columns = static_cast<std::size_t>(columns_);
  const std::size_t padded = columns + 2 * std::size_t{kMargin};
  smoothed_ = arena.allocate<std::uint8_t>(padded * kAperture_px);
  dx_ = arena.allocate<std::int16_t>(columns * kRing);
  dy_ = arena.allocate<std::int16_t>(columns * kRing);
  magnitude_ = arena.allocate<std::int32_t>(padded * (kRing + 1));
}

void GradientRows::restart() {
  rows_done_ = 0;
  smoothed_done_ = 0;
}

const std::int32_t* GradientRows::magnitude(int y) const {
  const int slot = y < 0 || y >= height_ ? kRing : y % kRing;
  return magnitude_.data() + (columns_ + 2 * kMargin) * slot + kMargin;
}

void GradientRows::advance(const Equalizer& source, SmoothedRows& smoothed) {
  const int y = rows_done_++;
  constexpr int kHalf = kAperture_px / 2;
  for (; smoothed_done_ <= std::min(y + kHalf, height_ - 1); ++smoothed_done_) {
    std::uint8_t* row = smoothedRow(smoothed_done_);
    smoothed.row(smoothed_done_, source, row);
    std::fill(row - kHalf, row, row[0]);
    std::fill(row + width_, row + width_ + kHalf, row[width_ - 1]);
  }
  std::array<const std::uint8_t*, kAperture_px> rows{};
  for (int k = 0; k < kAperture_px; ++k)
    nth(rows, k) = smoothedRow(std::clamp(y + k - kHalf, 0, height_ - 1)) - kHalf;
  std::int16_t* dx = dx_.data() + columns_ * (y % kRing);
  std::int16_t* dy = dy_.data() + columns_ * (y % kRing);
  std::int32_t* magnitude = magnitude_.data() + (columns_ + 2 * kMargin) * (y % kRing) + kMargin;
  for (int x = 0; x < width_; x += kRowBlock) {
    sobel3(rows[0], rows[1], rows[2], dx + x, dy + x);
    magnitudeBlock(dx + x, dy + x, magnitude + x);
    for (const std::uint8_t*& row : rows) row += kRowBlock;
  }
  std::fill(magnitude + width_, magnitude + columns_ + 1, 0);
}

void GradientHistogram::begin(Arena& arena) {
  *this = GradientHistogram();
  bins_ = ceilRoot(2 * kMaxDerivative * kMaxDerivative) + 1;
  counts_ = arena.allocate<std::int32_t>(bins_ * kLanes);
}

void GradientHistogram::addRow(const std::int32_t* magnitude, const std::uint64_t* ignored,
                               int width) {
  std::int32_t* counts = counts_.data();
  for (int x = 0; x < width; x += kRowBlock) {
    std::int32_t bin[kRowBlock];
    for (int i = 0; i < kRowBlock; ++i) bin[i] = ceilRoot(magnitude[x + i]);
    const int end = std::min(width - x, kRowBlock);
    if (ignored != nullptr && ignored[x >> 6] != 0) {
      for (int i = 0; i < end; ++i)
        if (((ignored[x >> 6] >> i) & 1U) == 0) ++counts[bin[i]];
      continue;
    }
    int i = 0;
    for (; i + kLanes <= end; i += kLanes)
#pragma GCC unroll 4
      for (int lane = 0; lane < kLanes; ++lane) ++counts[bins_ * lane + bin[i + lane]];
    for (; i < end; ++i) ++counts[bin[i]];
  }
}

std::int32_t GradientHistogram::quantile(double share) const {
  std::int64_t all = 0;
  for (const std::int32_t count : counts_) all += count;
  const double wanted = share * static_cast<double>(all);
  std::int64_t sum = 0;
  for (std::ptrdiff_t bin = 0; bin + 1 < bins_ && all > 0; ++bin) {
    for (int lane = 0; lane < kLanes; ++lane) sum += nth(counts_, bins_ * lane + bin);
    if (static_cast<double>(sum) >= wanted) return static_cast<std::int32_t>(bin);
  }
  return static_cast<std::int32_t>(bins_ - 1);
}

}  // namespace boresight
