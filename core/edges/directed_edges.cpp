// SPDX-License-Identifier: Apache-2.0
#include "core/edges/directed_edges.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdlib>

#include "core/base/nth.h"

namespace boresight {
namespace {

constexpr int kBorder = 2;                     ///< of Sobel's kernel
constexpr std::uint64_t kOfMean_tenths = 7;    ///< least magnitude of an edge relative to that mean
constexpr std::uint16_t kLeastMagnitude = 64;  ///< half a gray value per px: 128 times

template <class T>
using Row = std::array<T, DirectedEdgeDetector::kMaxWidth>;

std::size_t placeOf(int x, int y, int width) {
  return static_cast<std::size_t>(y) * static_cast<std::size_t>(width) +
         static_cast<std::size_t>(x);
}

/// Sums over the five rows about y: smoothed, and differentiated downwards.
void sumColumns(const SmallImage& image, int y, Row<std::int32_t>& smooth,
                Row<std::int32_t>& derivative) {
  const std::uint8_t* row[5];
  for (int i = 0; i < 5; ++i)
    row[i] = image.value.data() + placeOf(0, y + i - kBorder, image.width);
  for (int x = 0; x < image.width; ++x) {
    const auto at = static_cast<std::size_t>(x);
    smooth[at] = row[0][x] + 4 * (row[1][x] + row[3][x]) + 6 * row[2][x] + row[4][x];
    derivative[at] = (row[4][x] - row[0][x]) + 2 * (row[3][x] - row[1][x]);
  }
}

/// Whether the pixels of each column in the kernel's rows about y are known, by its ends and
/// middle: 1 or 0.
void knownColumns(const SmallImage& image, int y, Row<std::uint8_t>& known) {
  const std::uint8_t* row[3];
  for (int i = 0; i < 3; ++i)
    row[i] = image.seen.data() + placeOf(0, y + (i - 1) * kBorder, image.width);
  for (int x = 0; x < image.width; ++x) nth(known, x) = row[0][x] & row[1][x] & row[2][x];
}

}  // namespace

std::uint8_t edgeDirectionOf(std::int32_t x, std::int32_t y) {
  // Boundaries at 11.25 deg and every 22.5 deg from there; tangents in units of 1/1024.
  constexpr std::int64_t kTan11 = 204, kTan33 = 684, kTan56 = 1533, kTan78 = 5148;
  const std::int64_t a = std::abs(static_cast<std::int64_t>(x));
  const std::int64_t b = 1024 * std::abs(static_cast<std::int64_t>(y));
  int sector = 4;
  if (b <= kTan11 * a)
    sector = 0;
  else if (b <= kTan33 * a)
    sector = 1;
  else if (b <= kTan56 * a)
    sector = 2;
  else if (b <= kTan78 * a)
    sector = 3;
  const bool falls = (x < 0) != (y < 0);
  return static_cast<std::uint8_t>(falls && sector > 0 ? kEdgeDirections - sector : sector);
}

int directionsApart(int first, int second) {
  const int apart = std::abs(first - second);
  return std::min(apart, kEdgeDirections - apart);
}

SmallImage SmallImage::create(std::size_t pixels, Arena& arena, int channels) {
  SmallImage image;
  image.value = arena.allocate<std::uint8_t>(static_cast<std::size_t>(channels) * pixels);
  image.seen = arena.allocate<std::uint8_t>(pixels);
  return image;
}

SmallImage SmallImage::channel(int index) const {
  SmallImage image = *this;
  image.value = value.subspan(static_cast<std::size_t>(index) * seen.size(), seen.size());
  return image;
}

void DirectedEdgeDetector::create(int max_width, Arena& arena) {
  magnitude_ = arena.allocate<std::uint16_t>(kHeldRows * max_width);
}

void DirectedEdgeDetector::begin(int width, int height, int channels, DirectedEdges& edges) {
  edges.width = width_ = width;
  edges.height = height;
  channels_ = channels;
  next_ = 0;
  column_sum_.fill(0);
}

bool DirectedEdgeDetector::step(const SmallImage& image, int rows, DirectedEdges& edges) {
  const int end = std::min(next_ + rows, edges.height);
  for (; next_ < end; ++next_) {
    // The first row needs all rows of its mean.
    for (int y = next_ > 0 ? next_ + kMeanReach : 0; y <= next_ + kMeanReach; ++y) {
      if (y >= edges.height) break;
      takeRow(image, y, edges);
      addToColumns(y, true);
    }
    if (next_ > kMeanReach) addToColumns(next_ - kMeanReach - 1, false);
    suppressRow(next_, image, edges);
  }
  return next_ == edges.height;
}

/// Gradients and directions of a row.
void DirectedEdgeDetector::takeRow(const SmallImage& image, int y, DirectedEdges& edges) {
  std::fill_n(magnitudes(y), width_, std::uint16_t{0});
  std::fill_n(edges.direction.begin() + static_cast<std::ptrdiff_t>(placeOf(0, y, width_)), width_,
              DirectedEdges::kNone);
  if (y < kBorder || y >= edges.height - kBorder) return;
  for (int channel = 0; channel < channels_; ++channel)
    takeChannel(image.channel(channel), y, edges);
}

void DirectedEdgeDetector::takeChannel(const SmallImage& image, int y, DirectedEdges& edges) {
  Row<std::int32_t> smooth;
  Row<std::int32_t> derivative;
  Row<std::uint8_t> known;
  sumColumns(image, y, smooth, derivative);
  knownColumns(image, y, known);
  std::uint16_t* const magnitude_of_row = magnitudes(y);
  for (int x = kBorder; x < width_ - kBorder; ++x) {
    const std::int32_t* s = smooth.data() + x;
    const std::int32_t* d = derivative.data() + x;
    const std::int32_t dx = (s[2] - s[-2]) + 2 * (s[1] - s[-1]);
    const std::int32_t dy = d[-2] + 4 * (d[-1] + d[1]) + 6 * d[0] + d[2];
    // By the kernel's corners, sides and middle.
    const std::uint8_t* k = known.data() + x;
    if ((k[-kBorder] & k[0] & k[kBorder]) == 0) continue;
    std::uint8_t& direction = edges.direction[placeOf(x, y, width_)];
    // At most 255 * 48 * sqrt(2).
    const auto magnitude = static_cast<std::uint16_t>(
        std::sqrt(static_cast<double>(dx) * dx + static_cast<double>(dy) * dy));
    if (direction != DirectedEdges::kNone && magnitude <= magnitude_of_row[x]) continue;
    magnitude_of_row[x] = magnitude;
    direction = edgeDirectionOf(dx, dy);
  }
}

void DirectedEdgeDetector::addToColumns(int y, bool add) {
  const std::uint16_t* const row = magnitudes(y);
  for (int x = 0; x < width_; ++x) {
    const std::uint32_t value = row[x];
    nth(column_sum_, x) += add ? value : 0u - value;
  }
}

/// Keeps only the directions of edges, and marks unknown pixels.
void DirectedEdgeDetector::suppressRow(int y, const SmallImage& image, DirectedEdges& edges) const {
  // The neighbour along the normal, of eight.
  static constexpr int kStep_x[kEdgeDirections] = {1, 1, 1, 0, 0, 0, -1, -1};
  static constexpr int kStep_y[kEdgeDirections] = {0, 0, 1, 1, 1, 1, 1, 0};
  const int width = edges.width;
  const int height = edges.height;
  const int rows = std::min(height - 1, y + kMeanReach) - std::max(0, y - kMeanReach) + 1;
  std::uint64_t sum = 0;
  for (int x = 0; x < std::min(kMeanReach, width); ++x) sum += nth(column_sum_, x);
  for (int x = 0; x < width; ++x) {
    if (x + kMeanReach < width) sum += nth(column_sum_, x + kMeanReach);
    if (x > kMeanReach) sum -= nth(column_sum_, x - kMeanReach - 1);
    const std::size_t at = placeOf(x, y, width);
    std::uint8_t& direction = edges.direction[at];
    if (direction != DirectedEdges::kNone) {
      const int columns = std::min(width - 1, x + kMeanReach) - std::max(0, x - kMeanReach) + 1;
      const std::uint16_t magnitude = magnitudes(y)[x];
      const std::uint16_t ahead = magnitudes(y + kStep_y[direction])[x + kStep_x[direction]];
      const std::uint16_t behind = magnitudes(y - kStep_y[direction])[x - kStep_x[direction]];
      const auto count = static_cast<std::uint64_t>(rows * columns);
      const bool kept = magnitude >= kLeastMagnitude && magnitude >= ahead && magnitude > behind &&
                        std::uint64_t{magnitude} * 10 * count >= kOfMean_tenths * sum;
      if (!kept) direction = DirectedEdges::kNone;
    }
    if (image.seen[at] == 0) direction = DirectedEdges::kUnseen;
  }
}

}  // namespace boresight
