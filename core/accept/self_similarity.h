// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <cstdint>
#include <span>

#include <Eigen/Core>

#include "core/base/arena.h"
#include "core/render/edge_render.h"

namespace boresight {

/// A displacement in the image that lays a render's edges on each other.
struct SelfShift {
  std::int32_t x_px = 0;    ///< px of the render
  std::int32_t y_px = 0;    ///< px of the render
  double similarity = 0.0;  ///< share of the edges laid on others, beyond chance
  /// From an edge to the one that it falls on, median per axis: a station moved by this covers
  /// itself.
  Eigen::Vector3d displacement_in_camera_m = Eigen::Vector3d::Zero();
};

/// Where the edges of a render look like themselves: the share of edge pixels that, displaced, fall
/// on edges of the same direction and side, for all displacements within reach, and the peaks of
/// that map. An edge counts by how much the displacement moves it along its normal (a straight edge
/// looks the same along itself); what leaves the picture does not count. All decisions are made in
/// integers, on cells of at most a 256th of the picture, met within a cell.
class SelfSimilarity {
 public:
  static constexpr int kMostShifts = 32;  ///< most peaks that are kept
  /// Share of the edges, beyond chance, that a displacement must lay on others: a part of the
  /// object repeats, not single edges.
  static constexpr double kLeastSimilarity = 0.3;

  /// Takes the memory for renders of up to this size.
  void create(int width, int height, Arena& arena);
  /// The render must outlive the steps. Displacements up to `reach` px along each axis are looked
  /// at, and at most half of the picture.
  void begin(const EdgeRender& render, int reach_x_px, int reach_y_px, double least_similarity);
  /// One bounded slice; true when `shifts()` is complete.
  [[nodiscard]] bool step();
  /// The most similar first.
  std::span<const SelfShift> shifts() const {
    return std::span(shifts_).first(static_cast<std::size_t>(count_));
  }

 private:
  static constexpr int kBins = 16;  ///< directions of normals
  static constexpr int kMostCells = 256;
  static constexpr int kMostPlaces = 2048;
  static constexpr int kNearest = 4;  ///< cells; nearer displacements are none
  static constexpr int kScale = 10000;

  struct Place {
    std::int32_t pixel = 0;
    std::int16_t x = 0, y = 0;  ///< cells
    std::uint8_t bin = 0;
  };

  void takePlaces();
  void markCells();
  void scoreRow(int dy);
  std::int32_t scoreOf(int dx, int dy) const;
  std::int32_t scoreAt(int dx, int dy) const;
  bool isPeak(int dx, int dy) const;
  void findPeaks();
  void keep(const SelfShift& shift);
  void measureDisplacement(SelfShift& shift);
  std::int32_t partnerOf(const EdgePixel& pixel, const SelfShift& shift) const;

  const EdgeRender* render_ = nullptr;
  int columns_ = 0, rows_ = 0;  ///< cells
  int cell_shift_ = 0;          ///< a cell is 2^this px wide
  int reach_x_ = 0, reach_y_ = 0;
  std::int32_t least_ = 0;           ///< similarity, in 1/kScale
  std::span<std::uint16_t> cells_;   ///< bins of the edges in the cell and its neighbours
  std::span<std::uint16_t> scores_;  ///< of displacements with dy >= 0: the others mirror them
  std::span<Place> places_;
  int place_count_ = 0;
  std::array<std::span<float>, 3> found_m_;
  int row_ = 0;
  int measured_ = -1;  ///< shifts whose displacement is known; -1: the map is not complete
  std::array<SelfShift, kMostShifts> shifts_;
  int count_ = 0;
};

}  // namespace boresight
