// SPDX-License-Identifier: Apache-2.0
#include "sessions/review/predicted_edges.h"

#include <utility>

#include "core/render/edge_render.h"
#include "sessions/run/scene_render.h"

namespace boresight::sessions {

PredictedEdges predictEdges(const Camera& camera, const MeshView& mesh,
                            const Pose& camera_from_station) {
  PredictedEdges made;
  RenderTrace render;
  if (renderScene(camera, mesh, camera_from_station, render) != Status::kOk) return made;
  const EdgeRender view = render.view();
  made.places.reserve(render.pixels.size());
  for (const EdgePixel& pixel : render.pixels) {
    EdgePlace place;
    if (!edgeLinePoint(view, mesh, pixel, place.pixel, place.point_in_station_m)) continue;
    place.normal = Eigen::Vector2d(pixel.normal_x, pixel.normal_y).normalized();
    place.kind = pixel.kind;
    if (!place.normal.allFinite()) continue;
    // A thin line has a pixel per column or per row, whichever it crosses more of.
    place.length_px = 1.0 / place.normal.cwiseAbs().maxCoeff();
    made.places.push_back(place);
  }
  made.mask = std::move(render.mask);
  return made;
}

bool placeDerivative(const Camera& camera, const Pose& camera_from_station,
                     const Eigen::Vector3d& point_in_station_m, PlaceDerivative& derivative) {
  const Eigen::Vector3d p = camera_from_station * point_in_station_m;
  Eigen::Vector2d pixel;
  Eigen::Matrix<double, 2, 3> by_point;
  if (!projectWithJacobian(camera, p, pixel, by_point)) return false;
  for (int row = 0; row < 2; ++row) {
    derivative.by_pose.block<1, 3>(row, 0) =
        p.cross(Eigen::Vector3d(by_point.row(row).transpose())).transpose();
    derivative.by_pose.block<1, 3>(row, 3) = by_point.row(row);
  }
  derivative.by_camera << (pixel.x() - camera.cx) / camera.fx, 1.0, 0.0,
      (pixel.y() - camera.cy) / camera.fx, 0.0, 1.0;
  return true;
}

std::vector<EdgePlace> thinned(const std::vector<EdgePlace>& places, std::size_t most) {
  if (most == 0 || places.size() <= most) return places;
  std::vector<EdgePlace> kept;
  kept.reserve(most);
  for (std::size_t i = 0; i < most; ++i) kept.push_back(places[i * places.size() / most]);
  return kept;
}

}  // namespace boresight::sessions
