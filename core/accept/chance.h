// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>

namespace boresight {

/// A share of something, 0 of nothing.
inline double shareOf(std::int32_t part, std::int32_t whole) {
  return whole > 0 ? static_cast<double>(part) / static_cast<double>(whole) : 0.0;
}
/// What exceeds chance, in [0, 1].
inline double beyondChance(double share, double chance) {
  return share > chance && chance < 1.0 ? (share - chance) / (1.0 - chance) : 0.0;
}

}  // namespace boresight
