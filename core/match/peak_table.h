// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <cstdint>
#include <span>

#include "core/base/arena.h"
#include "core/match/search_window.h"
#include "core/match/whs_types.h"

namespace boresight {

/// Best offset of each 8x8 block of a window, and the bound below which offsets are skipped.
/// Offsets are compared by S+ max(c-, 1) + S- max(c+, 1) with S- = c- - C + S+, where C = corr(M,
/// I); ties go to the smaller squared distance from the predicted place, then to raster order.
///
/// The second best depends on the position of the best, which is known last. Consider two offsets
/// seen so far whose blocks are so far apart that no exclusion square touches both. For any
/// position of the best, one of the two stays eligible as second best. An offset below both can
/// therefore be neither the best nor the second best. This is the bound below which offsets are
/// skipped.
class PeakTable {
 public:
  /// Offsets along a side of a block.
  static constexpr int kBlock = 8;

  /// Takes the table for windows of up to this extent along each axis.
  void create(int max_window_px, Arena& arena);
  /// Clears the table for a window.
  void begin(const SearchWindow& window, const WhsNorms& norms, int predicted_x, int predicted_y,
             int exclusion_px);

  /// An offset with fewer hits than this, and at least `least_covered` test edges under the mask,
  /// can be neither the best nor the second best.
  std::int32_t leastHits(std::int32_t least_covered) const;
  /// Offset (x, y) relative to the window's corner, with S+ = `hits` and C = `covered`.
  void offer(int x, int y, std::int32_t hits, std::int32_t covered);
  WhsPeak finish() const;  ///< The best place and the second, of all offsets offered

 private:
  struct Offset {
    int x = 0, y = 0;
    std::int32_t hits = 0, covered = 0;
    std::int64_t value = -1;
  };
  std::size_t blockIndex(int block_x, int block_y) const {
    return static_cast<std::size_t>(block_y) * static_cast<std::size_t>(blocks_x_) +
           static_cast<std::size_t>(block_x);
  }
  std::int64_t value(std::int32_t hits, std::int32_t covered) const;
  std::int64_t squaredDistance(const Offset& offset) const;
  bool isBetter(const Offset& a, const Offset& b) const;
  bool farApart(const Offset& a, const Offset& b) const;
  bool touchesExclusion(const Offset& offset, const Offset& best) const;
  Offset unpack(int block_x, int block_y, std::uint64_t packed) const;
  void updateBound(const Offset& offset);

  SearchWindow window_;
  WhsNorms norms_;
  std::int64_t hit_weight_ = 0, covered_weight_ = 0, constant_ = 0;
  double hits_per_value_ = 0.0;
  int predicted_x_ = 0, predicted_y_ = 0;  ///< relative to the window's corner
  int exclusion_px_ = 0;
  int blocks_x_ = 0, blocks_y_ = 0;
  /// Per block hits + 2^19 covered + 2^38 place within the block + 2^44, or 0 when empty.
  std::span<std::uint64_t> blocks_;
  Offset best_;
  std::int64_t bound_ = 0;  ///< the lower value of the best two seen so far apart
};

}  // namespace boresight
