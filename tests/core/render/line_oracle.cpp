// SPDX-License-Identifier: Apache-2.0
#include "tests/core/render/line_oracle.h"

#include <algorithm>
#include <cmath>
#include <map>

namespace boresight::testing {

ProjectedLine::ProjectedLine(const Camera& camera, const Eigen::Vector3d& begin,
                             const Eigen::Vector3d& direction, double s_first, double s_last) {
  constexpr int kSamples = 2500;
  for (int i = 0; i <= kSamples; ++i) {
    const double s = s_first + (s_last - s_first) * i / kSamples;
    Eigen::Vector2d pixel;
    if (project(camera, begin + s * direction, pixel)) points_.push_back(pixel);
  }
}

double ProjectedLine::signedDistance(const Eigen::Vector2d& pixel, Eigen::Vector2d& normal) const {
  // The nearest of every 50th point, then of the pieces around it.
  constexpr std::size_t kStride = 50;
  double best = 1e300;
  std::size_t near = 0;
  for (std::size_t i = 0; i < points_.size(); i += kStride)
    if ((points_[i] - pixel).norm() < best) {
      best = (points_[i] - pixel).norm();
      near = i;
    }
  best = 1e300;
  double signed_distance = 0.0;
  for (std::size_t i = near < 2 * kStride ? 0 : near - 2 * kStride;
       i + 1 < std::min(points_.size(), near + 2 * kStride); ++i) {
    const Eigen::Vector2d& a = points_[i];
    const Eigen::Vector2d along = points_[i + 1] - a;
    const double length = along.norm();
    if (!(length > 0.0)) continue;
    const double t = std::clamp((pixel - a).dot(along) / (length * length), 0.0, 1.0);
    const Eigen::Vector2d away = pixel - a - t * along;
    if (away.norm() >= best) continue;
    best = away.norm();
    normal = Eigen::Vector2d(-along.y(), along.x()) / length;
    signed_distance = away.dot(normal);
  }
  return signed_distance;
}

LineStatistics lineStatistics(const EdgeRender& render, const ProjectedLine& line, int margin_px) {
  LineStatistics statistics;
  std::map<int, int> rows;
  std::map<int, int> columns;
  double steepness = 0.0;
  for (std::int32_t i = 0; i < render.pixel_count; ++i) {
    const EdgePixel& pixel = render.pixels[static_cast<std::size_t>(i)];
    if (pixel.x < margin_px || pixel.y < margin_px || pixel.x >= render.camera.width - margin_px ||
        pixel.y >= render.camera.height - margin_px)
      continue;
    Eigen::Vector2d normal;
    const double distance = line.signedDistance(Eigen::Vector2d(pixel.x, pixel.y), normal);
    const Eigen::Vector2d recorded = Eigen::Vector2d(pixel.normal_x, pixel.normal_y).normalized();
    const double sign = recorded.dot(normal) < 0.0 ? -1.0 : 1.0;
    ++statistics.pixels;
    ++rows[pixel.y];
    ++columns[pixel.x];
    steepness += std::abs(normal.x()) - std::abs(normal.y());
    statistics.mean_px += distance;
    statistics.largest_px = std::max(statistics.largest_px, std::abs(distance));
    statistics.largest_excess_px =
        std::max(statistics.largest_excess_px,
                 std::abs(distance) - 0.5 * std::max(std::abs(normal.x()), std::abs(normal.y())));
    // The line lies at -distance along `normal` from the pixel's centre.
    statistics.offset_error_px =
        std::max(statistics.offset_error_px, std::abs(pixel.offset / 100.0 + sign * distance));
    statistics.normal_error = std::max(statistics.normal_error, (recorded - sign * normal).norm());
  }
  if (statistics.pixels == 0) return statistics;
  statistics.mean_px /= statistics.pixels;
  const std::map<int, int>& lanes = steepness > 0.0 ? rows : columns;
  for (const auto& [lane, count] : lanes) statistics.doubled += count > 1 ? 1 : 0;
  const int lane_count = lanes.rbegin()->first - lanes.begin()->first + 1;
  statistics.missing = lane_count - static_cast<int>(lanes.size());
  return statistics;
}

}  // namespace boresight::testing
