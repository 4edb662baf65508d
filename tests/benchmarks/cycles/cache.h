// SPDX-License-Identifier: Apache-2.0
// A set-associative cache with copy-back, as the tags alone.
#pragma once

#include <cstdint>
#include <utility>
#include <vector>

namespace boresight::cycles {

/// Replaces the line that was used least recently; the PowerPC 750 approximates that.
class Cache {
 public:
  struct Access {
    bool hit = false;
    bool writes_back = false;  ///< the replaced line was written to
  };

  Cache(std::uint32_t bytes, int ways, std::uint32_t line_bytes)
      : ways_(ways),
        line_bytes_(line_bytes),
        sets_(bytes / line_bytes / static_cast<std::uint32_t>(ways)),
        lines_(static_cast<std::size_t>(ways) * sets_) {}

  Access access(std::uint32_t address, bool store) {
    const std::uint32_t number = address / line_bytes_;
    Line* set = &lines_[static_cast<std::size_t>(number % sets_) * static_cast<std::size_t>(ways_)];
    Line line{number, true, store};
    int way = 0;
    while (way < ways_ - 1 && !(set[way].valid && set[way].number == number)) ++way;
    const bool hit = set[way].valid && set[way].number == number;
    const bool writes_back = !hit && set[way].valid && set[way].dirty;
    if (hit) line.dirty = line.dirty || set[way].dirty;
    for (; way > 0; --way) set[way] = set[way - 1];
    set[0] = line;
    return {hit, writes_back};
  }

 private:
  /// A set holds its lines in the order of their last use.
  struct Line {
    std::uint32_t number = 0;
    bool valid = false;
    bool dirty = false;
  };

  int ways_;
  std::uint32_t line_bytes_;
  std::uint32_t sets_;
  std::vector<Line> lines_;
};

/// Where an access found its line.
struct Found {
  bool level1 = true;
  bool level2 = true;
  bool writes_back = false;         ///< a line goes from the level 1 cache to memory
  bool writes_back_level2 = false;  ///< a line goes from the level 2 cache to memory
};

/// Caches of the processor: 32 KB each of instructions and data, and a level 2 cache of 1 MB that
/// only some estimates have.
class Caches {
 public:
  static constexpr std::uint32_t kLineBytes = 32;

  Found fetch(std::uint32_t address) { return find(instructions_, address, false); }
  Found data(std::uint32_t address, bool store) { return find(data_, address, store); }

 private:
  Found find(Cache& level1, std::uint32_t address, bool store) {
    const Cache::Access first = level1.access(address, store);
    if (first.hit) return {};
    const Cache::Access second = level2_.access(address, store);
    return {false, second.hit, first.writes_back, second.writes_back};
  }

  Cache instructions_{32768, 8, kLineBytes};
  Cache data_{32768, 8, kLineBytes};
  Cache level2_{1 << 20, 2, 64};
};

}  // namespace boresight::cycles
