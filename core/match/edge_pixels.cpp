// SPDX-License-Identifier: Apache-2.0
#include "core/match/edge_pixels.h"

#include <bit>
#include <cstddef>

#include "core/match/template_bits.h"

namespace boresight {
namespace {

constexpr int kGroup = 4;
int padded(int count) { return (count + kGroup - 1) / kGroup * kGroup; }

/// Bits `phase` of all bytes.
constexpr std::uint64_t phaseMask(int phase) { return std::uint64_t{0x0101010101010101u} << phase; }

}  // namespace

void EdgePixels::create(int capacity, Arena& arena) {
  // A row always fits: it is what a list of rows must be able to hold at least.
  const int least = kMaxTemplateSide_px;
  const int size = (capacity > least ? capacity : least) + kPhases * (kGroup - 1);
  offsets_ = arena.allocate<std::int32_t>(static_cast<std::size_t>(size));
}

int EdgePixels::list(const TemplateView& view, const TestBand& band, int first_row) {
  const int words = (view.side_px + 63) / 64;
  const int room = static_cast<int>(offsets_.size()) - kPhases * (kGroup - 1);
  count_.fill(0);
  int total = 0, end_row = first_row;
  for (; end_row < view.side_px; ++end_row) {
    std::array<int, kPhases> in_row{};
    int row_total = 0;
    for (int word = 0; word < words; ++word) {
      const std::uint64_t bits = edgeWord(view, end_row, word);
      row_total += std::popcount(bits);
      for (int phase = 0; bits != 0 && phase < kPhases; ++phase) {
        in_row[static_cast<std::size_t>(phase)] += std::popcount(bits & phaseMask(phase));
      }
    }
    if (total + row_total > room) break;
    total += row_total;
    for (std::size_t phase = 0; phase < kPhases; ++phase) count_[phase] += in_row[phase];
  }

  std::array<int, kPhases> next{};
  int first = 0;
  for (std::size_t phase = 0; phase < kPhases; ++phase) {
    first_[phase] = next[phase] = first;
    first += padded(count_[phase]);
  }
  for (int v = first_row; v < end_row; ++v) {
    for (int word = 0; word < words; ++word) {
      for (std::uint64_t bits = edgeWord(view, v, word); bits != 0; bits &= bits - 1) {
        const int u = 64 * word + std::countr_zero(bits);
        int& at = next[static_cast<std::size_t>(u % kPhases)];
        offsets_[static_cast<std::size_t>(at++)] = v * band.stride() + u / kPhases;
      }
    }
  }
  for (std::size_t phase = 0; phase < kPhases; ++phase) {
    for (; next[phase] < first_[phase] + padded(count_[phase]); ++next[phase]) {
      offsets_[static_cast<std::size_t>(next[phase])] = band.zeroOffset();
    }
  }
  return end_row;
}

std::span<const std::int32_t> EdgePixels::offsets(int phase) const {
  const std::size_t k = static_cast<std::size_t>(phase);
  return offsets_.subspan(static_cast<std::size_t>(first_[k]),
                          static_cast<std::size_t>(padded(count_[k])));
}

}  // namespace boresight
