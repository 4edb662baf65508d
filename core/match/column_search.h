// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <cstdint>
#include <span>

#include "core/base/arena.h"
#include "core/base/image.h"
#include "core/match/bit_counters.h"
#include "core/match/column_kernels.h"
#include "core/match/peak_table.h"
#include "core/match/search_window.h"
#include "core/match/whs_types.h"

namespace boresight {

/// The search of a window with wide registers (ColumnKernels), in tiles of 64 columns and bands of
/// rows of offsets. The template is transposed: its edges are listed column by column, so that a
/// tile needs the test edges shifted by a few columns at a time, which stay in the first-level
/// cache. The test edges under the mask are counted for a tile's first row of offsets; from row to
/// row they change by those on the mask's upper and lower borders:
///   C(x, y + 1) - C(x, y) = sum over (u, v) of [M(u, v - 1) - M(u, v)] I(x + u, y + v).
class ColumnSearch {
 public:
  static constexpr int kMaxSide_px = 256;  ///< larger templates are left to others
  static constexpr int kTileColumns = 64;  ///< columns of offsets in a tile

  /// Takes nothing without kernels.
  void create(int max_side_px, const ColumnKernels* kernels, Arena& arena);
  /// Transposes and lists a valid template; false when this search cannot do it: no kernels, a side
  /// or a number of pixels beyond what it was made for.
  bool begin(const TemplateView& view, const BitImage& test_edges, const SearchWindow& window);
  /// Edge and empty pixels of the template.
  const WhsNorms& norms() const { return norms_; }

  /// Counts the next band of the window and offers its offsets; true after the last one.
  bool searchBand(PeakTable& peaks);
  /// Words added for a band, as a measure of work.
  std::int64_t workOfBand() const;

 private:
  struct List {
    std::int32_t first = 0, count = 0;  ///< of offsets_, padded to a multiple of 4
    std::int32_t plane_count = 0;
  };
  /// Some columns of the template, of which the shifted test edges fit the scratch.
  struct Chunk {
    int first_column = 0, columns = 0;
    List edges, entering, leaving;
  };

  bool shape(const SearchWindow& window);
  void transpose(const TemplateView& view);
  bool listPixels();
  bool listChunk(Chunk& chunk);
  bool closeList(int capacity_left, List& list);
  void loadBand();
  void countChunk(const Chunk& chunk);
  void sumFirstRow();
  void offerLargest(PeakTable& peaks);
  void offerRest(PeakTable& peaks);
  void offerFound(int row, const std::uint64_t* found, PeakTable& peaks);
  bool nextBand();

  const ColumnKernels* kernels_ = nullptr;
  int max_side_px_ = 0;
  const BitImage* test_edges_ = nullptr;
  SearchWindow window_;
  WhsNorms norms_;
  int side_ = 0;

  // The template, word i of a row of these being rows 64 i ... of a column.
  int mask_stride_ = 0;
  std::span<std::uint64_t> mask_columns_, edge_columns_;
  std::span<std::int32_t> offsets_;
  int offset_count_ = 0;
  std::span<Chunk> chunks_;
  int chunk_count_ = 0;
  std::int32_t change_constant_ = 0;  ///< what the counted changes are too large by

  // A band of test edges.
  int band_rows_ = 0;                 ///< rows of offsets of a full band
  int stride_ = 0;                    ///< words of a column
  std::span<std::uint64_t> aligned_;  ///< words of the image, column by column
  std::span<std::uint64_t> shifted_;  ///< columns of a chunk, then zeros
  CounterRow hits_, changes_, first_row_;
  std::array<std::uint64_t, ColumnKernels::kLaneWords> first_counts_{};
  std::span<std::uint64_t> counts_;
  std::span<std::uint16_t> least_;
  std::span<std::uint16_t> lanes_;

  // Where the search stands, relative to the window.
  int tile_x_ = 0, tile_width_ = 0;
  int row_ = 0, rows_ = 0;
};

}  // namespace boresight
