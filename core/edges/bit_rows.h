// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <span>

#include "core/base/arena.h"
#include "core/base/image.h"

namespace boresight {

/// Row y of `mask` widened by `margin_px` (0 ... 64) in every direction, diagonals included
/// (Chebyshev distance <= margin_px), into the words of `out`.
void dilateRow(const BitImage& mask, int y, int margin_px, std::uint64_t* out);

/// Rows first_row ... last_row - 1 of the next level of a pyramid: every pixel is the OR of 2 x 2
/// pixels of `fine`; sizes are halved and rounded up.
void poolRows(const BitImage& fine, int first_row, int last_row, BitImage& coarse);

/// Number of set bits.
std::int32_t countBits(const BitImage& image);

}  // namespace boresight
