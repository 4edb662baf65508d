// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>

namespace boresight {

/// Index of the `k`-th chosen item when one item of each `stride` in turn is chosen: at a place in
/// its stride that looks random. Every `stride`-th item in raster order would lie on the same side
/// of an upright object in every row. May lie beyond the last item.
inline std::int32_t scattered(std::int32_t k, std::int32_t stride) {
  if (stride <= 1) return k;
  std::uint32_t hash = static_cast<std::uint32_t>(k) * 2654435761U;
  hash ^= hash >> 15;
  hash *= 2246822519U;
  hash ^= hash >> 13;
  return k * stride + static_cast<std::int32_t>(hash % static_cast<std::uint32_t>(stride));
}

}  // namespace boresight
