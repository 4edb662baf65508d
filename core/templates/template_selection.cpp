// SPDX-License-Identifier: Apache-2.0
#include "core/templates/template_selection.h"

#include <algorithm>
#include <bit>
#include <cmath>

#include "core/base/nth.h"

namespace boresight {
namespace {

constexpr int kMaxBlocks = 256;  ///< per axis, of the summed-area table
constexpr int kMaxCells = 256;   ///< per axis, of the selection grid
constexpr double kNormalScale = 127.0;

int ceilDivide(int value, int divisor) { return (value + divisor - 1) / divisor; }

bool squareInside(int x, int y, int side_px, int width, int height) {
  const int half = side_px / 2;
  return x >= half && y >= half && x + half <= width && y + half <= height;
}

int countBits(const BitImage& image, int x_begin, int y_begin, int x_end, int y_end) {
  int count = 0;
  for (int y = y_begin; y < y_end; ++y) {
    const std::uint64_t* row = image.row(y);
    for (int x = x_begin; x < x_end;) {
      const int bit = x & 63;
      const int length = std::min(64 - bit, x_end - x);
      const std::uint64_t keep =
          length == 64 ? ~std::uint64_t{0} : (std::uint64_t{1} << length) - 1;
      count += std::popcount((row[x >> 6] >> bit) & keep);
      x += length;
    }
  }
  return count;
}

}  // namespace

int templateSide(const TemplateOptions& options, double feature_size_m, double depth_m,
                 const Camera& camera, double attempt_factor) {
  const double focal_px = 0.5 * (camera.fx + std::abs(camera.fy));
  const double wanted_px =
      options.size_factor * feature_size_m * focal_px / std::max(depth_m, 1e-6);
  const int largest =
      std::min(TemplateSelector::kMaxSide_px, std::min(camera.width, camera.height) / 4);
  int side = 8;
  // Nearest in ratio: the next power is nearer once the wanted size passes sqrt(2) times this one.
  while (side * 2 <= largest &&
         (side < TemplateSelector::kMinSide_px || wanted_px > side * 1.4142135623730951)) {
    side *= 2;
  }
  const auto most = static_cast<int>(std::bit_floor(static_cast<unsigned>(largest)));
  return std::min(static_cast<int>(attempt_factor * side), std::max(most, side));
}

TemplateSet createTemplateSet(const TemplateOptions& options, Arena& arena) {
  TemplateSet set;
  set.templates = arena.allocate<Template>(options.count);
  return set;
}

Status TemplateSelector::create(int max_width, int max_height, const TemplateOptions& options,
                                Arena& arena) {
  options_ = options;
  if (firstInvalidOption(options) != nullptr) return Status::kInvalidOption;
  const int blocks = std::min(kMaxBlocks, ceilDivide(std::max(max_width, max_height), 4)) + 1;
  sums_ = arena.allocate<Scatter>(blocks * kHeldRows);
  cells_ = arena.allocate<std::uint16_t>(kMaxCells * kMaxCells);
  best_ = arena.allocate<Best>(options.count);
  return arena.exhausted() ? Status::kArenaTooSmall : Status::kOk;
}

void TemplateSelector::beginSums(const EdgeRender& render, int side_px) {
  const int width = render.edges.width;
  const int height = render.edges.height;
  block_px_ = std::max({4, side_px / 8, ceilDivide(std::max(width, height), kMaxBlocks)});
  blocks_x_ = ceilDivide(width, block_px_);
  blocks_y_ = ceilDivide(height, block_px_);
  std::ranges::fill(sumsOf(0), Scatter{});
  summed_rows_ = 1;
}

/// Row `row` of the summed-area table: over the rows of blocks before it.
std::span<TemplateSelector::Scatter> TemplateSelector::sumsOf(int row) {
  const auto columns = static_cast<std::size_t>(blocks_x_ + 1);
  return sums_.subspan(static_cast<std::size_t>(row % kHeldRows) * columns, columns);
}

std::span<const TemplateSelector::Scatter> TemplateSelector::sumsOf(int row) const {
  const auto columns = static_cast<std::size_t>(blocks_x_ + 1);
  return sums_.subspan(static_cast<std::size_t>(row % kHeldRows) * columns, columns);
}

/// The next row of the table.
void TemplateSelector::sumRow(const EdgeRender& render) {
  const std::span<Scatter> sums = sumsOf(summed_rows_);
  const std::span<const Scatter> above = sumsOf(summed_rows_ - 1);
  std::ranges::fill(sums, Scatter{});
  const int first_y = (summed_rows_ - 1) * block_px_;
  const int end_y = std::min(first_y + block_px_, render.edges.height);
  const std::int32_t end = nth(render.row_begin, end_y);
  for (std::int32_t i = nth(render.row_begin, first_y); i < end; ++i) {
    const EdgePixel pixel = nth(render.pixels, i).unpacked(first_y);
    Scatter& block = nth(sums, pixel.x / block_px_ + 1);
    const int nx = pixel.normal_x;
    const int ny = pixel.normal_y;
    block.xx += static_cast<std::uint32_t>(nx * nx);
    block.xy += static_cast<std::uint32_t>(nx * ny);  // modulo 2^32: differences come out signed
    block.yy += static_cast<std::uint32_t>(ny * ny);
    block.count += 1;
  }
  Scatter row;
  for (std::size_t bx = 1; bx < sums.size(); ++bx) {
    Scatter& sum = sums[bx];
    row.xx += sum.xx;
    row.xy += sum.xy;
    row.yy += sum.yy;
    row.count += sum.count;
    sum = {above[bx].xx + row.xx, above[bx].xy + row.xy, above[bx].yy + row.yy,
           above[bx].count + row.count};
  }
  ++summed_rows_;
}

/// Blocks from the middle one of a square to its first and last one.
int TemplateSelector::reachOf(int side_px) const {
  return std::clamp(side_px / block_px_ / 2, 1, kMaxReach);
}

TemplateSelector::Scatter TemplateSelector::scatterAround(int x, int y, int side_px) const {
  // The square in whole blocks: centred on the pixel's block, with the number of blocks that fit
  // the side.
  const int reach = reachOf(side_px);
  const int bx0 = std::max(0, x / block_px_ - reach);
  const int by0 = std::max(0, y / block_px_ - reach);
  const int bx1 = std::min(blocks_x_, x / block_px_ + reach + 1);
  const int by1 = std::min(blocks_y_, y / block_px_ + reach + 1);
  const std::span<const Scatter> above = sumsOf(by0);
  const std::span<const Scatter> below = sumsOf(by1);
  const Scatter& a = nth(above, bx0);
  const Scatter& b = nth(above, bx1);
  const Scatter& c = nth(below, bx0);
  const Scatter& d = nth(below, bx1);
  return {d.xx - b.xx - c.xx + a.xx, d.xy - b.xy - c.xy + a.xy, d.yy - b.yy - c.yy + a.yy,
          d.count - b.count - c.count + a.count};
}

float TemplateSelector::distinctnessOf(const EdgePixel& pixel, int side_px) const {
  const Scatter scatter = scatterAround(pixel.x, pixel.y, side_px);
  if (scatter.count < std::uint32_t{kMinEdgePixels}) return -1.0F;
  const double xx = static_cast<double>(scatter.xx);
  const double yy = static_cast<double>(scatter.yy);
  const double xy = static_cast<double>(static_cast<std::int32_t>(scatter.xy));
  const double half_difference = 0.5 * (xx - yy);
  const double smaller = 0.5 * (xx + yy) - std::sqrt(half_difference * half_difference + xy * xy);
  return static_cast<float>(std::max(0.0, smaller / (kNormalScale * kNormalScale)));
}

bool TemplateSelector::tooMuchIgnored(const EdgePixel& pixel, int side_px, const BitImage* ignore,
                                      int level) const {
  if (ignore == nullptr) return false;
  const int scale = 1 << level;
  const int half = side_px / 2;
  const int x_end = std::min(ignore->width, (pixel.x + half) * scale);
  const int y_end = std::min(ignore->height, (pixel.y + half) * scale);
  const int ignored =
      countBits(*ignore, (pixel.x - half) * scale, (pixel.y - half) * scale, x_end, y_end);
  return ignored > kMaxIgnoredShare * side_px * scale * side_px * scale;
}

/// Clears all cells, then calls use(index, pixel, its cell) for the edge pixels that templates may
/// be centred on.
template <class Use>
void TemplateSelector::forEachPlace(const EdgeRender& render, int side_px, int cell_px, Use&& use) {
  const int columns = ceilDivide(render.edges.width, cell_px);
  const int rows = ceilDivide(render.edges.height, cell_px);
  std::fill_n(cells_.begin(), static_cast<std::ptrdiff_t>(columns) * rows, kUnoccupied);
  std::int32_t index = -1;
  for (const EdgePixel& pixel : render.eachPixel()) {
    ++index;
    if (!squareInside(pixel.x, pixel.y, side_px, render.edges.width, render.edges.height)) continue;
    use(index, pixel, nth(cells_, (pixel.y / cell_px) * columns + pixel.x / cell_px));
  }
}

int TemplateSelector::countCells(const EdgeRender& render, int side_px, int cell_px) {
  int occupied = 0;
  forEachPlace(render, side_px, cell_px, [&](std::int32_t, const EdgePixel&, std::uint16_t& cell) {
    if (cell == kUnoccupied) ++occupied;
    cell = 0;
  });
  return occupied;
}

int TemplateSelector::cellSize(const EdgeRender& render, int side_px) {
  const int longest = std::max(render.edges.width, render.edges.height);
  int too_small = std::max(1, ceilDivide(longest, kMaxCells) - 1);
  int enough = longest;
  while (enough - too_small > 1) {  // bisection: at most log2(longest) rounds
    const int middle = too_small + (enough - too_small) / 2;
    if (countCells(render, side_px, middle) <= options_.count) {
      enough = middle;
    } else {
      too_small = middle;
    }
  }
  return enough;
}

/// The most distinct pixel of every occupied cell. The cell size limits their number to that of the
/// templates. The table's rows around each pixel are summed on the way down.
void TemplateSelector::chooseBest(const EdgeRender& render, int side_px, int cell_px,
                                  const BitImage* ignore, int level) {
  std::uint16_t occupied = 0;
  const auto consider = [&](std::int32_t index, const EdgePixel& pixel, std::uint16_t& cell) {
    if (cell == kUnoccupied) {
      cell = occupied++;
      best_[cell] = Best{};
    }
    const int last_row = std::min(blocks_y_, pixel.y / block_px_ + reachOf(side_px) + 1);
    while (summed_rows_ <= last_row) sumRow(render);
    const float distinctness = distinctnessOf(pixel, side_px);
    if (distinctness > best_[cell].distinctness && !tooMuchIgnored(pixel, side_px, ignore, level))
      best_[cell] = {distinctness, index};
  };
  forEachPlace(render, side_px, cell_px, consider);
}

Status TemplateSelector::select(const EdgeRender& render, int side_px, const BitImage* ignore,
                                int level, TemplateSet& output) {
  output.count = 0;
  output.side_px = side_px;
  beginSums(render, side_px);
  const int cell_px = cellSize(render, side_px);
  const int columns = ceilDivide(render.edges.width, cell_px);
  const int rows = ceilDivide(render.edges.height, cell_px);
  chooseBest(render, side_px, cell_px, ignore, level);
  for (int cell = 0; cell < columns * rows && output.count < options_.count; ++cell) {
    const std::uint16_t place = nth(cells_, cell);
    if (place == kUnoccupied || best_[place].pixel < 0) continue;
    const Best& best = best_[place];
    const EdgePixel pixel = render.pixel(best.pixel);
    Template& chosen = nth(output.templates, output.count);
    chosen.center_x = pixel.x;
    chosen.center_y = pixel.y;
    chosen.depth_m = pixel.depth_m;
    chosen.distinctness = best.distinctness;
    if (edgePointInStation(render, pixel, chosen.point_in_station_m)) ++output.count;
  }
  return output.count < kMinCount ? Status::kTooFewTemplates : Status::kOk;
}

}  // namespace boresight
