// SPDX-License-Identifier: Apache-2.0
#include "core/search/slide_sums.h"

#include <algorithm>
#include <cstring>

#include "core/base/nth.h"

namespace boresight {
namespace {

/// Bytes that are added as one word: no byte of the sum overflows into the next one.
std::uint64_t eightBytes(const std::uint8_t* from) {
  std::uint64_t word = 0;
  std::memcpy(&word, from, sizeof(word));
  return word;
}

}  // namespace

void SlideSums::create(Arena& arena) {
  constexpr auto kMapPixels = static_cast<std::size_t>(kMaxSide_px) * kMaxSide_px;
  for (auto& map : maps_) map = arena.allocate<std::uint8_t>(kMapPixels);
  sums_ = arena.allocate<std::uint16_t>(static_cast<std::size_t>(kMaxView_px + 1 + kBlock) *
                                        (kMaxView_px + 1));
}

void SlideSums::begin(int width, int height, int slide_x_px, int slide_y_px) {
  width_ = std::min(width, kMaxView_px);
  height_ = std::min(height, kMaxView_px);
  slide_x_ = std::clamp(slide_x_px, 0, width_ / 2);
  slide_y_ = std::clamp(slide_y_px, 0, height_ / 2);
  columns_ = 2 * slide_x_ + 1;
  rows_ = 2 * slide_y_ + 1;
  stride_ = width_ + 2 * kBorder_px + kBlock;
  sum_stride_ = (columns_ + kBlock - 1) / kBlock * kBlock;
}

void SlideSums::takeMap(const DirectedEdges& edges, int direction) {
  const std::span<std::uint8_t> map = nth(maps_, direction);
  // Computed in the map's own memory first; then the border is spread, last row first.
  distanceToDirection(edges, direction, map);
  constexpr int kPerStep = static_cast<int>(kStep_px / kDistanceUnit_px + 0.5);
  std::uint32_t sum = 0;
  for (int i = 0; i < width_ * height_; ++i) {
    std::uint8_t& value = nth(map, i);
    value = static_cast<std::uint8_t>((value + kPerStep / 2) / kPerStep);
    sum += value;
  }
  const auto count = static_cast<std::uint32_t>(width_ * height_);
  const auto mean = static_cast<std::uint8_t>((sum + count / 2) / std::max(count, 1u));
  std::uint8_t* const begin = map.data();
  for (int y = height_ - 1; y >= 0; --y) {
    std::uint8_t* row = begin + (y + kBorder_px) * stride_;
    std::copy_backward(begin + y * width_, begin + (y + 1) * width_, row + kBorder_px + width_);
    std::fill_n(row, kBorder_px, mean);
    std::fill_n(row + kBorder_px + width_, kBorder_px + kBlock, mean);
  }
  std::fill_n(begin, kBorder_px * stride_, mean);
  std::fill_n(begin + (kBorder_px + height_) * stride_, kBorder_px * stride_, mean);
}

/// Map entry of the place at the first row and column of the slides. Places far outside the view
/// are clamped to the end of the border.
const std::uint8_t* SlideSums::cornerOf(const Place& place) const {
  const int x = std::clamp(kBorder_px + width_ / 2 + place.x - slide_x_, 0, stride_ - sum_stride_);
  const int y = std::clamp(kBorder_px + height_ / 2 + place.y - slide_y_, 0,
                           height_ + 2 * kBorder_px - rows_);
  return maps_[place.direction].data() + y * stride_ + x;
}

std::uint8_t SlideSums::at(int direction, double x_px, double y_px) const {
  const auto placeOf = [](double px, int size) {
    const double place = kBorder_px + size / 2 + px + 0.5;
    return static_cast<int>(std::clamp(place, 0.0, size + 2.0 * kBorder_px - 1.0));
  };
  return nth(nth(maps_, direction), placeOf(y_px, height_) * stride_ + placeOf(x_px, width_));
}

void SlideSums::add(std::span<const Place> places) {
  std::array<const std::uint8_t*, kMaxPlaces> corner{};
  const std::size_t count = std::min<std::size_t>(places.size(), kMaxPlaces);
  for (std::size_t i = 0; i < count; ++i) corner[i] = cornerOf(places[i]);
  for (int row = 0; row < rows_; ++row) {
    for (int column = 0; column < columns_; column += kBlock) {
      const std::ptrdiff_t offset = std::ptrdiff_t{row} * stride_ + column;
      std::array<std::uint16_t, kBlock> sum{};
      for (std::size_t first = 0; first < count; first += kChunk) {
        const std::size_t end = std::min(count, first + kChunk);
        std::uint64_t low = 0;
        std::uint64_t high = 0;
        for (std::size_t i = first; i < end; ++i) {
          low += eightBytes(corner[i] + offset);
          high += eightBytes(corner[i] + offset + 8);
        }
        std::array<std::uint8_t, kBlock> part;
        std::memcpy(part.data(), &low, 8);
        std::memcpy(part.data() + 8, &high, 8);
        for (std::size_t k = 0; k < kBlock; ++k)
          sum[k] = static_cast<std::uint16_t>(sum[k] + part[k]);
      }
      std::copy(sum.begin(), sum.end(), sums_.data() + row * sum_stride_ + column);
    }
  }
}

bool SlideSums::isPeak(int column, int row) const {
  const std::uint16_t middle = sum(column, row);
  for (int y = std::max(row - 1, 0); y <= std::min(row + 1, rows_ - 1); ++y)
    for (int x = std::max(column - 1, 0); x <= std::min(column + 1, columns_ - 1); ++x)
      if (sum(x, y) < middle) return false;
  return true;
}

std::uint16_t SlideSums::least() const {
  std::uint16_t least = 0xffff;
  for (int row = 0; row < rows_; ++row) {
    const std::uint16_t* sum = rowOf(row);
    for (int column = 0; column < columns_; ++column) least = std::min(least, sum[column]);
  }
  return least;
}

}  // namespace boresight
