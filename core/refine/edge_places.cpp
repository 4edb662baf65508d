// SPDX-License-Identifier: Apache-2.0
#include "core/refine/edge_places.h"

#include <algorithm>
#include <cmath>
#include <span>

#include "core/base/nth.h"
#include "core/base/scatter.h"

namespace boresight {

EdgePlaces::EdgePlaces(const RefinementResult& refined, const Camera& camera,
                       const Pose& camera_from_first)
    : camera_(camera), camera_from_first_(camera_from_first) {
  const std::int32_t stride = std::max(1, (refined.sample_count + kMost - 1) / kMost);
  for (std::int32_t k = 0; scattered(k, stride) < refined.sample_count && count_ < kMost; ++k) {
    const EdgeSample& sample = nth(refined.samples, scattered(k, stride));
    Eigen::Vector2d pixel;
    if (!project(camera, refined.camera_from_station * sample.point_in_station_m, pixel)) continue;
    nth(places_, count_++) = {sample.point_in_station_m.cast<float>(), pixel.cast<float>(),
                              sample.normal().cast<float>()};
  }
}

std::optional<EdgePlaces::Motion> EdgePlaces::motionTo(const Pose& camera_from_station) const {
  if (count_ < kLeast) return std::nullopt;
  const Pose to = camera_from_first_ * camera_from_station;
  std::array<double, kMost> motion_px;
  double squares_px2 = 0.0;
  for (int i = 0; i < count_; ++i) {
    const Place& place = nth(places_, i);
    Eigen::Vector2d pixel;
    constexpr double kUnbounded_px = 1e6;
    nth(motion_px, i) =
        project(camera_, to * place.point_in_station_m.cast<double>().eval(), pixel)
            ? std::abs((pixel - place.pixel.cast<double>()).dot(place.normal.cast<double>()))
            : kUnbounded_px;
    squares_px2 += nth(motion_px, i) * nth(motion_px, i);
  }
  const auto rank = motion_px.begin() + static_cast<int>(kOf * (count_ - 1));
  std::nth_element(motion_px.begin(), rank, motion_px.begin() + count_);
  return Motion{*rank, std::sqrt(squares_px2 / count_)};
}

}  // namespace boresight
