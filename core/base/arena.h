// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <concepts>
#include <cstddef>
#include <cstdint>
#include <new>
#include <span>
#include <type_traits>
#include <utility>

namespace boresight {

/// All memory of the core: a block that the caller owns, handed out from the front. Objects are not
/// freed one by one; a stage that needs scratch takes a mark, allocates, and rewinds. An arena
/// without a block only counts, to compute sizes before any memory exists. The same allocation code
/// runs twice, so the count equals the use.
class Arena {
 public:
  Arena() = default;  ///< counts only
  /// Allocates from the block, which must outlive the allocations.
  explicit Arena(std::span<std::byte> block) : block_(block) {}

  /// `wanted` value-initialized objects; empty when the block is exhausted (then
  /// `exhausted()`), or when the arena only counts.
  template <class T, std::integral Count>
  std::span<T> allocate(Count wanted) {
    if (std::cmp_less(wanted, 0)) {
      exhausted_ = true;
      return {};
    }
    const auto count = static_cast<std::size_t>(wanted);
    static_assert(std::is_trivially_destructible_v<T>);
    static_assert(alignof(T) <= kAlignment);
    const std::size_t bytes = (count * sizeof(T) + kAlignment - 1) / kAlignment * kAlignment;
    used_ += bytes;
    if (used_ > high_water_) high_water_ = used_;
    if (block_.empty()) return {};
    if (exhausted_ || used_ > block_.size()) {
      exhausted_ = true;
      return {};
    }
    T* first = reinterpret_cast<T*>(block_.data() + (used_ - bytes));
    for (std::size_t i = 0; i < count; ++i) new (first + i) T();
    return {first, count};
  }

  /// Start of the next allocation, for rewind().
  std::size_t mark() const { return used_; }
  /// Frees everything allocated since the mark was taken.
  void rewind(std::size_t mark) { used_ = mark; }
  /// Frees everything.
  void reset() {
    used_ = 0;
    exhausted_ = false;
  }

  /// Bytes in use, including allocations that did not fit.
  std::size_t used() const { return used_; }
  /// Largest number of bytes in use at a time.
  std::size_t highWater() const { return high_water_; }
  /// Bytes of the block.
  std::size_t capacity() const { return block_.size(); }
  /// Whether an allocation did not fit; later allocations are empty.
  bool exhausted() const { return exhausted_; }
  /// Whether there is no block.
  bool countsOnly() const { return block_.empty(); }

  /// Every allocation begins at a multiple of this, bytes.
  static constexpr std::size_t kAlignment = 16;

 private:
  std::span<std::byte> block_;
  std::size_t used_ = 0;
  std::size_t high_water_ = 0;
  bool exhausted_ = false;
};

}  // namespace boresight
