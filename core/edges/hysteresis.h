// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <span>

#include "core/base/arena.h"
#include "core/base/image.h"

namespace boresight {

/// Canny's hysteresis: `edges` grows over `candidates` along 8-connected pixels. Whole words flood
/// at once; sweeps go down and up over the rows and visit only words next to a change, until
/// nothing changes. Every visit that causes another adds at least one pixel, so the number of
/// candidates bounds the work for any image.
class Hysteresis {
 public:
  /// For images of this size; two integers per row from `arena`.
  void begin(int width, int height, Arena& arena);
  /// Visits about `word_budget` words; true when `edges` (a subset of `candidates`) is complete.
  [[nodiscard]] bool step(std::int32_t word_budget, const BitImage& candidates, BitImage& edges);

 private:
  std::int32_t floodRow(int y, const BitImage& candidates, BitImage& edges);
  void touch(int y, int first_word, int last_word);

  int words_per_row_ = 0;
  int height_ = 0;
  int y_ = 0;
  int direction_ = 1;
  int open_rows_ = 0;  ///< rows with words to visit
  std::span<std::int32_t>
      first_;  ///< per row: words to visit, first ... last; none if first > last
  std::span<std::int32_t> last_;
};

}  // namespace boresight
