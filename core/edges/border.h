// SPDX-License-Identifier: Apache-2.0
#pragma once

namespace boresight {

/// Index inside [0, size) that corresponds to `index` when the image is mirrored at the centres of
/// its border pixels (cv::BORDER_REFLECT_101: gfedcb|abcdefgh|gfedcba). `index` may lie several
/// image widths outside; every iteration brings it nearer by at least one pixel.
inline int reflect101(int index, int size) {
  if (size <= 1) return 0;
  while (index < 0 || index >= size) index = index < 0 ? -index : 2 * (size - 1) - index;
  return index;
}

/// Rows are processed in blocks of this many pixels: with a constant trip count the compiler
/// vectorizes the inner loops at every optimization level.
inline constexpr int kRowBlock = 64;

inline constexpr int roundUpToBlock(int width) {
  return (width + kRowBlock - 1) / kRowBlock * kRowBlock;
}

}  // namespace boresight
