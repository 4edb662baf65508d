// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <cstdint>
#include <span>

#include "core/base/arena.h"

namespace boresight {

inline constexpr int kEdgeDirections = 8;  ///< of normals without sign, 22.5 deg each

/// The direction of a normal of any length: 0 along x, 4 along y, the same for both signs.
std::uint8_t edgeDirectionOf(std::int32_t x, std::int32_t y);
/// Steps between two directions, 0 ... 4.
int directionsApart(int first, int second);

/// A small image of one or several channels, with flags of its known pixels.
struct SmallImage {
  std::span<std::uint8_t> value;  ///< capacity; the first width * height of each channel are valid
  std::span<std::uint8_t> seen;   ///< row by row, capacity; 1: known
  int width = 0;                  ///< px
  int height = 0;                 ///< px

  /// Takes an image of up to `pixels` from `arena`.
  static SmallImage create(std::size_t pixels, Arena& arena, int channels = 1);
  /// One channel as an image, row by row.
  SmallImage channel(int index) const;
};

/// An image's edges with the direction of their normals.
struct DirectedEdges {
  static constexpr std::uint8_t kNone = 0xff;    ///< no edge
  static constexpr std::uint8_t kUnseen = 0xfe;  ///< the pixel is unknown

  std::span<std::uint8_t> direction;  ///< row by row: 0 ... 7, kNone or kUnseen; capacity
  int width = 0;                      ///< px
  int height = 0;                     ///< px

  /// The value at a pixel inside the image.
  std::uint8_t at(int x, int y) const {
    return direction[static_cast<std::size_t>(y) * static_cast<std::size_t>(width) +
                     static_cast<std::size_t>(x)];
  }
};

/// Finds directed edges in small images: Sobel's gradient (5 x 5) where it is the largest along its
/// direction and at least 0.7 times the mean around it (31 x 31). Dim parts therefore have edges,
/// too, and dense texture has few. Of several channels the largest gradient counts (an
/// approximation of Di Zenzo 1986).
class DirectedEdgeDetector {
 public:
  static constexpr int kMaxWidth = 512;  ///< px

  /// Takes kHeldRows rows of `max_width` columns from `arena`.
  void create(int max_width, Arena& arena);
  /// Begins with an image of this size and number of channels; `edges.direction` must have room for
  /// it.
  void begin(int width, int height, int channels, DirectedEdges& edges);
  /// The edges of up to `rows` further rows; true when all are complete.
  [[nodiscard]] bool step(const SmallImage& image, int rows, DirectedEdges& edges);

 private:
  static constexpr int kMeanReach = 15;  ///< of the mean around a pixel, 31 x 31
  /// Rows of gradients that are held: those of the mean and the one before.
  static constexpr int kHeldRows = 2 * kMeanReach + 2;

  std::uint16_t* magnitudes(int y) { return magnitude_.data() + y % kHeldRows * width_; }
  const std::uint16_t* magnitudes(int y) const {
    return magnitude_.data() + y % kHeldRows * width_;
  }
  void takeRow(const SmallImage& image, int y, DirectedEdges& edges);
  void takeChannel(const SmallImage& image, int y, DirectedEdges& edges);
  void addToColumns(int y, bool add);
  void suppressRow(int y, const SmallImage& image, DirectedEdges& edges) const;

  std::span<std::uint16_t> magnitude_;
  std::array<std::uint32_t, kMaxWidth> column_sum_{};  ///< of the rows about the current one
  int width_ = 0;
  int channels_ = 1;
  int next_ = 0;  ///< row to be completed
};

}  // namespace boresight
