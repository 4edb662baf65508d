// SPDX-License-Identifier: Apache-2.0
#include "core/match/column_search.h"

#include <algorithm>
#include <bit>
#include <cstddef>
#include <cstring>

#include "core/match/bit_rows.h"
#include "core/match/template_bits.h"

namespace boresight {
namespace {

constexpr int kGroup = 4;
constexpr int kMostRows = ColumnKernels::kMostRows;
constexpr int kBandRows = 320;
constexpr int kShiftedWords = 12288;  ///< 96 KiB
constexpr int kEdgeCapacity = 6144;
constexpr int kBorderCapacity = 8192;
constexpr int kMostChunks = ColumnSearch::kMaxSide_px / kGroup;
constexpr int kOffsetCapacity = kEdgeCapacity + kBorderCapacity + 3 * kGroup * kMostChunks;
constexpr int kLanePlanes = 16;
// Counts under a mask are kept modulo 2^16.
constexpr int kMostMaskPixels = 65536;

int roundedUp(int count, int unit) { return (count + unit - 1) / unit * unit; }

/// Words of a column of the mask, and of the row below its last.
int columnWords(int side) { return side / 64 + 1; }

/// Word columns of the image in which `side` + 64 pixels from any bit on lie.
int alignedColumns(int side) { return (side + 63) / 64 + 2; }

int strideFor(int side, int rows) { return roundedUp(side + roundedUp(rows, kMostRows), 8); }

/// Transposes a 64 x 64 bit matrix: bit i of word k becomes bit k of word i.
void transpose64(std::uint64_t* rows) {
  std::uint64_t mask = 0x00000000ffffffffu;
  for (int shift = 32; shift != 0; shift >>= 1, mask ^= mask << shift) {
    for (int k = 0; k < 64; k = ((k | shift) + 1) & ~shift) {
      const std::uint64_t difference = ((rows[k] >> shift) ^ rows[k | shift]) & mask;
      rows[k] ^= difference << shift;
      rows[k | shift] ^= difference;
    }
  }
}

std::int32_t counterAt(const CounterRow& counters, int word, int bit) {
  std::int32_t count = 0;
  for (int k = 0; k < counters.plane_count; ++k) {
    count |= static_cast<std::int32_t>((counters.plane(k)[word] >> bit) & 1u) << k;
  }
  return count;
}

void allocatePlanes(int planes, int words, Arena& arena, CounterRow& row) {
  row.words = arena
                  .allocate<std::uint64_t>(static_cast<std::size_t>(planes) *
                                           static_cast<std::size_t>(words))
                  .data();
  row.stride = words;
}

void clear(CounterRow& counters, int words) {
  for (int k = 0; k < counters.plane_count; ++k)
    std::fill_n(counters.plane(k), words, std::uint64_t{0});
}

}  // namespace

void ColumnSearch::create(int max_side_px, const ColumnKernels* kernels, Arena& arena) {
  kernels_ = kernels;
  max_side_px_ = std::min(max_side_px, kMaxSide_px);
  if (kernels == nullptr) return;
  const int side = max_side_px_;
  const auto words = [&arena](int count) {
    return arena.allocate<std::uint64_t>(static_cast<std::size_t>(count));
  };
  mask_columns_ = words(roundedUp(side, 64) * columnWords(side));
  edge_columns_ = words(roundedUp(side, 64) * columnWords(side));
  offsets_ = arena.allocate<std::int32_t>(kOffsetCapacity);
  chunks_ = arena.allocate<Chunk>(kMostChunks);
  aligned_ = words(alignedColumns(side) * strideFor(side, kBandRows));
  shifted_ = words(kShiftedWords + kBandRows + 2 * kMostRows);
  const int rows = kBandRows + kMostRows;
  allocatePlanes(planesFor(kEdgeCapacity), rows, arena, hits_);
  allocatePlanes(kLanePlanes, rows, arena, changes_);
  allocatePlanes(kLanePlanes, kMostRows, arena, first_row_);
  counts_ = words(ColumnKernels::kLaneWords * rows);
  least_ = arena.allocate<std::uint16_t>(static_cast<std::size_t>(rows));
  lanes_ = arena.allocate<std::uint16_t>(static_cast<std::size_t>(kLanes * kMostRows));
}

bool ColumnSearch::begin(const TemplateView& view, const BitImage& test_edges,
                         const SearchWindow& window) {
  if (kernels_ == nullptr || view.side_px > max_side_px_) return false;
  side_ = view.side_px;
  test_edges_ = &test_edges;
  window_ = window;
  // Bands of about the same height: each shifts the columns of its own rows and of `side` more.
  const int bands = (window.height() + kBandRows - 1) / kBandRows;
  band_rows_ = roundedUp((window.height() + bands - 1) / bands, kMostRows);
  stride_ = strideFor(side_, band_rows_);
  transpose(view);
  if (!listPixels()) return false;
  std::fill_n(shifted_.begin() + kShiftedWords, kBandRows + 2 * kMostRows, std::uint64_t{0});
  tile_x_ = row_ = 0;
  return true;
}

/// Columns of the template's mask and masked edges.
void ColumnSearch::transpose(const TemplateView& view) {
  mask_stride_ = columnWords(side_);
  norms_ = WhsNorms{};
  const auto store = [this](const std::uint64_t* rows, int block, int word,
                            std::span<std::uint64_t> columns) {
    for (int u = 0; u < 64; ++u) {
      columns[static_cast<std::size_t>((64 * block + u) * mask_stride_ + word)] = rows[u];
    }
  };
  for (int block = 0; 64 * block < side_; ++block) {
    for (int word = 0; word < mask_stride_; ++word) {
      std::uint64_t mask[64] = {}, edges[64] = {};
      const int rows = std::min(64, side_ - 64 * word);
      for (int k = 0; k < rows; ++k) {
        mask[k] = maskWord(view, 64 * word + k, block);
        const int half = side_ / 2;
        edges[k] = mask[k] & pixelsAt(*view.edges, view.center_x - half + 64 * block,
                                      view.center_y - half + 64 * word + k);
        norms_.edges += countOnes(edges[k]);
        norms_.empties += countOnes(mask[k] & ~edges[k]);
      }
      if (rows > 0) {
        transpose64(mask);
        transpose64(edges);
      }
      store(mask, block, word, mask_columns_);
      store(edges, block, word, edge_columns_);
    }
  }
}

bool ColumnSearch::listPixels() {
  const int mask_pixels = norms_.edges + norms_.empties;
  // A count of 2^16 looks like none, which the hits then tell apart.
  if (norms_.edges > kEdgeCapacity || mask_pixels > kMostMaskPixels ||
      (mask_pixels == kMostMaskPixels && norms_.edges == 0)) {
    return false;
  }
  const int columns = kShiftedWords / stride_ / kGroup * kGroup;
  chunk_count_ = offset_count_ = 0;
  change_constant_ = 0;
  int entering = 0;
  for (int u = 0; u < side_; u += columns) {
    Chunk& chunk = chunks_[static_cast<std::size_t>(chunk_count_++)];
    chunk.first_column = u;
    chunk.columns = std::min(columns, side_ - u);
    if (!listChunk(chunk)) return false;
    entering += chunk.entering.count;
  }
  hits_.plane_count = planesFor(norms_.edges);
  changes_.plane_count = std::min(planesFor(entering + change_constant_), kLanePlanes);
  return true;
}

bool ColumnSearch::listChunk(Chunk& chunk) {
  const int capacity = static_cast<int>(offsets_.size());
  const auto list = [&](List& made, auto bitsOf) {
    made.first = offset_count_;
    for (int c = 0; c < chunk.columns; ++c) {
      for (int word = 0; word < mask_stride_; ++word) {
        const std::size_t at =
            static_cast<std::size_t>((chunk.first_column + c) * mask_stride_ + word);
        std::uint64_t bits = bitsOf(at, word);
        if (offset_count_ + countOnes(bits) + kGroup > capacity) return false;
        const int offset = c * stride_ + 64 * word;
        for (; bits != 0; bits &= bits - 1) {
          offsets_[static_cast<std::size_t>(offset_count_++)] = offset + std::countr_zero(bits);
        }
      }
    }
    made.count = offset_count_ - made.first;
    made.plane_count = planesFor(made.count);
    for (; made.count % kGroup != 0; ++made.count) {
      offsets_[static_cast<std::size_t>(offset_count_++)] = kShiftedWords;
    }
    return true;
  };
  // Bit v: row v - 1 of the mask.
  const auto above = [this](std::size_t at, int word) {
    return (mask_columns_[at] << 1) | (word > 0 ? mask_columns_[at - 1] >> 63 : 0);
  };
  if (!list(chunk.edges, [this](std::size_t at, int) { return edge_columns_[at]; })) return false;
  const auto entering = [&](std::size_t at, int word) {
    return above(at, word) & ~mask_columns_[at];
  };
  const auto leaving = [&](std::size_t at, int word) {
    return mask_columns_[at] & ~above(at, word);
  };
  if (!list(chunk.entering, entering) || !list(chunk.leaving, leaving)) return false;
  if (chunk.leaving.count > 0) change_constant_ += (1 << chunk.leaving.plane_count) - 1;
  return true;
}

std::int64_t ColumnSearch::workOfBand() const {
  const int registers = band_rows_ / kernels_->rows;
  return (std::int64_t{offset_count_} + side_ * 8) * registers;
}

bool ColumnSearch::searchBand(PeakTable& peaks) {
  tile_width_ = std::min(kTileColumns, window_.width() - tile_x_);
  rows_ = std::min(band_rows_, window_.height() - row_);
  loadBand();
  const int words = roundedUp(rows_, kMostRows);
  clear(hits_, words);
  clear(changes_, words);
  first_row_.plane_count = kLanePlanes;
  if (row_ == 0) clear(first_row_, kMostRows);
  for (int k = 0; k < chunk_count_; ++k) countChunk(chunks_[static_cast<std::size_t>(k)]);
  if (row_ == 0) sumFirstRow();
  kernels_->integrate(changes_, rows_, static_cast<std::uint16_t>(change_constant_),
                      first_counts_.data(), counts_.data(), least_.data());
  offerLargest(peaks);
  offerRest(peaks);
  return !nextBand();
}

bool ColumnSearch::nextBand() {
  row_ += rows_;
  if (row_ < window_.height()) return true;
  row_ = 0;
  tile_x_ += tile_width_;
  return tile_x_ < window_.width();
}

/// Copies the words of the image that the band looks at, column by column.
void ColumnSearch::loadBand() {
  const BitImage& image = *test_edges_;
  const int half = side_ / 2;
  const int first_word = (window_.x_min - half + tile_x_) / 64;
  const int first_row = window_.y_min - half + row_;
  const int columns = alignedColumns(side_);
  const int existing = std::clamp(image.words_per_row - first_word, 0, columns);
  const int rows = std::min(stride_, image.height - first_row);
  for (int r = 0; r < rows; ++r) {
    const std::uint64_t* words = image.row(first_row + r) + first_word;
    std::uint64_t* to = aligned_.data() + r;
    for (int i = 0; i < existing; ++i) to[std::ptrdiff_t{stride_} * i] = words[i];
  }
  for (int i = 0; i < columns; ++i) {
    const int from = i < existing ? rows : 0;
    std::fill_n(aligned_.data() + std::ptrdiff_t{stride_} * i + from, stride_ - from,
                std::uint64_t{0});
  }
}

void ColumnSearch::countChunk(const Chunk& chunk) {
  const int first_bit = (window_.x_min - side_ / 2 + tile_x_) % 64;
  for (int c = 0; c < chunk.columns; ++c) {
    const int bit = first_bit + chunk.first_column + c;
    const std::uint64_t* left = aligned_.data() + std::ptrdiff_t{stride_} * (bit / 64);
    kernels_->shiftColumn(left, left + stride_, bit % 64, stride_,
                          shifted_.data() + std::ptrdiff_t{stride_} * c);
  }
  const auto add = [this](const List& list, bool negative, CounterRow& total) {
    if (list.count == 0) return;
    kernels_->addPixels(shifted_.data(), offsets_.data() + list.first, list.count, list.plane_count,
                        rows_, negative, total);
  };
  add(chunk.edges, false, hits_);
  add(chunk.entering, false, changes_);
  add(chunk.leaving, true, changes_);
  if (row_ > 0) return;
  const int columns = roundedUp(chunk.columns, kGroup);
  const int registers = (side_ + kernels_->rows - 1) / kernels_->rows;
  kernels_->addMasked(shifted_.data(), stride_,
                      mask_columns_.data() + std::ptrdiff_t{mask_stride_} * chunk.first_column,
                      mask_stride_, columns, side_, planesFor(columns * registers), first_row_);
}

/// The first row's counts under the mask, from those of the rows of a register.
void ColumnSearch::sumFirstRow() {
  bitKernels(Kernels::kPortable).planesToLanes(first_row_, kernels_->rows, lanes_.data());
  std::uint16_t sums[kLanes] = {};
  for (int r = 0; r < kernels_->rows; ++r) {
    const std::uint16_t* lanes = lanes_.data() + lanesBefore(r);
    for (int i = 0; i < kLanes; ++i) sums[i] = static_cast<std::uint16_t>(sums[i] + lanes[i]);
  }
  std::memcpy(first_counts_.data(), sums, sizeof sums);
}

/// Offers an offset with the most hits of each register's rows: good ones to begin with let the
/// table drop most others unseen.
void ColumnSearch::offerLargest(PeakTable& peaks) {
  for (int row = 0; row < rows_; row += kernels_->rows) {
    std::uint64_t mask[kMostRows] = {}, found[kMostRows];
    const int rows = std::min(kernels_->rows, rows_ - row);
    std::fill_n(mask, rows, sideMask(tile_width_, 0));
    kernels_->largest(hits_, row, mask, found);
    int y = 0;
    while (found[y] == 0) ++y;
    for (int i = 0; i < kMostRows; ++i) {
      if (i != y) found[i] = 0;
    }
    found[y] &= ~found[y] + 1;
    offerFound(row, found, peaks);
  }
}

void ColumnSearch::offerRest(PeakTable& peaks) {
  for (int row = 0; row < rows_; row += kernels_->rows) {
    const std::int32_t covered = least_[static_cast<std::size_t>(row / kernels_->rows)];
    const std::int32_t hits = peaks.leastHits(covered);
    if ((hits >> hits_.plane_count) != 0) continue;
    std::uint64_t mask[kMostRows] = {}, found[kMostRows];
    const int rows = std::min(kernels_->rows, rows_ - row);
    std::fill_n(mask, rows, sideMask(tile_width_, 0));
    if (kernels_->atLeast(hits_, row, hits, mask, found)) offerFound(row, found, peaks);
  }
}

void ColumnSearch::offerFound(int row, const std::uint64_t* found, PeakTable& peaks) {
  for (int y = 0; y < kernels_->rows; ++y) {
    for (std::uint64_t bits = found[y]; bits != 0; bits &= bits - 1) {
      const int bit = std::countr_zero(bits);
      const std::int32_t hits = counterAt(hits_, row + y, bit);
      std::uint16_t lanes[4];
      const int word = countWord(*kernels_, bit, row + y);
      std::memcpy(lanes, &counts_[static_cast<std::size_t>(word)], sizeof lanes);
      std::int32_t covered = lanes[laneIndex(bit) % 4];
      if (covered < hits) covered = kMostMaskPixels;
      peaks.offer(tile_x_ + bit, row_ + row + y, hits, covered);
    }
  }
}

}  // namespace boresight
