// SPDX-License-Identifier: Apache-2.0
// Tables of the branch unit: 512 two-bit counters, and 64 branches with cached targets.
#pragma once

#include <array>
#include <cstdint>

#include "cache.h"

namespace boresight::cycles {

class Predictor {
 public:
  /// Whether the direction was foreseen; learns it.
  bool predict(std::uint32_t address, bool taken) {
    std::uint8_t& counter = counters_[address / 4 % counters_.size()];
    const bool foreseen = (counter >= 2) == taken;
    if (taken && counter < 3) ++counter;
    if (!taken && counter > 0) --counter;
    return foreseen;
  }
  /// Whether the target of the taken branch was cached; it is afterwards.
  bool findTarget(std::uint32_t address) { return targets_.access(address, false).hit; }

 private:
  std::array<std::uint8_t, 512> counters_{};
  Cache targets_{64 * 4, 4, 4};
};

}  // namespace boresight::cycles
