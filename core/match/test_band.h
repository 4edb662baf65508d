// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <cstdint>
#include <span>

#include "core/base/arena.h"
#include "core/base/image.h"

namespace boresight {

/// The rows of test edges that a band of offsets reads, copied so that the first offset's column
/// is bit 0, rows are byte ordered (see byteOrdered) and reading beyond a row's end is harmless.
/// Small bands are held in up to eight copies with different bit shifts, so that fewer pixels need
/// their own shift; all copies together fit the first-level cache.
class TestBand {
 public:
  /// Most shifted copies of a band.
  static constexpr int kMostCopies = 8;

  /// Takes the memory for templates of up to `max_side` px and `max_words` words of offsets a row.
  void create(int max_side, int max_words, Arena& arena);
  /// Sets the layout: a row holds `side` + 64 * `words` pixels and slack, in at most `most_copies`.
  void shape(int side, int words, int most_copies = kMostCopies);
  /// Rows of offsets that a band serves: row k reads rows k ... k + side of the band.
  int offsetRows() const { return offset_rows_; }
  /// Copies the rows from (x, y) on; rows below the image are zero.
  void load(const BitImage& test_edges, int x, int y);

  /// First byte of row `row` of the band.
  const std::uint8_t* row(int row) const { return bytes_.data() + std::ptrdiff_t{stride_} * row; }
  /// Bytes from a row to the next one.
  int stride() const { return stride_; }

  /// Number of different shifts: pixels with the same shift can be counted together.
  int shifts() const { return 8 / copies_; }
  /// Bytes from a row of offsets to the row of pixel (u, v), which begins there but for a shift to
  /// the right by u % shifts().
  int offsetOf(int u, int v) const {
    return (u % 8) / shifts() * copy_bytes_ + v * stride_ + u / 8;
  }
  /// Offset of zeros that pad the lists of pixels.
  int zeroOffset() const { return copies_ * copy_bytes_; }

 private:
  void storeRow(const std::uint64_t* pixels, std::uint8_t* to) const;

  std::span<std::uint8_t> bytes_;
  int stride_ = 0;
  int side_ = 0;
  int words_ = 0;
  int offset_rows_ = 0;
  int copies_ = 1;
  int copy_bytes_ = 0;
};

}  // namespace boresight
