// SPDX-License-Identifier: Apache-2.0
#include "core/match/mask_counts.h"

#include <algorithm>
#include <bit>
#include <cstddef>

#include "core/match/bit_rows.h"
#include "core/match/template_bits.h"

namespace boresight {
namespace {

constexpr int kGroup = 4;
constexpr int kMaxSingles = 4096;
// Prefix sums over 64 offsets of run ends must stay below 65536 (planesToPrefixSums).
constexpr int kMaxRunEnds = 1020;
constexpr int kChunk = 1020;
// Changes of a count are 16-bit integers.
constexpr int kMaxBorderPixels = 32767;
constexpr int kBorderPlanes = 13;
constexpr int kRowWords = kMaxTemplateWords + 1;  ///< a run may end at column `side`

/// Calls f(u) for every column u = 0 ... side where a row of bits differs from its left neighbour.
template <class Function>
void forEachChange(const std::uint64_t* bits, Function f) {
  std::uint64_t left = 0;
  for (int word = 0; word < kRowWords; ++word) {
    std::uint64_t change = bits[word] ^ ((bits[word] << 1) | left);
    left = bits[word] >> 63;
    for (; change != 0; change &= change - 1) f(64 * word + std::countr_zero(change));
  }
}

/// Calls f(begin, end) for every run of ones.
template <class Function>
void forEachRun(const std::uint64_t* bits, Function f) {
  int begin = -1;
  forEachChange(bits, [&](int u) {
    if (begin < 0) {
      begin = u;
    } else {
      f(begin, u);
      begin = -1;
    }
  });
}

void maskRow(const TemplateView& view, int v, std::uint64_t* bits) {
  for (int word = 0; word < kRowWords; ++word) bits[word] = maskWord(view, v, word);
}

/// Ones among pixels begin ... end - 1 of a byte-ordered row.
int onesBetween(const std::uint8_t* row, int begin, int end) {
  int ones = 0;
  for (int word = begin >> 6; 64 * word < end; ++word) {
    std::uint64_t bits = byteOrdered(loadWord(row + 8 * word));
    bits &= sideMask(end, word) & ~sideMask(begin, word);
    ones += std::popcount(bits);
  }
  return ones;
}

int padPixels(std::span<SignedPixel> pixels, int count, int zero_offset) {
  int end = count;
  for (; end % kGroup != 0; ++end) {
    pixels[static_cast<std::size_t>(end)] = makeSignedPixel(zero_offset, 0, false);
  }
  return end;
}

std::span<std::uint64_t> allocatePlanes(int planes, int words, Arena& arena, CounterRow& row) {
  const std::span<std::uint64_t> memory =
      arena.allocate<std::uint64_t>(static_cast<std::size_t>(planes * words));
  row.words = memory.data();
  row.stride = words;
  return memory;
}

}  // namespace

void MaskCounts::create(int max_words, Arena& arena) {
  const std::size_t offsets = static_cast<std::size_t>(kLanes * max_words);
  singles_ = arena.allocate<SignedPixel>(kMaxSingles + kGroup);
  run_ends_ = arena.allocate<SignedPixel>(kMaxRunEnds + kGroup);
  runs_ = arena.allocate<Run>(kMaxRunEnds / 2);
  chunk_ = arena.allocate<SignedPixel>(kChunk + kGroup);
  allocatePlanes(kBorderPlanes, max_words, arena, single_planes_);
  allocatePlanes(kBorderPlanes, max_words, arena, run_planes_);
  differences_ = arena.allocate<std::int32_t>(offsets);
  counts_ = arena.allocate<std::int32_t>(offsets);
  least_ = arena.allocate<std::int32_t>(static_cast<std::size_t>(max_words));
  for (int x = 0; x < kLanes; ++x) {
    offset_of_lane_[static_cast<std::size_t>(laneIndex(x))] = static_cast<std::uint16_t>(x);
  }
}

void MaskCounts::begin(const TemplateView& view, const TestBand& band) {
  view_ = view;
  stride_ = band.stride();
  zero_offset_ = band.zeroOffset();
  too_many_borders_ = false;
  border_pixels_ = 0;
  single_count_ = single_negatives_ = 0;
  run_end_count_ = run_end_negatives_ = run_count_ = 0;
  row_end_count_ = 0;
  std::uint64_t above[kRowWords] = {}, below[kRowWords];
  for (int v = 0; v <= view.side_px; ++v) {
    if (v < view.side_px) {
      maskRow(view, v, below);
      forEachChange(below, [this](int) { ++row_end_count_; });
    } else {
      for (std::uint64_t& word : below) word = 0;
    }
    if (!too_many_borders_) listBorders(v, above, below);
    for (int word = 0; word < kRowWords; ++word) above[word] = below[word];
  }
  padPixels(singles_, single_count_, zero_offset_);
  padPixels(run_ends_, run_end_count_, zero_offset_);
}

/// The borders between rows v - 1 and v of the mask; both are counted at row v.
void MaskCounts::listBorders(int v, const std::uint64_t* above, const std::uint64_t* below) {
  std::uint64_t left[kRowWords], entered[kRowWords];
  for (int word = 0; word < kRowWords; ++word) {
    entered[word] = above[word] & ~below[word];
    left[word] = below[word] & ~above[word];
  }
  forEachRun(entered, [&](int begin, int end) { addBorder(v, begin, end, 1); });
  forEachRun(left, [&](int begin, int end) { addBorder(v, begin, end, -1); });
}

void MaskCounts::addBorder(int v, int begin, int end, int sign) {
  const int length = end - begin;
  const bool by_ends = length > 2;
  border_pixels_ += length;
  if (border_pixels_ > kMaxBorderPixels || (by_ends && run_end_count_ + 2 > kMaxRunEnds) ||
      (!by_ends && single_count_ + length > kMaxSingles)) {
    too_many_borders_ = true;
    return;
  }
  if (!by_ends) {
    for (int u = begin; u < end; ++u) {
      singles_[static_cast<std::size_t>(single_count_++)] =
          makeSignedPixel(v * stride_ + u / 8, u % 8, sign < 0);
      if (sign < 0) ++single_negatives_;
    }
    return;
  }
  // From x to x + 1 the run gains pixel x + end and loses pixel x + begin.
  runs_[static_cast<std::size_t>(run_count_++)] =
      Run{static_cast<std::int16_t>(v), static_cast<std::int16_t>(begin),
          static_cast<std::int16_t>(end), static_cast<std::int16_t>(sign)};
  run_ends_[static_cast<std::size_t>(run_end_count_++)] =
      makeSignedPixel(v * stride_ + end / 8, end % 8, sign < 0);
  run_ends_[static_cast<std::size_t>(run_end_count_++)] =
      makeSignedPixel(v * stride_ + begin / 8, begin % 8, sign > 0);
  ++run_end_negatives_;
}

int MaskCounts::work() const {
  return too_many_borders_ ? row_end_count_ : single_count_ + run_end_count_;
}

int MaskCounts::runSum(const TestBand& band, const std::uint8_t* rows) const {
  int sum = 0;
  for (int k = 0; k < run_count_; ++k) {
    const Run& run = runs_[static_cast<std::size_t>(k)];
    sum += run.sign * onesBetween(rows + band.stride() * run.v, run.begin, run.end);
  }
  return sum;
}

void MaskCounts::advanceRow(const TestBand& band, const std::uint8_t* rows, int words) {
  if (too_many_borders_) {
    computeRow(band, rows + band.stride(), words);
    return;
  }
  single_planes_.plane_count = planesFor(single_count_);
  run_planes_.plane_count = planesFor(run_end_count_);
  const int singles = (single_count_ + kGroup - 1) / kGroup * kGroup;
  const int ends = (run_end_count_ + kGroup - 1) / kGroup * kGroup;
  countSignedPixels(rows, singles_.data(), singles, words, single_planes_);
  countSignedPixels(rows, run_ends_.data(), ends, words, run_planes_);
  int run_sum = runSum(band, rows);
  for (int word = 0; word < words; ++word) {
    std::uint16_t under_singles[kLanes] = {}, under_runs[kLanes] = {};
    std::uint32_t change = 0;
    if (single_count_ > 0) planesToLanes(single_planes_, word, under_singles);
    if (run_end_count_ > 0) change = planesToPrefixSums(run_planes_, word, under_runs);
    // All modulo 2^16; the change itself lies within +-kMaxBorderPixels.
    const std::uint32_t constant =
        static_cast<std::uint32_t>(run_sum) - static_cast<std::uint32_t>(single_negatives_);
    const std::uint32_t slope = static_cast<std::uint32_t>(run_end_negatives_);
    std::int32_t* counts = counts_.data() + kLanes * word;
    for (std::size_t i = 0; i < kLanes; ++i) {
      const std::uint32_t sum =
          constant + under_singles[i] + under_runs[i] - slope * offset_of_lane_[i];
      counts[i] += static_cast<std::int16_t>(static_cast<std::uint16_t>(sum));
    }
    run_sum += static_cast<int>(change) - kLanes * run_end_negatives_;
  }
  updateLeast(words);
}

void MaskCounts::updateLeast(int words) {
  for (int word = 0; word < words; ++word) {
    const std::int32_t* counts = counts_.data() + kLanes * word;
    std::int32_t least = counts[0];
    for (int i = 1; i < kLanes; ++i) least = std::min(least, counts[i]);
    least_[static_cast<std::size_t>(word)] = least;
  }
}

/// Adds the chunk of run ends to the differences between neighbouring offsets and empties it.
void MaskCounts::addRunEnds(const std::uint8_t* rows, int words) {
  const int count = padPixels(chunk_, chunk_count_, zero_offset_);
  run_planes_.plane_count = planesFor(chunk_count_);
  countSignedPixels(rows, chunk_.data(), count, words, run_planes_);
  for (int word = 0; word < words; ++word) {
    std::uint16_t lanes[kLanes];
    planesToLanes(run_planes_, word, lanes);
    std::int32_t* differences = differences_.data() + kLanes * word;
    for (int i = 0; i < kLanes; ++i) differences[i] += lanes[i] - chunk_negatives_;
  }
  chunk_count_ = chunk_negatives_ = 0;
}

void MaskCounts::computeRow(const TestBand& band, const std::uint8_t* rows, int words) {
  for (std::int32_t& difference : differences_) difference = 0;
  chunk_count_ = chunk_negatives_ = 0;
  std::int32_t count = 0;
  for (int v = 0; v < view_.side_px; ++v) {
    std::uint64_t mask[kRowWords];
    maskRow(view_, v, mask);
    const int row_offset = v * band.stride();
    forEachRun(mask, [&](int begin, int end) {
      count += onesBetween(rows + row_offset, begin, end);
      if (chunk_count_ + 2 > kChunk) addRunEnds(rows, words);
      chunk_[static_cast<std::size_t>(chunk_count_++)] =
          makeSignedPixel(row_offset + end / 8, end % 8, false);
      chunk_[static_cast<std::size_t>(chunk_count_++)] =
          makeSignedPixel(row_offset + begin / 8, begin % 8, true);
      ++chunk_negatives_;
    });
  }
  addRunEnds(rows, words);
  for (int x = 0; x < kLanes * words; ++x) {
    const std::size_t at = static_cast<std::size_t>((x & ~(kLanes - 1)) + laneIndex(x & 63));
    counts_[at] = count;
    count += differences_[at];
  }
  updateLeast(words);
}

}  // namespace boresight
