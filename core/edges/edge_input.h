// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>

#include "core/base/image.h"
#include "core/base/status.h"
#include "core/edges/edge_options.h"

namespace boresight {

/// Longest side of an image; with it every count and every offset of this stage fits 32 bits.
inline constexpr int kMaxImageSide = 16384;

/// Pixels in one bounded slice of the stage.
inline constexpr std::int32_t kEdgeSlice = 1 << 19;

/// kInvalidOption for an option out of range; kInvalidImage for an empty or too
/// large image, overlapping rows, or an ignore mask of another size. `sizes_only` (a counting
/// arena) leaves the pixels out: there may be none yet.
Status checkEdgeInput(const ImageView& image, const BitImage* ignore, const EdgeOptions& options,
                      bool sizes_only);

}  // namespace boresight
