// SPDX-License-Identifier: Apache-2.0
#include "core/accept/self_similarity.h"

#include <algorithm>
#include <cmath>

#include "core/base/math.h"
#include "core/geometry/camera.h"

namespace boresight {
namespace {

constexpr int kBinCount = 16;

/// Direction of a normal, counted around the circle.
int binOf(const EdgePixel& pixel) {
  const double angle =
      arcTangent2(static_cast<double>(pixel.normal_y), static_cast<double>(pixel.normal_x));
  const int bin = static_cast<int>(std::floor(angle * (kBinCount / (2.0 * kPi)) + 0.5));
  return (bin + kBinCount) % kBinCount;
}

/// How much an edge says of a displacement: the squared cosine between its normal and that, times
/// 256.
void weighBins(int dx, int dy, std::array<std::int32_t, kBinCount>& weight) {
  // Cosines of 0, 22.5, ... deg, times 1024.
  constexpr int kCosine[kBinCount] = {1024,  946,  724,  392,  0, -392, -724, -946,
                                      -1024, -946, -724, -392, 0, 392,  724,  946};
  const std::int64_t length = std::int64_t{dx} * dx + std::int64_t{dy} * dy;
  for (int bin = 0; bin < kBinCount; ++bin) {
    const std::int64_t along = std::int64_t{dx} * kCosine[bin] +
                               std::int64_t{dy} * kCosine[(bin + 3 * kBinCount / 4) % kBinCount];
    weight[static_cast<std::size_t>(bin)] =
        static_cast<std::int32_t>(along * along / (std::max<std::int64_t>(1, length) << 12));
  }
}

/// A bin and its two neighbours.
std::uint16_t aroundBin(int bin) {
  std::uint32_t bits = 0;
  for (int i = -1; i <= 1; ++i) bits |= 1U << ((bin + i + kBinCount) % kBinCount);
  return static_cast<std::uint16_t>(bits);
}

}  // namespace

void SelfSimilarity::create(int width, int height, Arena& arena) {
  static_assert(kBins == kBinCount);
  int shift = 0;
  while ((std::max(width, height) - 1) >> shift >= kMostCells) ++shift;
  const int columns = ((width - 1) >> shift) + 1;
  const int rows = ((height - 1) >> shift) + 1;
  cells_ = arena.allocate<std::uint16_t>(static_cast<std::size_t>(columns * rows));
  // A smaller picture may have smaller cells, but no more of them than kMostCells.
  scores_ = arena.allocate<std::uint16_t>(static_cast<std::size_t>((columns + 1) * (rows / 2 + 1)));
  places_ = arena.allocate<Place>(kMostPlaces);
  for (std::span<float>& axis : found_m_) axis = arena.allocate<float>(kMostPlaces);
}

void SelfSimilarity::begin(const EdgeRender& render, int reach_x_px, int reach_y_px,
                           double least_similarity) {
  render_ = &render;
  const int width = render.edges.width;
  const int height = render.edges.height;
  cell_shift_ = 0;
  while ((std::max(width, height) - 1) >> cell_shift_ >= kMostCells) ++cell_shift_;
  columns_ = ((width - 1) >> cell_shift_) + 1;
  rows_ = ((height - 1) >> cell_shift_) + 1;
  reach_x_ = std::clamp(reach_x_px >> cell_shift_, 0, columns_ / 2);
  reach_y_ = std::clamp(reach_y_px >> cell_shift_, 0, rows_ / 2);
  least_ = static_cast<std::int32_t>(least_similarity * kScale);
  row_ = 0;
  measured_ = -1;
  count_ = 0;
  takePlaces();
  markCells();
}

void SelfSimilarity::takePlaces() {
  const std::int32_t stride = std::max(1, (render_->pixel_count + kMostPlaces - 1) / kMostPlaces);
  place_count_ = 0;
  for (std::int32_t i = 0; i < render_->pixel_count; i += stride) {
    const EdgePixel& pixel = render_->pixels[static_cast<std::size_t>(i)];
    Place& place = places_[static_cast<std::size_t>(place_count_++)];
    place.pixel = i;
    place.x = static_cast<std::int16_t>(pixel.x >> cell_shift_);
    place.y = static_cast<std::int16_t>(pixel.y >> cell_shift_);
    place.bin = static_cast<std::uint8_t>(binOf(pixel));
  }
}

void SelfSimilarity::markCells() {
  std::fill(cells_.begin(), cells_.end(), std::uint16_t{0});
  for (std::int32_t i = 0; i < render_->pixel_count; ++i) {
    const EdgePixel& pixel = render_->pixels[static_cast<std::size_t>(i)];
    const std::uint16_t bins = aroundBin(binOf(pixel));
    const int x = pixel.x >> cell_shift_;
    const int y = pixel.y >> cell_shift_;
    for (int v = std::max(0, y - 1); v <= std::min(rows_ - 1, y + 1); ++v) {
      for (int u = std::max(0, x - 1); u <= std::min(columns_ - 1, x + 1); ++u) {
        std::uint16_t& cell = cells_[static_cast<std::size_t>(v * columns_ + u)];
        cell = static_cast<std::uint16_t>(cell | bins);
      }
    }
  }
}

/// In 1/kScale; 0 where less than a quarter of what there is stays in the picture.
std::int32_t SelfSimilarity::scoreOf(int dx, int dy) const {
  std::array<std::int32_t, kBinCount> weight{};
  weighBins(dx, dy, weight);
  std::int64_t whole = 0, inside = 0, met = 0;
  for (int i = 0; i < place_count_; ++i) {
    const Place& place = places_[static_cast<std::size_t>(i)];
    const std::int32_t w = weight[place.bin];
    whole += w;
    const int x = place.x + dx;
    const int y = place.y + dy;
    if (x < 0 || y < 0 || x >= columns_ || y >= rows_) continue;
    inside += w;
    const unsigned bins = cells_[static_cast<std::size_t>(y * columns_ + x)];
    if (((bins >> place.bin) & 1U) != 0) met += w;
  }
  if (inside == 0 || 4 * inside < whole) return 0;
  return static_cast<std::int32_t>(met * kScale / inside);
}

void SelfSimilarity::scoreRow(int dy) {
  std::uint16_t* row = scores_.data() + static_cast<std::ptrdiff_t>(dy) * (2 * reach_x_ + 1);
  for (int dx = -reach_x_; dx <= reach_x_; ++dx)
    row[dx + reach_x_] = static_cast<std::uint16_t>(scoreOf(dx, dy));
}

std::int32_t SelfSimilarity::scoreAt(int dx, int dy) const {
  if (dy < 0) return scoreAt(-dx, -dy);
  if (dx < -reach_x_ || dx > reach_x_ || dy > reach_y_) return 0;
  return scores_[static_cast<std::size_t>(dy * (2 * reach_x_ + 1) + dx + reach_x_)];
}

/// The largest within kNearest cells, the first in raster order of equals.
bool SelfSimilarity::isPeak(int dx, int dy) const {
  const std::int32_t here = scoreAt(dx, dy);
  for (int v = -kNearest; v <= kNearest; ++v) {
    for (int u = -kNearest; u <= kNearest; ++u) {
      const std::int32_t there = scoreAt(dx + u, dy + v);
      const bool earlier = v < 0 || (v == 0 && u < 0);
      if (there > here || (earlier && there == here)) return false;
    }
  }
  return true;
}

void SelfSimilarity::keep(const SelfShift& shift) {
  int at = count_;
  while (at > 0 && shifts_[static_cast<std::size_t>(at - 1)].similarity < shift.similarity) --at;
  if (at >= kMostShifts) return;
  count_ = std::min(count_ + 1, kMostShifts);
  for (int i = count_ - 1; i > at; --i)
    shifts_[static_cast<std::size_t>(i)] = shifts_[static_cast<std::size_t>(i - 1)];
  shifts_[static_cast<std::size_t>(at)] = shift;
}

/// Peaks of the map beyond its mean, which is what comes about by chance; each with its mirror
/// image.
void SelfSimilarity::findPeaks() {
  const auto isFar = [](int dx, int dy) { return std::max(std::abs(dx), std::abs(dy)) > kNearest; };
  std::int64_t sum = 0, count = 0;
  for (int dy = 0; dy <= reach_y_; ++dy) {
    for (int dx = -reach_x_; dx <= reach_x_; ++dx) {
      if (!isFar(dx, dy)) continue;
      sum += scoreAt(dx, dy);
      ++count;
    }
  }
  const auto chance = static_cast<std::int32_t>(count > 0 ? sum / count : 0);
  if (chance >= kScale) return;
  for (int dy = 0; dy <= reach_y_; ++dy) {
    for (int dx = dy == 0 ? 1 : -reach_x_; dx <= reach_x_; ++dx) {
      const std::int32_t excess = scoreAt(dx, dy) - chance;
      if (excess <= 0 || excess * kScale < std::int64_t{least_} * (kScale - chance)) continue;
      if (!isFar(dx, dy) || !isPeak(dx, dy)) continue;
      const double similarity = static_cast<double>(excess) / (kScale - chance);
      const int cell_px = 1 << cell_shift_;
      keep({dx * cell_px, dy * cell_px, similarity});
      keep({-dx * cell_px, -dy * cell_px, similarity});
    }
  }
}

/// The edge pixel of the same direction that is nearest to the displaced one, within a cell and a
/// half; -1: none.
std::int32_t SelfSimilarity::partnerOf(const EdgePixel& pixel, const SelfShift& shift) const {
  const std::uint16_t bins = aroundBin(binOf(pixel));
  const int radius_px = (3 << cell_shift_) / 2;
  const int x = pixel.x + shift.x_px;
  const int y = pixel.y + shift.y_px;
  std::int32_t best = -1;
  int best_distance = 2 * radius_px * radius_px + 1;
  for (int v = std::max(0, y - radius_px); v <= std::min(render_->edges.height - 1, y + radius_px);
       ++v) {
    for (int u = x - radius_px; u <= x + radius_px; ++u) {
      const int distance = (u - x) * (u - x) + (v - y) * (v - y);
      if (distance >= best_distance) continue;
      const std::int32_t found = findEdgePixel(*render_, u, v);
      if (found < 0) continue;
      if (((bins >> binOf(render_->pixels[static_cast<std::size_t>(found)])) & 1U) == 0) continue;
      best = found;
      best_distance = distance;
    }
  }
  return best;
}

void SelfSimilarity::measureDisplacement(SelfShift& shift) {
  constexpr std::int32_t kSays = 64;  ///< of 256: edges within 60 deg of the displacement's normal
  std::array<std::int32_t, kBinCount> weight{};
  weighBins(shift.x_px, shift.y_px, weight);
  const auto pointOf = [this](const EdgePixel& pixel, Eigen::Vector3d& point_in_camera_m) {
    Ray ray;
    if (!unprojectRay(render_->camera, Eigen::Vector2d(pixel.x, pixel.y), ray)) return false;
    point_in_camera_m = ray.at(static_cast<double>(pixel.depth_m));
    return true;
  };
  std::size_t found = 0;
  for (int i = 0; i < place_count_; ++i) {
    const Place& place = places_[static_cast<std::size_t>(i)];
    if (weight[place.bin] < kSays) continue;
    const EdgePixel& pixel = render_->pixels[static_cast<std::size_t>(place.pixel)];
    const std::int32_t partner = partnerOf(pixel, shift);
    Eigen::Vector3d from_m, to_m;
    if (partner < 0 || !pointOf(pixel, from_m) ||
        !pointOf(render_->pixels[static_cast<std::size_t>(partner)], to_m))
      continue;
    for (int axis = 0; axis < 3; ++axis)
      found_m_[static_cast<std::size_t>(axis)][found] =
          static_cast<float>(to_m[axis] - from_m[axis]);
    ++found;
  }
  if (found == 0) return;
  for (int axis = 0; axis < 3; ++axis) {
    const std::span<float> all = found_m_[static_cast<std::size_t>(axis)].first(found);
    const auto middle = all.begin() + static_cast<std::ptrdiff_t>(found / 2);
    std::nth_element(all.begin(), middle, all.end());
    shift.displacement_in_camera_m[axis] = static_cast<double>(*middle);
  }
}

bool SelfSimilarity::step() {
  if (row_ <= reach_y_) {
    scoreRow(row_++);
    return false;
  }
  if (measured_ < 0) {
    findPeaks();
    measured_ = 0;
  } else if (measured_ < count_) {
    measureDisplacement(shifts_[static_cast<std::size_t>(measured_++)]);
  }
  return measured_ >= count_;
}

}  // namespace boresight
