// SPDX-License-Identifier: Apache-2.0
#include "core/match/template_warp.h"

#include <algorithm>
#include <cmath>

#include "core/base/math.h"

namespace boresight {
namespace {

/// 0, +1, -1, +2, -2, ...
double signedStep(std::int32_t index) {
  const double step = (index + 1) / 2;
  return index % 2 == 1 ? step : -step;
}

/// As many as cover `reach` to either side, `step` apart; odd.
std::int32_t countFor(double reach, double step, std::int32_t most) {
  std::int32_t count = 1;
  while (count + 2 <= most && 0.5 * count * step < reach) count += 2;
  return count;
}

/// Distance between `count` places that serve half of it to either side and `reach` together.
double stepFor(double reach, std::int32_t count) { return count > 1 ? 2.0 * reach / count : 0.0; }

/// By how much a point may be nearer or farther, as a share of its depth: the uncertainty's
/// translation along z, and its rotations about x and y with their lever arms about the pivot.
double relativeDepthReach(const SeedUncertainty& uncertainty, const Eigen::Vector3d& point_m) {
  constexpr double kMost = 0.5;
  const Eigen::Vector3d arm_m = point_m - uncertainty.pivot_in_camera_m;
  const double reach_m = uncertainty.translation_m.z() +
                         uncertainty.rotation_rad.x() * std::abs(arm_m.y()) +
                         uncertainty.rotation_rad.y() * std::abs(arm_m.x());
  return point_m.z() > 0.0 ? std::min(kMost, reach_m / point_m.z()) : 0.0;
}

int floorToInt(double value) { return static_cast<int>(std::floor(value)); }

}  // namespace

TemplateWarp WarpGrid::at(std::int32_t index) const {
  TemplateWarp warp;
  if (index <= 0 || index >= count()) return warp;
  warp.roll_rad = signedStep(index % rolls) * roll_step_rad;
  warp.scale = 1.0 + signedStep(index / rolls) * scale_step;
  return warp;
}

WarpGrid warpGrid(const WarpOptions& options, const SeedUncertainty& uncertainty,
                  const Eigen::Vector3d& point_in_camera_m, int side_px) {
  const double served = 4.0 * options.tolerance_px / std::max(side_px, 2);
  const double roll_reach = std::min(uncertainty.rotation_rad.z(), kPi);
  const double scale_reach = relativeDepthReach(uncertainty, point_in_camera_m);
  WarpGrid grid;
  grid.rolls = countFor(roll_reach, served, options.max_per_template);
  grid.scales = countFor(scale_reach, served, options.max_per_template);
  while (grid.count() > options.max_per_template) {
    std::int32_t& larger = grid.rolls >= grid.scales ? grid.rolls : grid.scales;
    larger -= 2;
  }
  grid.roll_step_rad = stepFor(roll_reach, grid.rolls);
  grid.scale_step = stepFor(scale_reach, grid.scales);
  return grid;
}

void WarpedTemplate::create(int max_side_px, Arena& arena) {
  edges_ = BitImage::create(arena, max_side_px, max_side_px);
  mask_ = BitImage::create(arena, max_side_px, max_side_px);
}

TemplateView WarpedTemplate::warp(const TemplateView& view, const TemplateWarp& warp) {
  const int side = view.side_px;
  const double half = 0.5 * side;
  const double cosine_of = cosine(warp.roll_rad) / warp.scale;
  const double sine_of = sine(warp.roll_rad) / warp.scale;
  edges_.clear();
  mask_.clear();
  for (int v = 0; v < side; ++v) {
    const double dy = v - half;
    for (int u = 0; u < side; ++u) {
      const double dx = u - half;
      const int x = view.center_x + floorToInt(cosine_of * dx + sine_of * dy + 0.5);
      const int y = view.center_y + floorToInt(cosine_of * dy - sine_of * dx + 0.5);
      if (!view.mask->contains(x, y) || !view.mask->get(x, y)) continue;
      mask_.set(u, v);
      if (view.edges->get(x, y)) edges_.set(u, v);
    }
  }
  return {&edges_, &mask_, side / 2, side / 2, side};
}

}  // namespace boresight
