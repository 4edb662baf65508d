// SPDX-License-Identifier: Apache-2.0
#include "core/search/compass_search.h"

#include <cmath>

#include "core/base/math.h"

namespace boresight {
namespace {

constexpr int kStepSizes = 3;
constexpr int kMostSweeps = 6;
/// First steps: half the spacings of the grid.
constexpr double kTurn_rad = 7.5 * kDegree_rad;
constexpr double kSlide_px = 2.0;
constexpr double kDepthStep = 0.05;

}  // namespace

bool CompassSearch::takePlaces(const MeshView& mesh, const EdgeRender& render) {
  camera_ = render.camera;
  places_.clear();
  takeEvenly(render, [&](const EdgePixel& pixel) {
    Place place;
    Eigen::Vector2d position_px;
    if (!edgeLinePoint(render, mesh, pixel, position_px, place.point_in_station_m)) return;
    place.normal = Eigen::Vector2d(pixel.normal_x, pixel.normal_y);
    places_.add(place);
  });
  return places_.size() > 0;
}

int CompassSearch::sumAt(const SlideSums& maps, const State& state) const {
  const PoseMatrix view_from_station(state.view_from_station);
  const double c = cos(state.roll_rad);
  const double s = sin(state.roll_rad);
  int sum = 0;
  for (const Place& place : places_.items()) {
    const Eigen::Vector3d point = view_from_station * place.point_in_station_m;
    if (!(point.z() > 0.0)) {
      sum += SlideSums::kFarthestStep;
      continue;
    }
    const double inverse_z = 1.0 / point.z();
    const int direction =
        edgeDirectionOf(nearestInt(8.0 * (c * place.normal.x() - s * place.normal.y())),
                        nearestInt(8.0 * (s * place.normal.x() + c * place.normal.y())));
    sum +=
        maps.at(direction, camera_.fx * point.x() * inverse_z, camera_.fy * point.y() * inverse_z);
  }
  return sum;
}

double CompassSearch::descend(const SlideSums& maps, const Eigen::Vector3d& middle_in_station_m,
                              Pose& view_from_station) const {
  State best{view_from_station, 0.0};
  int least = sumAt(maps, best);
  double share = 1.0;
  for (int scale = 0; scale < kStepSizes; ++scale, share *= 0.5) {
    for (int sweep = 0; sweep < kMostSweeps; ++sweep) {
      bool moved = false;
      for (int move = 0; move < 12; ++move) {
        const double step = move % 2 == 0 ? share : -share;
        const int axis = move / 2;
        State next = best;
        Pose& pose = next.view_from_station;
        const Eigen::Vector3d middle_m = pose * middle_in_station_m;
        if (axis < 3) {
          Eigen::Vector3d turn_rad = Eigen::Vector3d::Zero();
          turn_rad[axis] = step * kTurn_rad;
          pose.rotation = rotationExp(turn_rad) * pose.rotation;
          pose.translation_m = middle_m - pose.matrix() * middle_in_station_m;
          if (axis == 2) next.roll_rad += turn_rad.z();
        } else if (axis < 5) {
          pose.translation_m[axis - 3] += step * kSlide_px * middle_m.z() / camera_.fx;
        } else {
          pose.translation_m += step * kDepthStep * middle_m;
        }
        const int sum = sumAt(maps, next);
        if (sum >= least) continue;
        least = sum;
        best = next;
        moved = true;
      }
      if (!moved) break;
    }
  }
  view_from_station = best.view_from_station;
  view_from_station.rotation.normalize();
  return SlideSums::kStep_px * least / places_.size();
}

}  // namespace boresight
