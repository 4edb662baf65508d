// SPDX-License-Identifier: Apache-2.0
#include "sessions/annotation/annotations_on_image.h"

#include <algorithm>
#include <optional>

#include <Eigen/Geometry>

#include "sessions/trace/surface_point.h"

namespace boresight::sessions {
namespace {

AnnotationResidual pointResidual(const Camera& camera, const PointPair& pair,
                                 const Pose& camera_from_station) {
  const PredictedPlace place = predictPlace(camera, camera_from_station, *pair.point_in_station_m);
  AnnotationResidual residual;
  residual.valid = place.valid;
  if (!residual.valid) return residual;
  residual.residual_px = *pair.pixel - place.pixel;
  residual.predicted_by_xi = place.pixel_by_xi;
  residual.depth_m = place.depth_m;
  return residual;
}

constexpr int kFootRounds = 4;

/// Where on an edge (0: start, 1: end) it is nearest to a pixel's ray, to begin with; camera frame.
double nearestToRay(const Ray& ray, const Eigen::Vector3d& start_m, const Eigen::Vector3d& way_m) {
  const Eigen::Vector3d normal = way_m.cross(ray.direction);
  const double squared = normal.squaredNorm();
  return squared > 0.0 ? (ray.origin_m - start_m).cross(ray.direction).dot(normal) / squared : 0.5;
}

/// End `i` of the line, from the foot of its perpendicular on the projected edge; false where that
/// does not project, or the edge runs along the ray.
bool endResidual(const Camera& camera, const Pose& camera_from_station, const ModelEdge& edge,
                 const Eigen::Vector2d& seen, int i, AnnotationResidual& residual) {
  Ray ray;
  if (!unprojectRay(camera, seen, ray)) return false;
  const Eigen::Vector3d way_m = edge.end_in_station_m - edge.start_in_station_m;
  const Eigen::Vector3d way_in_camera_m = camera_from_station.rotation * way_m;
  double share = nearestToRay(ray, camera_from_station * edge.start_in_station_m, way_in_camera_m);
  for (int round = 0; round < kFootRounds; ++round) {
    const PredictedPlace foot =
        predictPlace(camera, camera_from_station, edge.start_in_station_m + share * way_m);
    const Eigen::Vector2d along = foot.pixel_by_point * way_in_camera_m;
    if (!foot.valid || !(along.norm() > 1e-9 * foot.pixel_by_point.norm() * way_m.norm()))
      return false;
    const Eigen::Vector2d offset = seen - foot.pixel;
    residual.across[i] = Eigen::Vector2d(-along.y(), along.x()).normalized();
    residual.residual_px[i] = residual.across[i].dot(offset);
    residual.predicted_by_xi.row(i) = residual.across[i].transpose() * foot.pixel_by_xi;
    share += along.dot(offset) / along.squaredNorm();
  }
  return true;
}

AnnotationResidual lineResidual(const Camera& camera, const LinePair& pair,
                                const Pose& camera_from_station) {
  AnnotationResidual residual;
  const double start_depth_m = (camera_from_station * pair.edge->start_in_station_m).z();
  const double end_depth_m = (camera_from_station * pair.edge->end_in_station_m).z();
  if (!(start_depth_m > 0.0) || !(end_depth_m > 0.0)) return residual;
  residual.valid =
      endResidual(camera, camera_from_station, *pair.edge, pair.line->start, 0, residual) &&
      endResidual(camera, camera_from_station, *pair.edge, pair.line->end, 1, residual);
  residual.depth_m = 0.5 * (start_depth_m + end_depth_m);
  return residual;
}

constexpr int kMostSteps = 200;
constexpr double kStepDone = 1e-11;  ///< rad, and m per m of distance
constexpr double kFirstDamping = 1e-4;
constexpr double kLargestDamping = 1e10;
/// Near the minimum a good step changes the sum by less than its rounding error.
constexpr double kRoundingOfCost = 1e-13;

bool isNegligible(const Vector6d& xi, const Pose& pose) {
  const double distance_m = std::max(pose.translation_m.cwiseAbs().maxCoeff(), 1e-3);
  return xi.head<3>().cwiseAbs().maxCoeff() < kStepDone &&
         xi.tail<3>().cwiseAbs().maxCoeff() < kStepDone * distance_m;
}

}  // namespace

PredictedPlace predictPlace(const Camera& camera, const Pose& camera_from_station,
                            const Eigen::Vector3d& point_in_station_m) {
  PredictedPlace place;
  const Eigen::Vector3d point = camera_from_station * point_in_station_m;
  place.valid = projectWithJacobian(camera, point, place.pixel, place.pixel_by_point);
  if (!place.valid) return place;
  place.depth_m = point.z();
  // The point moves by omega x p + v.
  for (int i = 0; i < 2; ++i) {
    const Eigen::Vector3d row = place.pixel_by_point.row(i).transpose();
    place.pixel_by_xi.row(i) << point.cross(row).transpose(), row.transpose();
  }
  return place;
}

bool isInImage(const Camera& camera, const Eigen::Vector2d& pixel) {
  return pixel.x() >= -0.5 && pixel.y() >= -0.5 && pixel.x() < camera.width - 0.5 &&
         pixel.y() < camera.height - 0.5;
}

bool isSeen(const Camera& camera, const MeshView& mesh, const Pose& camera_from_station,
            const Eigen::Vector3d& point_in_station_m) {
  const Eigen::Vector3d point = camera_from_station * point_in_station_m;
  Eigen::Vector2d pixel;
  if (!project(camera, point, pixel)) return false;
  const auto surface = surfacePointAt(camera, mesh, camera_from_station, pixel);
  return !surface || surface->depth_m > point.z() * (1.0 - kHidingShare);
}

std::vector<Eigen::Vector2d> edgeOnImage(const Camera& camera, const Pose& camera_from_station,
                                         const ModelEdge& edge, int pieces) {
  std::vector<Eigen::Vector2d> places;
  for (int i = 0; i <= pieces; ++i) {
    const PredictedPlace place =
        predictPlace(camera, camera_from_station, edge.at(static_cast<double>(i) / pieces));
    if (place.valid) places.push_back(place.pixel);
  }
  return places;
}

AnnotationResidual annotationResidual(const AnnotatedView& view, const AnnotationAddress& at,
                                      const Pose& camera_from_station) {
  if (at.kind == AnnotationKind::kPoint)
    return pointResidual(view.camera, view.annotations.points[at.index], camera_from_station);
  return lineResidual(view.camera, view.annotations.lines[at.index], camera_from_station);
}

NormalEquations annotationEquations(std::span<const AnnotatedView> views,
                                    std::span<const AnnotationAddress> annotations,
                                    std::span<const double> weight, const Pose& rig_from_station) {
  NormalEquations sum;
  for (std::size_t i = 0; i < annotations.size(); ++i) {
    const AnnotatedView& view = views[annotations[i].view];
    const double factor = weight.empty() ? 1.0 : weight[i];
    if (factor == 0.0) continue;
    const AnnotationResidual annotation =
        annotationResidual(view, annotations[i], view.camera_from_rig * rig_from_station);
    if (!annotation.valid) {
      ++sum.missing;
      continue;
    }
    const double sigma_px = annotationSigma_px(views, annotations[i]);
    const double w = factor / (sigma_px * sigma_px);
    const Eigen::Matrix<double, 2, 6> rows =
        annotation.predicted_by_xi * adjointOf(view.camera_from_rig);
    sum.information += w * rows.transpose() * rows;
    sum.gradient += w * rows.transpose() * annotation.residual_px;
    sum.squares += w * annotation.residual_px.squaredNorm();
    ++sum.projected;
  }
  return sum;
}

bool refineAnnotations(std::span<const AnnotatedView> views,
                       std::span<const AnnotationAddress> annotations,
                       std::span<const double> weight, Pose& rig_from_station,
                       NormalEquations& equations) {
  Pose pose = rig_from_station;
  equations = annotationEquations(views, annotations, weight, pose);
  double damping = 0.0;
  for (int step = 0; step < kMostSteps && damping <= kLargestDamping; ++step) {
    Vector6d xi;
    if (!solve(equations, damping, xi)) {
      damping = std::max(kFirstDamping, damping * 10.0);
      continue;
    }
    Pose next = perturbed(xi, pose);
    next.rotation.normalize();
    const NormalEquations there = annotationEquations(views, annotations, weight, next);
    const bool negligible = isNegligible(xi, pose);
    if (next.isFinite() && there.cost() <= equations.cost() * (1.0 + kRoundingOfCost)) {
      pose = next;
      equations = there;
      damping = damping <= kFirstDamping ? 0.0 : damping / 10.0;
    } else {
      damping = std::max(kFirstDamping, damping * 10.0);
    }
    if (negligible) break;
  }
  Vector6d unused;
  if (equations.missing > 0 || !solve(equations, 0.0, unused)) return false;
  rig_from_station = pose;
  return true;
}

std::vector<AnnotationVector> annotationVectors(const AnnotatedView& view,
                                                const Pose& camera_from_station) {
  std::vector<AnnotationVector> vectors;
  for (std::size_t i = 0; i < view.annotations.points.size(); ++i) {
    const PointPair& point = view.annotations.points[i];
    if (!point.complete()) continue;
    const AnnotationResidual annotation =
        annotationResidual(view, {0, AnnotationKind::kPoint, i}, camera_from_station);
    if (annotation.valid)
      vectors.push_back({point.id, *point.pixel - annotation.residual_px, *point.pixel});
  }
  for (std::size_t i = 0; i < view.annotations.lines.size(); ++i) {
    const LinePair& line = view.annotations.lines[i];
    if (!line.complete()) continue;
    const AnnotationResidual annotation =
        annotationResidual(view, {0, AnnotationKind::kLine, i}, camera_from_station);
    if (!annotation.valid) continue;
    const Eigen::Vector2d ends[2] = {line.line->start, line.line->end};
    for (int end = 0; end < 2; ++end)
      vectors.push_back(
          {line.id, ends[end] - annotation.residual_px[end] * annotation.across[end], ends[end]});
  }
  return vectors;
}

}  // namespace boresight::sessions
