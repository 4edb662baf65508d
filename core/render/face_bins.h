// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <span>

#include "core/base/arena.h"
#include "core/base/index_list.h"
#include "core/base/nth.h"
#include "core/render/camera_scene.h"
#include "core/render/ray_grid.h"
#include "core/render/small_face.h"

namespace boresight {

/// Sorts the faces that may cover a pixel's centre into the bands of rows in which they are drawn.
/// Nothing changes while bands are drawn, so bands may be drawn in any order.
class FaceBins {
 public:
  /// Columns that faces may cover.
  struct Columns {
    std::int16_t first = 32767;  ///< leftmost
    std::int16_t last = -1;      ///< rightmost; none while it is less than the first
    /// Extends the range to include these columns.
    void include(int other_first, int other_last) {
      if (other_first < first) first = static_cast<std::int16_t>(other_first);
      if (other_last > last) last = static_cast<std::int16_t>(other_last);
    }
  };

  /// Allocates the lists from `arena` for the given numbers of faces, bands and shares.
  static FaceBins create(std::size_t faces, int max_bands, int max_shares, Arena& arena);
  /// `plain`: no face is treated as small, for comparison. Faces may be added in up to `max_shares`
  /// shares, each by another worker.
  void begin(const CameraScene& scene, const RayGrid& rays, int band_rows, bool plain, int shares);
  /// Adds faces first .. last - 1 and sets their kFrontFacing.
  void add(CameraScene& scene, const RayGrid& rays, std::size_t first, std::size_t last, int share);
  /// Call after the last face, before the first band.
  void finish();

  /// Columns that the faces of a band may cover.
  const Columns& columns(int band) const { return nth(columns_, band); }

  /// The faces of a band, in an order in which hidden ones mostly come last: lists 0 .. lists() -
  /// 1, those from firstSmallList() on of small faces. Some of the listed faces lie in other bands
  /// only.
  int lists() const { return firstSmallList() + 6 * shares_; }
  /// Number of the first list of small faces.
  int firstSmallList() const { return 3 * levels_ * shares_; }
  std::int32_t firstFace(int band, int list) const;  ///< First face of a list; -1: none
  /// The face after `face` in its list; -1: none.
  std::int32_t nextFace(std::int32_t face) const { return nth(next_, face); }

  /// The object that draws the small faces.
  const SmallFaces& smallFaces() const { return small_; }

 private:
  enum Kind : std::uint8_t { kSmallFront, kSmallBack, kWide };
  /// Levels of blocks of 2, 4, 8 .. bands for faces that touch many bands.
  static constexpr int kMostLevels = 16;
  /// Lists of the faces of one share.
  struct Share {
    std::span<std::int32_t> head;
    std::span<Columns> columns;
  };
  Share shareOf(int share) const {
    const auto index = static_cast<std::size_t>(share);
    return {head_.subspan(index * heads_, heads_), columns_.subspan(index * bands_, bands_)};
  }
  void addOne(CameraScene& scene, const RayGrid& rays, std::int32_t face, const FixedFace& fixed,
              const Share& share);
  void addWide(CameraScene& scene, const RayGrid& rays, std::int32_t face, const Share& share);
  void enter(std::int32_t face, Kind kind, const PixelBounds& bounds, const Share& share);

  IndexList next_;  ///< per face: the next one of its list
  /// Per share and block of bands, the first face within it and the first that lies in the next one
  /// too: small front faces, small back faces (blocks of one band), wide faces (all levels).
  std::span<std::int32_t> head_;
  std::span<Columns> columns_;  ///< per share and band; in the end the first share's are for all
  std::size_t heads_ = 0;       ///< per share
  std::size_t bands_ = 0;       ///< per share, at most
  int shares_ = 1;
  std::array<int, 2> first_of_kind_{};
  std::array<int, kMostLevels> first_of_level_{};
  int levels_ = 0;
  int band_rows_ = 1;
  SmallFaces small_;
};

}  // namespace boresight
