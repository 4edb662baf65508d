// SPDX-License-Identifier: Apache-2.0
#include "core/edges/equalize.h"

#include <algorithm>
#include <bit>

#include "core/base/nth.h"
#include "core/edges/border.h"

namespace boresight {
namespace {

/// Nearest integer of a value in [0, 255] or just above, halves to even: adding 1.5 * 2^23 leaves
/// no fraction bits, so the addition itself rounds as IEEE prescribes.
inline std::uint8_t roundToGray(float value) {
  const std::int32_t rounded = std::bit_cast<std::int32_t>(value + 12582912.0F) & 0x1FF;
  return static_cast<std::uint8_t>(rounded > 255 ? 255 : rounded);
}

GrayTable identityTable() {
  GrayTable table;
  for (int level = 0; level < kGrayLevels; ++level)
    nth(table, level) = static_cast<std::uint8_t>(level);
  return table;
}

std::int32_t total(const GrayHistogram& histogram) {
  std::int32_t sum = 0;
  for (const std::int32_t count : histogram) sum += count;
  return sum;
}

/// Fills a table from a level on: scaled counts up to each level.
void fillTable(const GrayHistogram& histogram, std::size_t first, float scale, GrayTable& table) {
  std::int32_t sum = 0;
  for (std::size_t level = first; level < table.size(); ++level) {
    sum += histogram[level];
    table[level] = roundToGray(static_cast<float>(sum) * scale);
  }
}

/// The excess over `limit` per level is distributed evenly; the remainder goes to every n-th level.
void clip(GrayHistogram& histogram, std::int32_t limit) {
  std::int32_t clipped = 0;
  for (std::int32_t& count : histogram) {
    clipped += std::max(count - limit, 0);
    count = std::min(count, limit);
  }
  const std::int32_t batch = clipped / kGrayLevels;
  for (std::int32_t& count : histogram) count += batch;
  std::int32_t residual = clipped % kGrayLevels;
  if (residual == 0) return;
  const std::int32_t stride = std::max(kGrayLevels / residual, 1);
  for (std::int32_t level = 0; level < kGrayLevels && residual > 0; level += stride, --residual)
    ++nth(histogram, level);
}

/// Floor and fraction of the position, in tiles, between the centres of neighbouring tiles.
struct TilePosition {
  int before;
  int after;
  float weight_after;
};

TilePosition tilePosition(int pixel, float inverse_tile_size, int tiles) {
  const float position = static_cast<float>(pixel) * inverse_tile_size - 0.5F;
  int before = static_cast<int>(position);
  if (static_cast<float>(before) > position) --before;
  return {std::max(before, 0), std::min(before + 1, tiles - 1),
          position - static_cast<float>(before)};
}

/// Gray levels of a block of pixels by the tables of the four tiles around each.
struct TileCorners {
  std::uint8_t above_left[kRowBlock];
  std::uint8_t above_right[kRowBlock];
  std::uint8_t below_left[kRowBlock];
  std::uint8_t below_right[kRowBlock];
};

/// The order of the single-precision operations is OpenCV's; another one rounds differently.
/// Inlined, the promise that `out` overlaps nothing gets lost, and with it the vector code.
[[gnu::noinline]] void interpolate(const TileCorners& corners, const float* weight_right,
                                   float weight_below, std::uint8_t* __restrict out) {
  const float weight_above = 1.0F - weight_below;
  for (int i = 0; i < kRowBlock; ++i) {
    const float right = weight_right[i];
    const float left = 1.0F - right;
    out[i] = roundToGray((static_cast<float>(corners.above_left[i]) * left +
                          static_cast<float>(corners.above_right[i]) * right) *
                             weight_above +
                         (static_cast<float>(corners.below_left[i]) * left +
                          static_cast<float>(corners.below_right[i]) * right) *
                             weight_below);
  }
}

}  // namespace

GrayTable equalizeLut(const GrayHistogram& histogram) {
  const std::int32_t all = total(histogram);
  if (all == 0) return identityTable();
  std::size_t level = 0;
  while (histogram[level] == 0) ++level;
  GrayTable table{};
  if (histogram[level] == all) {
    table.fill(static_cast<std::uint8_t>(level));
    return table;
  }
  fillTable(histogram, level + 1, 255.0F / static_cast<float>(all - histogram[level]), table);
  return table;
}

GrayTable claheLut(const GrayHistogram& histogram) {
  const std::int32_t all = total(histogram);
  if (all == 0) return identityTable();
  GrayHistogram clipped = histogram;
  const double limit = Equalizer::kClipLimit * all / kGrayLevels;
  clip(clipped, std::max(static_cast<std::int32_t>(limit), 1));
  GrayTable table{};
  fillTable(clipped, 0, 255.0F / static_cast<float>(all), table);
  return table;
}

void Equalizer::begin(const ImageView& image, const BitImage* ignore, const EdgeOptions& options,
                      Arena& arena) {
  *this = Equalizer();
  image_ = image;
  ignore_ = ignore;
  equalization_ = options.equalization;
  if (equalization_ == Equalization::kOff) return;
  if (equalization_ == Equalization::kClahe) tiles_ = kTiles;
  counts_ = arena.allocate<std::int32_t>(std::size_t{kLanes} * kGrayLevels);
  tables_ = arena.allocate<std::uint8_t>(static_cast<std::size_t>(tiles_) *
                                         static_cast<std::size_t>(tiles_) * kGrayLevels);
  if (equalization_ == Equalization::kClahe) beginTiles(arena);
}

/// When a side is not divisible by the number of tiles, OpenCV extends *both* sides to the next
/// multiple (a divisible side by a whole tile), mirrored.
void Equalizer::beginTiles(Arena& arena) {
  tile_width_ = image_.width / tiles_;
  tile_height_ = image_.height / tiles_;
  if (image_.width % tiles_ != 0 || image_.height % tiles_ != 0) {
    ++tile_width_;
    ++tile_height_;
  }
  const std::size_t columns = static_cast<std::size_t>(roundUpToBlock(image_.width));
  left_table_ = arena.allocate<std::int32_t>(columns);
  right_table_ = arena.allocate<std::int32_t>(columns);
  right_weight_ = arena.allocate<float>(columns);
  if (!right_weight_.empty()) placeColumns();
}

void Equalizer::placeColumns() {
  const float inverse_tile_width = 1.0F / static_cast<float>(tile_width_);
  for (int x = 0; x < image_.width; ++x) {
    const TilePosition position = tilePosition(x, inverse_tile_width, tiles_);
    const std::size_t column = static_cast<std::size_t>(x);
    left_table_[column] = position.before * kGrayLevels;
    right_table_[column] = position.after * kGrayLevels;
    right_weight_[column] = position.weight_after;
  }
}

bool Equalizer::step(std::int32_t pixel_budget) {
  if (equalization_ == Equalization::kOff) return true;
  return equalization_ == Equalization::kHistogram ? stepGlobal(pixel_budget)
                                                   : stepTiles(pixel_budget);
}

bool Equalizer::stepGlobal(std::int32_t pixel_budget) {
  for (; row_ < image_.height && pixel_budget > 0; ++row_, pixel_budget -= image_.width)
    countRow(row_, 0, image_.width);
  if (row_ < image_.height) return false;
  const GrayTable table = equalizeLut(takeHistogram());
  std::copy(table.begin(), table.end(), tables_.begin());
  return true;
}

bool Equalizer::stepTiles(std::int32_t pixel_budget) {
  while (tile_ < tiles_ * tiles_ && pixel_budget > 0) {
    const int left = tile_ % tiles_ * tile_width_;
    const int right = left + tile_width_;
    const int inside = std::clamp(image_.width, left, right);
    const int top = tile_ / tiles_ * tile_height_;
    for (; row_ < tile_height_ && pixel_budget > 0; ++row_, pixel_budget -= tile_width_) {
      const int source_y = reflect101(top + row_, image_.height);
      countRow(source_y, left, inside);
      countReflected(source_y, inside, right);
    }
    if (row_ < tile_height_) return false;
    const GrayTable table = claheLut(takeHistogram());
    std::copy(table.begin(), table.end(), tables_.begin() + std::ptrdiff_t{tile_} * kGrayLevels);
    pixel_budget -= kGrayLevels;
    row_ = 0;
    ++tile_;
  }
  return tile_ == tiles_ * tiles_;
}

void Equalizer::countRow(int source_y, int first_x, int last_x) {
  const std::uint8_t* pixels = image_.row(source_y);
  const std::uint64_t* ignored = ignore_ != nullptr ? ignore_->row(source_y) : nullptr;
  std::int32_t* counts = counts_.data();
  for (int x = first_x; x < last_x;) {
    const int word_end = ignored != nullptr ? std::min((x | 63) + 1, last_x) : last_x;
    if (ignored != nullptr && ignored[x >> 6] != 0) {
      for (; x < word_end; ++x)
        if (((ignored[x >> 6] >> (x & 63)) & 1U) == 0) ++counts[pixels[x]];
      continue;
    }
    for (; x + kLanes <= word_end; x += kLanes)
#pragma GCC unroll 4
      for (int lane = 0; lane < kLanes; ++lane) ++counts[lane * kGrayLevels + pixels[x + lane]];
    for (; x < word_end; ++x) ++counts[pixels[x]];
  }
}

void Equalizer::countReflected(int source_y, int first_x, int last_x) {
  for (int x = first_x; x < last_x; ++x) {
    const int source_x = reflect101(x, image_.width);
    countRow(source_y, source_x, source_x + 1);
  }
}

GrayHistogram Equalizer::takeHistogram() {
  GrayHistogram histogram{};
  for (std::size_t i = 0; i < counts_.size(); ++i) {
    histogram[i % kGrayLevels] += counts_[i];
    counts_[i] = 0;
  }
  return histogram;
}

void Equalizer::row(int y, std::uint8_t* __restrict out) const {
  const std::uint8_t* pixels = image_.row(y);
  if (equalization_ == Equalization::kOff) {
    std::copy(pixels, pixels + image_.width, out);
  } else if (equalization_ == Equalization::kHistogram) {
    const std::uint8_t* table = tables_.data();
#pragma GCC unroll 8
    for (int x = 0; x < image_.width; ++x) out[x] = table[pixels[x]];
  } else {
    rowByTiles(y, out);
  }
}

void Equalizer::rowByTiles(int y, std::uint8_t* __restrict out) const {
  const std::uint8_t* pixels = image_.row(y);
  const TilePosition vertical = tilePosition(y, 1.0F / static_cast<float>(tile_height_), tiles_);
  const std::uint8_t* above =
      tables_.data() + std::ptrdiff_t{vertical.before} * tiles_ * kGrayLevels;
  const std::uint8_t* below =
      tables_.data() + std::ptrdiff_t{vertical.after} * tiles_ * kGrayLevels;
  TileCorners corners{};
  for (int first_x = 0; first_x < image_.width; first_x += kRowBlock) {
    const int count = std::min(image_.width - first_x, kRowBlock);
    const std::int32_t* left_table = left_table_.data() + first_x;
    const std::int32_t* right_table = right_table_.data() + first_x;
    for (int i = 0; i < count; ++i) {
      const int left = left_table[i] + pixels[first_x + i];
      const int right = right_table[i] + pixels[first_x + i];
      corners.above_left[i] = above[left];
      corners.above_right[i] = above[right];
      corners.below_left[i] = below[left];
      corners.below_right[i] = below[right];
    }
    std::uint8_t block[kRowBlock];
    interpolate(corners, right_weight_.data() + first_x, vertical.weight_after, block);
    std::copy(block, block + count, out + first_x);
  }
}

}  // namespace boresight
