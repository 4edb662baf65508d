// SPDX-License-Identifier: Apache-2.0
#include "core/match/mask_counts.h"

#include <algorithm>
#include <bit>
#include <cstddef>
#include <limits>

#include "core/base/nth.h"
#include "core/match/pixel_words.h"
#include "core/match/template_bits.h"

namespace boresight {
namespace {

constexpr int kMaxSingles = 4096;
// Prefix sums over 64 offsets of run ends must stay below 65536 (planesToPrefixSums).
constexpr int kMaxRunEnds = 1020;
constexpr int kChunk = 1020;
// Changes of a count are 16-bit integers.
constexpr int kMaxBorderPixels = 32767;
constexpr int kBorderPlanes = 13;
constexpr int kMostRowWords = kMaxTemplateWords + 1;
/// Words of a row of the mask in which runs may begin and end (at column `side`).
int rowWords(int side) { return side / 64 + 1; }

/// Calls f(u) for every column u = 0 ... side where a row of bits differs from its left neighbour.
template <class Function>
void forEachChange(const std::uint64_t* bits, int words, Function f) {
  std::uint64_t left = 0;
  for (int word = 0; word < words; ++word) {
    std::uint64_t change = bits[word] ^ ((bits[word] << 1) | left);
    left = bits[word] >> 63;
    for (; change != 0; change &= change - 1) f(64 * word + std::countr_zero(change));
  }
}

/// Calls f(begin, end) for every run of ones.
template <class Function>
void forEachRun(const std::uint64_t* bits, int words, Function f) {
  int begin = -1;
  forEachChange(bits, words, [&](int u) {
    if (begin < 0) {
      begin = u;
    } else {
      f(begin, u);
      begin = -1;
    }
  });
}

void maskRow(const TemplateView& view, int v, std::uint64_t* bits) {
  for (int word = 0; word < rowWords(view.side_px); ++word) bits[word] = maskWord(view, v, word);
}

/// Ones among pixels begin ... end - 1 of a byte-ordered row.
int onesBetween(const std::uint8_t* row, int begin, int end) {
  int ones = 0;
  for (int word = begin >> 6; 64 * word < end; ++word) {
    std::uint64_t bits = byteOrdered(loadWord(row + std::ptrdiff_t{8} * word));
    bits &= sideMask(end, word) & ~sideMask(begin, word);
    ones += countOnes(bits);
  }
  return ones;
}

int padPixels(std::span<SignedPixel> pixels, int count, int zero_offset) {
  int end = count;
  for (; end % kPixelGroup != 0; ++end) {
    nth(pixels, end) = makeSignedPixel(zero_offset, 0, false);
  }
  return end;
}

CounterRow allocatePlanes(int words, Arena& arena) {
  const auto count = static_cast<std::size_t>(kBorderPlanes * words);
  return {arena.allocate<std::uint64_t>(count).data(), words};
}

}  // namespace

void MaskCounts::create(int max_words, const BitKernels& kernels, Arena& arena) {
  kernels_ = &kernels;
  const std::size_t offsets = static_cast<std::size_t>(lanesBefore(max_words));
  singles_ = arena.allocate<SignedPixel>(kMaxSingles + kPixelGroup);
  run_ends_ = arena.allocate<SignedPixel>(kMaxRunEnds + kPixelGroup);
  runs_ = arena.allocate<Run>(kMaxRunEnds / 2);
  chunk_ = arena.allocate<SignedPixel>(kChunk + kPixelGroup);
  single_planes_ = allocatePlanes(max_words, arena);
  run_planes_ = allocatePlanes(max_words, arena);
  differences_ = arena.allocate<std::int32_t>(offsets);
  under_singles_ = arena.allocate<std::uint16_t>(offsets);
  under_runs_ = arena.allocate<std::uint16_t>(offsets);
  run_totals_ = arena.allocate<std::uint32_t>(max_words);
  counts_ = arena.allocate<std::int32_t>(offsets);
  small_counts_ = arena.allocate<std::int16_t>(offsets);
  least_ = arena.allocate<std::int32_t>(max_words);
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
  int mask_pixels = 0;
  const int words = rowWords(view.side_px);
  std::uint64_t above[kMostRowWords] = {}, below[kMostRowWords] = {};
  for (int v = 0; v <= view.side_px; ++v) {
    if (v < view.side_px) {
      maskRow(view, v, below);
      for (const std::uint64_t word : below) mask_pixels += countOnes(word);
      forEachChange(below, words, [this](int) { ++row_end_count_; });
    } else {
      for (std::uint64_t& word : below) word = 0;
    }
    if (!too_many_borders_) listBorders(v, above, below);
    for (int word = 0; word < words; ++word) above[word] = below[word];
  }
  padPixels(singles_, single_count_, zero_offset_);
  padPixels(run_ends_, run_end_count_, zero_offset_);
  is_small_ = mask_pixels <= std::numeric_limits<std::int16_t>::max();
  for (int x = 0; x < kLanes; ++x) {
    nth(slope_of_lane_, laneIndex(x)) = static_cast<std::uint16_t>(run_end_negatives_ * x);
  }
  // Borders that do not occur stay zero.
  std::fill(under_singles_.begin(), under_singles_.end(), std::uint16_t{0});
  std::fill(under_runs_.begin(), under_runs_.end(), std::uint16_t{0});
  std::fill(run_totals_.begin(), run_totals_.end(), std::uint32_t{0});
}

/// The borders between rows v - 1 and v of the mask; both are counted at row v.
void MaskCounts::listBorders(int v, const std::uint64_t* above, const std::uint64_t* below) {
  const int words = rowWords(view_.side_px);
  std::uint64_t left[kMostRowWords], entered[kMostRowWords], changed = 0;
  for (int word = 0; word < words; ++word) {
    entered[word] = above[word] & ~below[word];
    left[word] = below[word] & ~above[word];
    changed |= entered[word] | left[word];
  }
  if (changed == 0) return;
  forEachRun(entered, words, [&](int begin, int end) { addBorder(v, begin, end, 1); });
  forEachRun(left, words, [&](int begin, int end) { addBorder(v, begin, end, -1); });
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
      nth(singles_, single_count_++) = makeSignedPixel(v * stride_ + u / 8, u % 8, sign < 0);
      if (sign < 0) ++single_negatives_;
    }
    return;
  }
  // From x to x + 1 the run gains pixel x + end and loses pixel x + begin.
  nth(runs_, run_count_++) = Run{static_cast<std::int16_t>(v), static_cast<std::int16_t>(begin),
                                 static_cast<std::int16_t>(end), static_cast<std::int16_t>(sign)};
  nth(run_ends_, run_end_count_++) = makeSignedPixel(v * stride_ + end / 8, end % 8, sign < 0);
  nth(run_ends_, run_end_count_++) = makeSignedPixel(v * stride_ + begin / 8, begin % 8, sign > 0);
  ++run_end_negatives_;
}

int MaskCounts::work() const {
  return too_many_borders_ ? row_end_count_ : single_count_ + run_end_count_;
}

int MaskCounts::runSum(const TestBand& band, const std::uint8_t* rows) const {
  int sum = 0;
  for (int k = 0; k < run_count_; ++k) {
    const Run& run = nth(runs_, k);
    sum += run.sign * onesBetween(rows + std::ptrdiff_t{band.stride()} * run.v, run.begin, run.end);
  }
  return sum;
}

void MaskCounts::advanceRow(const TestBand& band, const std::uint8_t* rows, int words) {
  if (too_many_borders_) {
    computeRow(band, rows + band.stride(), words);
    return;
  }
  if (single_count_ > 0) {
    single_planes_.plane_count = planesFor(single_count_);
    kernels_->countSignedPixels(rows, singles_.data(), paddedPixels(single_count_), words,
                                single_planes_);
    kernels_->planesToLanes(single_planes_, words, under_singles_.data());
  }
  if (run_end_count_ > 0) {
    run_planes_.plane_count = planesFor(run_end_count_);
    kernels_->countSignedPixels(rows, run_ends_.data(), paddedPixels(run_end_count_), words,
                                run_planes_);
    kernels_->planesToPrefixSums(run_planes_, words, under_runs_.data(), run_totals_.data());
  }
  int run_sum = runSum(band, rows);
  for (int word = 0; word < words; ++word) {
    const std::uint16_t* singles = under_singles_.data() + lanesBefore(word);
    const std::uint16_t* runs = under_runs_.data() + lanesBefore(word);
    const std::uint16_t constant = static_cast<std::uint16_t>(run_sum - single_negatives_);
    if (is_small_) {
      applyChanges(word, singles, runs, constant, small_counts_.data() + lanesBefore(word));
    } else {
      applyChanges(word, singles, runs, constant, counts_.data() + lanesBefore(word));
    }
    run_sum += static_cast<int>(nth(run_totals_, word)) - kLanes * run_end_negatives_;
  }
}

/// counts[x] += constant + singles[x] + runs[x] - slope x, all modulo 2^16: the change lies within
/// +-kMaxBorderPixels.
template <class Count>
void MaskCounts::applyChanges(int word, const std::uint16_t* singles, const std::uint16_t* runs,
                              std::uint16_t constant, Count* counts) {
  Count least = std::numeric_limits<Count>::max();
  for (std::size_t i = 0; i < kLanes; ++i) {
    const std::uint16_t change =
        static_cast<std::uint16_t>(constant + singles[i] + runs[i] - slope_of_lane_[i]);
    const Count count = static_cast<Count>(counts[i] + static_cast<std::int16_t>(change));
    counts[i] = count;
    least = std::min(least, count);
  }
  nth(least_, word) = least;
}

/// Adds the chunk of run ends to the differences between neighbouring offsets and empties it.
void MaskCounts::addRunEnds(const std::uint8_t* rows, int words) {
  const int count = padPixels(chunk_, chunk_count_, zero_offset_);
  run_planes_.plane_count = planesFor(chunk_count_);
  kernels_->countSignedPixels(rows, chunk_.data(), count, words, run_planes_);
  kernels_->planesToLanes(run_planes_, words, under_runs_.data());
  for (std::size_t i = 0; i < static_cast<std::size_t>(lanesBefore(words)); ++i) {
    differences_[i] += under_runs_[i] - chunk_negatives_;
  }
  chunk_count_ = chunk_negatives_ = 0;
}

void MaskCounts::computeRow(const TestBand& band, const std::uint8_t* rows, int words) {
  for (std::int32_t& difference : differences_) difference = 0;
  chunk_count_ = chunk_negatives_ = 0;
  std::int32_t count = 0;
  for (int v = 0; v < view_.side_px; ++v) {
    std::uint64_t mask[kMostRowWords];
    maskRow(view_, v, mask);
    const int row_offset = v * band.stride();
    forEachRun(mask, rowWords(view_.side_px), [&](int begin, int end) {
      count += onesBetween(rows + row_offset, begin, end);
      if (chunk_count_ + 2 > kChunk) addRunEnds(rows, words);
      nth(chunk_, chunk_count_++) = makeSignedPixel(row_offset + end / 8, end % 8, false);
      nth(chunk_, chunk_count_++) = makeSignedPixel(row_offset + begin / 8, begin % 8, true);
      ++chunk_negatives_;
    });
  }
  addRunEnds(rows, words);
  std::fill(under_runs_.begin(), under_runs_.end(), std::uint16_t{0});  // borrowed by addRunEnds
  for (int word = 0; word < words; ++word) {
    std::int32_t least = count;
    for (int bit = 0; bit < kLanes; ++bit) {
      const std::size_t at = static_cast<std::size_t>(lanesBefore(word) + laneIndex(bit));
      if (is_small_) {
        small_counts_[at] = static_cast<std::int16_t>(count);
      } else {
        counts_[at] = count;
      }
      least = std::min(least, count);
      count += differences_[at];
    }
    nth(least_, word) = least;
  }
}

}  // namespace boresight
