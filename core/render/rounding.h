// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cmath>

namespace boresight {

/// floor(value) clamped to [low, high]; NaN gives `low`. No double reaches an integer unclamped.
inline int floorClamped(double value, int low, int high) {
  if (!(value > low)) return low;
  if (value >= high) return high;
  return static_cast<int>(std::floor(value));
}

/// ceil(value) clamped to [low, high]; NaN gives `low`.
inline int ceilClamped(double value, int low, int high) {
  if (!(value > low)) return low;
  if (value >= high) return high;
  return static_cast<int>(std::ceil(value));
}

}  // namespace boresight
