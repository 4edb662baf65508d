// SPDX-License-Identifier: Apache-2.0
#include "core/refine/outline_refinement.h"

#include <algorithm>
#include <cmath>

#include "core/base/nth.h"
#include "core/pnp/normal_equations.h"
#include "core/render/rounding.h"

namespace boresight {
namespace {

constexpr int kOutlineRounds = 3;
constexpr int kLeastFound = 12;
/// Neighbouring places share their errors: together they weigh as this many independent ones.
constexpr double kIndependent = 60.0;

/// Signed distance along the normal to the nearest edge of about that direction; false: none.
bool findEdge(const DirectedEdges& edges, const Eigen::Vector2d& place,
              const Eigen::Vector2d& normal, int direction, int radius, double& offset_px) {
  for (int step = 0; step <= radius; ++step) {
    double best = 1e9;
    for (int sign = step == 0 ? 1 : -1; sign <= 1; sign += 2) {
      const int x = floorClamped(place.x() + sign * step * normal.x() + 0.5, -1, edges.width);
      const int y = floorClamped(place.y() + sign * step * normal.y() + 0.5, -1, edges.height);
      if (x < 0 || y < 0 || x >= edges.width || y >= edges.height) continue;
      const int found = edges.at(x, y);
      if (found >= kEdgeDirections || directionsApart(found, direction) > 1) continue;
      const double offset = normal.x() * (x - place.x()) + normal.y() * (y - place.y());
      if (std::abs(offset) < std::abs(best)) best = offset;
    }
    if (best < 1e8) {
      offset_px = best;
      return true;
    }
  }
  return false;
}

}  // namespace

Status OutlineRefinement::create(Arena& arena) {
  samples_ = arena.allocate<Sample>(kMaxSamples);
  return arena.exhausted() ? Status::kArenaTooSmall : Status::kOk;
}

void OutlineRefinement::takePlaces(const MeshView& mesh, const EdgeRender& render) {
  camera_ = render.camera;
  count_ = 0;
  for (const EdgePixel& pixel : render.eachPixel(render.strideFor(kMaxSamples))) {
    Sample& sample = nth(samples_, count_);
    Eigen::Vector2d position_px;
    if (!edgeLinePoint(render, mesh, pixel, position_px, sample.point_in_station_m)) continue;
    sample.normal = pixel.normal();
    sample.direction = edgeDirectionOf(pixel.normal_x, pixel.normal_y);
    ++count_;
  }
}

bool OutlineRefinement::refine(const DirectedEdges& edges, const PosePrior& prior, double radius_px,
                               Pose& view_from_station) const {
  Pose pose = view_from_station;
  for (int round = 0; round < kOutlineRounds; ++round) {
    const double cut_px = radius_px + 0.5;
    const int radius = static_cast<int>(radius_px + 0.5);
    NormalEquations equations;
    double weights = 0.0;
    const PoseMatrix to_view(pose);
    for (int i = 0; i < count_; ++i) {
      const Sample& sample = nth(samples_, i);
      const Eigen::Vector3d point = to_view * sample.point_in_station_m;
      Eigen::Vector2d pixel;
      Eigen::Matrix<double, 2, 3> jacobian;
      if (!projectWithJacobian(camera_, point, pixel, jacobian)) continue;
      double offset_px = 0.0;
      if (!findEdge(edges, pixel, sample.normal, sample.direction, radius, offset_px)) continue;
      if (std::abs(offset_px) >= cut_px) continue;
      const double ratio = offset_px / cut_px;
      const double weight = (1.0 - ratio * ratio) * (1.0 - ratio * ratio);
      addRow(lineRow(point, sample.normal, jacobian), weight, offset_px, equations);
      weights += weight;
    }
    if (equations.projected < kLeastFound) return false;
    const double scale = std::min(1.0, kIndependent / weights);
    equations.information *= scale;
    equations.gradient *= scale;
    addPrior(prior, pose, equations);
    Vector6d xi;
    if (!solve(equations, 1e-3, xi)) return false;
    Pose moved = perturbed(xi, pose);
    moved.rotation.normalize();
    if (!moved.isFinite()) return false;
    pose = moved;
  }
  view_from_station = pose;
  return true;
}

}  // namespace boresight
