// SPDX-License-Identifier: Apache-2.0
#include "core/edges/directed_edges.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdlib>

namespace boresight {
namespace {

constexpr int kBorder = 2;                     ///< of Sobel's kernel
constexpr int kMeanReach = 15;                 ///< of the mean around a pixel, 31 x 31
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
  for (int x = 0; x < image.width; ++x)
    known[static_cast<std::size_t>(x)] = row[0][x] & row[1][x] & row[2][x];
}

}  // namespace

int edgeDirectionOf(std::int32_t x, std::int32_t y) {
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
  return falls && sector > 0 ? kEdgeDirections - sector : sector;
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

void DirectedEdgeDetector::create(std::size_t pixels, Arena& arena) {
  magnitude_ = arena.allocate<std::uint16_t>(pixels);
}

void DirectedEdgeDetector::begin(int width, int height, DirectedEdges& edges) {
  edges.width = width;
  edges.height = height;
  std::fill_n(magnitude_.begin(), placeOf(0, height, width), std::uint16_t{0});
  std::fill_n(edges.direction.begin(), placeOf(0, height, width), DirectedEdges::kNone);
}

void DirectedEdgeDetector::finish(const SmallImage& image, DirectedEdges& edges) {
  suppress(edges);
  const std::size_t count = placeOf(0, image.height, image.width);
  for (std::size_t i = 0; i < count; ++i)
    if (image.seen[i] == 0) edges.direction[i] = DirectedEdges::kUnseen;
}

void DirectedEdgeDetector::addChannel(const SmallImage& image, DirectedEdges& edges) {
  const int width = image.width;
  Row<std::int32_t> smooth;
  Row<std::int32_t> derivative;
  Row<std::uint8_t> known;
  for (int y = kBorder; y < image.height - kBorder; ++y) {
    sumColumns(image, y, smooth, derivative);
    knownColumns(image, y, known);
    for (int x = kBorder; x < width - kBorder; ++x) {
      const std::int32_t* s = smooth.data() + x;
      const std::int32_t* d = derivative.data() + x;
      const std::int32_t dx = (s[2] - s[-2]) + 2 * (s[1] - s[-1]);
      const std::int32_t dy = d[-2] + 4 * (d[-1] + d[1]) + 6 * d[0] + d[2];
      // By the kernel's corners, sides and middle.
      const std::uint8_t* k = known.data() + x;
      if ((k[-kBorder] & k[0] & k[kBorder]) == 0) continue;
      const std::size_t at = placeOf(x, y, width);
      // At most 255 * 48 * sqrt(2).
      const auto magnitude = static_cast<std::uint16_t>(
          std::sqrt(static_cast<double>(dx) * dx + static_cast<double>(dy) * dy));
      if (edges.direction[at] != DirectedEdges::kNone && magnitude <= magnitude_[at]) continue;
      magnitude_[at] = magnitude;
      edges.direction[at] = static_cast<std::uint8_t>(edgeDirectionOf(dx, dy));
    }
  }
}

/// Keeps only the directions of edges.
void DirectedEdgeDetector::suppress(DirectedEdges& edges) const {
  // The neighbour along the normal, of eight.
  static constexpr int kStep_x[kEdgeDirections] = {1, 1, 1, 0, 0, 0, -1, -1};
  static constexpr int kStep_y[kEdgeDirections] = {0, 0, 1, 1, 1, 1, 1, 0};
  const int width = edges.width;
  const int height = edges.height;
  Row<std::uint32_t> column_sum{};  // of the rows about y
  const auto addRow = [&](int y, bool add) {
    if (y < 0 || y >= height) return;
    for (int x = 0; x < width; ++x) {
      const std::uint32_t value = magnitude_[placeOf(x, y, width)];
      column_sum[static_cast<std::size_t>(x)] += add ? value : 0u - value;
    }
  };
  for (int y = 0; y < kMeanReach; ++y) addRow(y, true);
  for (int y = 0; y < height; ++y) {
    addRow(y + kMeanReach, true);
    addRow(y - kMeanReach - 1, false);
    const int rows = std::min(height - 1, y + kMeanReach) - std::max(0, y - kMeanReach) + 1;
    std::uint64_t sum = 0;
    for (int x = 0; x < std::min(kMeanReach, width); ++x)
      sum += column_sum[static_cast<std::size_t>(x)];
    for (int x = 0; x < width; ++x) {
      if (x + kMeanReach < width) sum += column_sum[static_cast<std::size_t>(x + kMeanReach)];
      if (x > kMeanReach) sum -= column_sum[static_cast<std::size_t>(x - kMeanReach - 1)];
      const std::size_t at = placeOf(x, y, width);
      const std::uint8_t direction = edges.direction[at];
      if (direction == DirectedEdges::kNone) continue;
      const int columns = std::min(width - 1, x + kMeanReach) - std::max(0, x - kMeanReach) + 1;
      const std::uint16_t magnitude = magnitude_[at];
      const std::uint16_t ahead =
          magnitude_[placeOf(x + kStep_x[direction], y + kStep_y[direction], width)];
      const std::uint16_t behind =
          magnitude_[placeOf(x - kStep_x[direction], y - kStep_y[direction], width)];
      const auto count = static_cast<std::uint64_t>(rows * columns);
      const bool kept = magnitude >= kLeastMagnitude && magnitude >= ahead && magnitude > behind &&
                        std::uint64_t{magnitude} * 10 * count >= kOfMean_tenths * sum;
      if (!kept) edges.direction[at] = DirectedEdges::kNone;
    }
  }
}

}  // namespace boresight
