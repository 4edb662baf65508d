// SPDX-License-Identifier: Apache-2.0
#include "sessions/run/matching_method.h"

#include <algorithm>
#include <cmath>

namespace boresight::sessions {

SearchWindow MatchQuery::windowOf(const Eigen::Vector3d& point_in_station_m, int side_px) const {
  return searchWindow(iteration.render.camera,
                      iteration.camera_from_station_before * point_in_station_m,
                      iteration.uncertainty, side_px);
}

bool MatchQuery::pointAt(const Eigen::Vector2d& place_px, Template& item) const {
  const Camera& camera = iteration.render.camera;
  const Eigen::Vector2d pixel = (place_px.array() + 0.5).floor();
  if (!(pixel.x() >= 0.0 && pixel.y() >= 0.0 && pixel.x() < camera.width &&
        pixel.y() < camera.height))
    return false;
  if (!iteration.render.mask.get(static_cast<int>(pixel.x()), static_cast<int>(pixel.y())))
    return false;
  item.center_x = static_cast<int>(pixel.x());
  item.center_y = static_cast<int>(pixel.y());
  item.depth_m =
      depth[static_cast<std::size_t>(item.center_y) * static_cast<std::size_t>(camera.width) +
            static_cast<std::size_t>(item.center_x)];
  Ray ray;
  if (!(item.depth_m > 0.0F) || !unprojectRay(camera, place_px, ray)) return false;
  item.point_in_station_m =
      iteration.render.camera_from_station.inverse() * ray.at(static_cast<double>(item.depth_m));
  return true;
}

bool MatchQuery::ignored(int x, int y) const {
  if (ignore == nullptr) return false;
  const int level = iteration.level;
  const int x_end = std::min((x + 1) << level, ignore->width);
  const int y_end = std::min((y + 1) << level, ignore->height);
  for (int v = y << level; v < y_end; ++v)
    for (int u = x << level; u < x_end; ++u)
      if (ignore->get(u, v)) return true;
  return false;
}

}  // namespace boresight::sessions
