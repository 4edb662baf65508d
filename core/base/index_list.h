// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <cstdint>
#include <span>

#include "core/base/arena.h"

namespace boresight {

/// A list of indices, or -1 for none: 16 bits each where all possible indices fit, else 32.
class IndexList {
 public:
  /// Takes a list of `count` entries from `arena`, all -1, for indices below `bound`.
  static IndexList create(std::size_t count, std::size_t bound, Arena& arena) {
    IndexList list;
    if (bound < kShortBound)
      list.short_ = arena.allocate<std::uint16_t>(count);
    else
      list.long_ = arena.allocate<std::uint32_t>(count);
    return list;
  }
  /// Number of entries; 0 with an arena that only counts.
  std::size_t size() const { return short_.size() + long_.size(); }
  /// An entry.
  std::int32_t operator[](std::size_t at) const {
    return static_cast<std::int32_t>(long_.empty() ? short_[at] : long_[at]) - 1;
  }
  /// Sets an entry to an index below the bound, or to -1.
  void set(std::size_t at, std::int32_t index) {
    const auto stored = static_cast<std::uint32_t>(index) + 1;
    if (long_.empty())
      short_[at] = static_cast<std::uint16_t>(stored);
    else
      long_[at] = stored;
  }

 private:
  /// Bounds below this fit 16 bits, as an entry is stored as index + 1.
  static constexpr std::size_t kShortBound = 65536;

  std::span<std::uint16_t> short_;
  std::span<std::uint32_t> long_;
};

}  // namespace boresight
