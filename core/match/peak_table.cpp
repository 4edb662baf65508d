// SPDX-License-Identifier: Apache-2.0
#include "core/match/peak_table.h"

#include <algorithm>
#include <cstddef>
#include <cstdlib>

namespace boresight {
namespace {

constexpr int kCountBits = 19;  ///< counts up to 512 x 512
constexpr std::uint64_t kCountMask = (std::uint64_t{1} << kCountBits) - 1;
constexpr int kPlaceShift = 2 * kCountBits;
constexpr std::uint64_t kPresent = std::uint64_t{1} << 44;

int blocksFor(int extent_px) { return (extent_px + PeakTable::kBlock - 1) / PeakTable::kBlock; }

}  // namespace

void PeakTable::create(int max_window_px, Arena& arena) {
  const std::size_t blocks = static_cast<std::size_t>(blocksFor(max_window_px));
  blocks_ = arena.allocate<std::uint64_t>(blocks * blocks);
}

void PeakTable::begin(const SearchWindow& window, const WhsNorms& norms, int predicted_x,
                      int predicted_y, int exclusion_px) {
  window_ = window;
  norms_ = norms;
  const std::int64_t c_plus = std::max(norms.edges, 1);
  const std::int64_t c_minus = std::max(norms.empties, 1);
  hit_weight_ = c_plus + c_minus;
  covered_weight_ = c_plus;
  constant_ = norms.empties * c_plus;
  hits_per_value_ = 1.0 / static_cast<double>(hit_weight_);
  predicted_x_ = predicted_x - window.x_min;
  predicted_y_ = predicted_y - window.y_min;
  exclusion_px_ = exclusion_px;
  blocks_x_ = blocksFor(window.width());
  blocks_y_ = blocksFor(window.height());
  std::fill_n(blocks_.begin(), blocks_x_ * blocks_y_, std::uint64_t{0});
  best_ = Offset{};
  bound_ = 0;
}

std::int64_t PeakTable::value(std::int32_t hits, std::int32_t covered) const {
  return hits * hit_weight_ - covered * covered_weight_ + constant_;
}

std::int64_t PeakTable::squaredDistance(const Offset& offset) const {
  const std::int64_t dx = std::int64_t{offset.x} - predicted_x_;
  const std::int64_t dy = std::int64_t{offset.y} - predicted_y_;
  return dx * dx + dy * dy;
}

bool PeakTable::isBetter(const Offset& a, const Offset& b) const {
  if (a.value != b.value) return a.value > b.value;
  const std::int64_t distance_a = squaredDistance(a);
  const std::int64_t distance_b = squaredDistance(b);
  if (distance_a != distance_b) return distance_a < distance_b;
  return a.y != b.y ? a.y < b.y : a.x < b.x;
}

bool PeakTable::farApart(const Offset& a, const Offset& b) const {
  // Free offsets between the two blocks; a square spans 2 exclusion_px + 1.
  const int gap_x = kBlock * std::abs(a.x / kBlock - b.x / kBlock) - kBlock;
  const int gap_y = kBlock * std::abs(a.y / kBlock - b.y / kBlock) - kBlock;
  return std::max(gap_x, gap_y) >= 2 * exclusion_px_;
}

bool PeakTable::touchesExclusion(const Offset& offset, const Offset& best) const {
  const int left = offset.x / kBlock * kBlock;
  const int top = offset.y / kBlock * kBlock;
  return left <= best.x + exclusion_px_ && left + kBlock - 1 >= best.x - exclusion_px_ &&
         top <= best.y + exclusion_px_ && top + kBlock - 1 >= best.y - exclusion_px_;
}

std::int32_t PeakTable::leastHits(std::int32_t least_covered) const {
  const std::int64_t missing = bound_ - constant_ + least_covered * covered_weight_;
  if (missing <= 0) return 0;
  // One less than the quotient, so that rounding cannot drop an offset; the bound is only a filter.
  const std::int32_t hits =
      static_cast<std::int32_t>(static_cast<double>(missing) * hits_per_value_) - 1;
  return std::max(hits, 0);
}

PeakTable::Offset PeakTable::unpack(int block_x, int block_y, std::uint64_t packed) const {
  Offset offset;
  const int place = static_cast<int>((packed >> kPlaceShift) & 63u);
  offset.x = kBlock * block_x + place % kBlock;
  offset.y = kBlock * block_y + place / kBlock;
  offset.hits = static_cast<std::int32_t>(packed & kCountMask);
  offset.covered = static_cast<std::int32_t>((packed >> kCountBits) & kCountMask);
  offset.value = value(offset.hits, offset.covered);
  return offset;
}

void PeakTable::offer(int x, int y, std::int32_t hits, std::int32_t covered) {
  const Offset offset{x, y, hits, covered, value(hits, covered)};
  if (offset.value < bound_) return;
  const int block_x = x / kBlock, block_y = y / kBlock;
  std::uint64_t& block = blocks_[blockIndex(block_x, block_y)];
  if (block != 0 && !isBetter(offset, unpack(block_x, block_y, block))) return;
  const int place = y % kBlock * kBlock + x % kBlock;
  block = static_cast<std::uint64_t>(hits) | (static_cast<std::uint64_t>(covered) << kCountBits) |
          (static_cast<std::uint64_t>(place) << kPlaceShift) | kPresent;
  updateBound(offset);
}

void PeakTable::updateBound(const Offset& offset) {
  if (best_.value < 0) {
    best_ = offset;
    return;
  }
  const bool is_best = isBetter(offset, best_);
  if (farApart(offset, best_)) {
    bound_ = std::max(bound_, is_best ? best_.value : offset.value);
  }
  if (is_best) best_ = offset;
}

WhsPeak PeakTable::finish() const {
  WhsPeak peak;
  const auto counts = [this](const Offset& offset) {
    return WhsCounts{offset.hits, norms_.empties - offset.covered + offset.hits};
  };
  peak.x = window_.x_min + best_.x;
  peak.y = window_.y_min + best_.y;
  peak.counts = counts(best_);
  Offset second;
  for (int block_y = 0; block_y < blocks_y_; ++block_y) {
    for (int block_x = 0; block_x < blocks_x_; ++block_x) {
      const std::uint64_t block = blocks_[blockIndex(block_x, block_y)];
      if (block == 0) continue;
      const Offset offset = unpack(block_x, block_y, block);
      if (touchesExclusion(offset, best_)) continue;
      if (second.value < 0 || isBetter(offset, second)) second = offset;
    }
  }
  if (second.value < 0) return peak;
  peak.has_second = true;
  peak.second_x = window_.x_min + second.x;
  peak.second_y = window_.y_min + second.y;
  peak.second_counts = counts(second);
  return peak;
}

}  // namespace boresight
