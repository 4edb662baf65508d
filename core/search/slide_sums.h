// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <span>

#include "core/base/arena.h"
#include "core/edges/directed_edges.h"
#include "core/edges/direction_distance.h"

namespace boresight {

/// Sums of directed distances of an outline for all slides of it at the same time. The distances
/// are rounded to steps of kStep_px: sums of many places then fit bytes, and the compiler adds 16
/// bytes at a time.
class SlideSums {
 public:
  static constexpr int kMaxPlaces = 64;     ///< of an outline
  static constexpr int kMaxView_px = 183;   ///< sides of the maps
  static constexpr double kStep_px = 0.4;   ///< of the distances
  static constexpr int kFarthestStep = 15;  ///< largest distance, in kStep_px

  /// A place of an outline, px from the middle of the view.
  struct Place {
    std::int16_t x = 0;          ///< px
    std::int16_t y = 0;          ///< px
    std::uint8_t direction = 0;  ///< edgeDirectionOf() its normal
  };

  /// Takes the memory from `arena`.
  void create(Arena& arena);
  /// Begins with maps of this size, each at most kMaxView_px, and slides to either side of at most
  /// half the size.
  void begin(int width, int height, int slide_x_px, int slide_y_px);
  /// Takes the map of a direction from its edges. Outside of the map its mean counts.
  void takeMap(const DirectedEdges& edges, int direction);
  /// Sums over at most kMaxPlaces places.
  void add(std::span<const Place> places);

  /// Distance to the edges of a direction, in kStep_px, at a place, px from the middle of the view.
  std::uint8_t at(int direction, double x_px, double y_px) const;

  int columns() const { return columns_; }  ///< slides along x
  int rows() const { return rows_; }        ///< slides along y
  /// Sum of the distances, kStep_px, when the outline is slid by (column - slide_x, row - slide_y).
  std::uint16_t sum(int column, int row) const { return rowOf(row)[column]; }
  /// Whether no neighbouring slide has a smaller sum.
  bool isPeak(int column, int row) const;
  /// The smallest sum of all slides.
  std::uint16_t least() const;

 private:
  static constexpr int kBlock = 16;      ///< columns that are summed at the same time
  static constexpr int kBorder_px = 24;  ///< around the maps
  static constexpr int kMaxSide_px = kMaxView_px + 2 * kBorder_px + kBlock;
  static constexpr int kChunk = 16;  ///< places whose sum fits a byte
  static_assert(kChunk * kFarthestStep < 256);

  const std::uint16_t* rowOf(int row) const { return sums_.data() + row * sum_stride_; }
  const std::uint8_t* cornerOf(const Place& place) const;

  int width_ = 0, height_ = 0;                                 ///< of the view
  int slide_x_ = 0, slide_y_ = 0;                              ///< to either side
  int columns_ = 0, rows_ = 0;                                 ///< slides
  int stride_ = 0;                                             ///< of the maps
  int sum_stride_ = 0;                                         ///< of the sums
  std::array<std::span<std::uint8_t>, kEdgeDirections> maps_;  ///< with their borders
  std::span<std::uint16_t> sums_;
};

}  // namespace boresight
