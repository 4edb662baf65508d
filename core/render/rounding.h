// SPDX-License-Identifier: Apache-2.0
#pragma once

namespace boresight {

/// floor(value) clamped to [low, high]; NaN gives `low`. No double reaches an integer unclamped.
inline int floorClamped(double value, int low, int high) {
  if (!(value > low)) return low;
  if (value >= high) return high;
  const int truncated = static_cast<int>(value);
  return truncated - (value < truncated ? 1 : 0);
}

/// ceil(value) clamped to [low, high]; NaN gives `low`.
inline int ceilClamped(double value, int low, int high) {
  if (!(value > low)) return low;
  if (value >= high) return high;
  const int truncated = static_cast<int>(value);
  return truncated + (value > truncated ? 1 : 0);
}

}  // namespace boresight
