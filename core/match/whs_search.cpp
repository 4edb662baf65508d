// SPDX-License-Identifier: Apache-2.0
#include <algorithm>
#include <bit>
#include <cstddef>

#include "core/match/template_bits.h"
#include "core/match/whs.h"

namespace boresight {
namespace {

// A tile has eight offsets less than counters, as the last seven are not whole, and blocks of the
// peak table do not straddle tiles.
constexpr int kTileWords = 10;
constexpr int kTileOffsets = 64 * kTileWords - 8;
constexpr int kEdgeCapacity = 6144;
// Words of pixels added in a step: a few milliseconds on a workstation.
constexpr std::int64_t kStepWork = 2'000'000;
constexpr std::int64_t kRowOverhead = 200;
constexpr int kMaxWindow_px = 8192;
constexpr int kMaxExclusion_px = 8192;

int wordsFor(int bits) { return (bits + 63) / 64; }

/// Words of edge counters for a row of offsets: the last 7 counters of addPixels are not whole.
int edgeWords(int offsets) { return wordsFor(offsets + 7); }

/// Bit x is 1 where the counter x of a word of planes is at least `least`.
std::uint64_t atLeast(const CounterRow& counters, int word, std::int32_t least) {
  if ((static_cast<std::uint32_t>(least) >> counters.plane_count) != 0) return 0;
  std::uint64_t result = ~std::uint64_t{0};
  for (int k = 0; k < counters.plane_count; ++k) {
    const std::uint64_t bits = counters.plane(k)[word];
    result = ((least >> k) & 1) != 0 ? result & bits : result | bits;
  }
  return result;
}

std::int32_t counterAt(const CounterRow& counters, int word, int bit) {
  std::int32_t count = 0;
  for (int k = 0; k < counters.plane_count; ++k) {
    count |= static_cast<std::int32_t>((counters.plane(k)[word] >> bit) & 1u) << k;
  }
  return count;
}

}  // namespace

Status WhsSearch::create(int max_side_px, int max_window_px, Kernels kernels, Arena& arena) {
  if (!kernelsAvailable(kernels) || max_side_px < 2 || max_side_px > kMaxTemplateSide_px ||
      max_window_px < 1 || max_window_px > kMaxWindow_px) {
    return Status::kInvalidOption;
  }
  max_side_px_ = max_side_px;
  max_window_px_ = max_window_px;
  const int words = edgeWords(std::min(max_window_px, kTileOffsets));
  edges_.create(kEdgeCapacity, arena);
  bit_kernels_ = &bitKernels(kernels);
  covered_.create(words, *bit_kernels_, arena);
  peaks_.create(max_window_px, arena);
  band_.create(max_side_px, words, arena);
  hits_.stride = words + kWordPadding;
  hits_.words =
      arena.allocate<std::uint64_t>(kMaxPlanes * static_cast<std::size_t>(hits_.stride)).data();
  return arena.exhausted() ? Status::kArenaTooSmall : Status::kOk;
}

Status WhsSearch::begin(const TemplateView& view, const BitImage& test_edges,
                        const SearchWindow& window, int predicted_x, int predicted_y,
                        int exclusion_px) {
  done_ = true;
  peak_ = WhsPeak{};
  if (!isValidTemplate(view) || exclusion_px < 0 || window.empty()) return Status::kInvalidOption;
  if (!templateFits(view, test_edges, window.x_min, window.y_min) ||
      !templateFits(view, test_edges, window.x_max, window.y_max)) {
    return Status::kInvalidOption;
  }
  if (view.side_px > max_side_px_ || window.width() > max_window_px_ ||
      window.height() > max_window_px_) {
    return Status::kCapacityExceeded;
  }
  view_ = view;
  test_edges_ = &test_edges;
  window_ = window;
  norms_ = whsNorms(view);
  peaks_.begin(window, norms_, predicted_x, predicted_y, std::min(exclusion_px, kMaxExclusion_px));
  tile_x_ = 0;
  beginTile();
  done_ = false;
  return Status::kOk;
}

void WhsSearch::beginTile() {
  tile_width_ = std::min(window_.width() - tile_x_, kTileOffsets);
  row_ = 0;
  // The layout, and with it all byte offsets, follows the width of the tile.
  // The seven offsets lost to shifts within a byte may need one more word: only then do copies for
  // all eight shifts pay.
  const bool takes_more = edgeWords(tile_width_) > wordsFor(tile_width_);
  band_.shape(view_.side_px, edgeWords(tile_width_),
              takes_more ? TestBand::kMostCopies : TestBand::kMostCopies / 2);
  edges_are_listed_ = edges_.list(view_, band_, 0) == view_.side_px;
  covered_.begin(view_, band_);
}

bool WhsSearch::step() {
  std::int64_t work = 0;
  while (!done_ && work < kStepWork) {
    work += stepRow();
    if (done_) peak_ = peaks_.finish();
  }
  return done_;
}

/// Searches a row of offsets of a tile; returns the words of pixels added.
std::int64_t WhsSearch::stepRow() {
  const std::int64_t pixels = norms_.edges + 2 * covered_.work() + kRowOverhead;
  const std::int64_t work = pixels * wordsFor(tile_width_);
  beginRow();
  countEdges();
  searchRow();
  done_ = !nextRow();
  return work;
}

/// Loads a band where one begins, and brings the counts under the mask to this row.
void WhsSearch::beginRow() {
  const int half = view_.side_px / 2;
  const int words = wordsFor(tile_width_);
  const int row_in_band = row_ % band_.offsetRows();
  if (row_in_band == 0) {
    band_.load(*test_edges_, window_.x_min - half + tile_x_, window_.y_min - half + row_);
  }
  if (row_ == 0) covered_.computeRow(band_, band_.row(0), words);
}

/// To the next row of offsets or the next tile; false after the last.
bool WhsSearch::nextRow() {
  if (row_ + 1 < window_.height()) {
    covered_.advanceRow(band_, band_.row(row_ % band_.offsetRows()), wordsFor(tile_width_));
    ++row_;
    return true;
  }
  tile_x_ += tile_width_;
  if (tile_x_ >= window_.width()) return false;
  beginTile();
  return true;
}

void WhsSearch::countEdges() {
  const int words = band_.shifts() == 1 ? wordsFor(tile_width_) : edgeWords(tile_width_);
  const std::uint8_t* rows = band_.row(row_ % band_.offsetRows());
  hits_.plane_count = planesFor(norms_.edges);
  for (int k = 0; k < hits_.plane_count; ++k) std::fill_n(hits_.plane(k), words, std::uint64_t{0});
  int v = 0;
  do {
    v = edges_are_listed_ ? view_.side_px : edges_.list(view_, band_, v);
    for (int shift = 0; shift < band_.shifts(); ++shift) {
      const PixelList pixels = edges_.pixels(shift);
      if (pixels.count > 0) bit_kernels_->addPixels(rows, pixels, words, hits_);
    }
  } while (v < view_.side_px);
}

void WhsSearch::searchRow() {
  const int words = wordsFor(tile_width_);
  for (int word = 0; word < words; ++word) {
    const std::int32_t least = peaks_.leastHits(covered_.least(word));
    const std::uint64_t candidates = atLeast(hits_, word, least) & sideMask(tile_width_, word);
    if (candidates != 0) searchWord(word, candidates);
  }
}

void WhsSearch::searchWord(int word, std::uint64_t candidates) {
  constexpr int kFew = 6;  // transposing all 64 counters costs as much as reading out some
  const bool transpose = hits_.plane_count <= 16 && countOnes(candidates) > kFew;
  std::uint16_t lanes[kLanes];
  if (transpose) wordToLanes(hits_, word, lanes);
  const int x = tile_x_ + 64 * word;
  for (; candidates != 0; candidates &= candidates - 1) {
    const int bit = std::countr_zero(candidates);
    const std::int32_t hits = transpose ? lanes[laneIndex(bit)] : counterAt(hits_, word, bit);
    peaks_.offer(x + bit, row_, hits, covered_.count(word, bit));
  }
}

}  // namespace boresight
