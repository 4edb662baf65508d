// SPDX-License-Identifier: Apache-2.0
#include "sessions/annotation/mark_equations.h"

#include <algorithm>

#include <Eigen/Geometry>

#include "sessions/annotation/marks_on_image.h"

namespace boresight::sessions {
namespace {

using Row6 = Eigen::Matrix<double, 1, 6>;

/// d (c . dA) / d xi for a point A of the camera frame that moves by omega x A + v.
Row6 rowOf(const Eigen::Vector3d& point, const Eigen::RowVector3d& c) {
  Row6 row;
  row << point.cross(c.transpose()).transpose(), c;
  return row;
}

MarkResidual pointResidual(const Camera& camera, const PointPair& pair,
                           const Pose& camera_from_station) {
  const PredictedPlace place = predictPlace(camera, camera_from_station, *pair.point_in_station_m);
  MarkResidual made;
  made.valid = place.valid;
  if (!made.valid) return made;
  made.residual_px = *pair.pixel - place.pixel;
  made.predicted_by_xi = place.pixel_by_xi;
  made.depth_m = place.depth_m;
  return made;
}

/// The edge's interpretation plane through the place where a ray starts, unit normal.
struct EdgePlane {
  Eigen::Vector3d a;  ///< ends in the camera frame, from there
  Eigen::Vector3d b;
  Eigen::Vector3d normal;
  double length = 0.0;  ///< of a x b

  /// False when the edge is seen end-on.
  bool set(const Eigen::Vector3d& from_a, const Eigen::Vector3d& from_b) {
    a = from_a;
    b = from_b;
    const Eigen::Vector3d across = a.cross(b);
    length = across.norm();
    if (!(length > 1e-12 * a.norm() * b.norm())) return false;
    normal = across / length;
    return true;
  }
};

/// End `i` of the line; false where the camera cannot say which ray it is. `start_m` and `end_m`
/// are the edge's in the camera frame.
bool endResidual(const Camera& camera, const Eigen::Vector3d& start_m, const Eigen::Vector3d& end_m,
                 const Eigen::Vector2d& seen, int i, MarkResidual& made) {
  Ray ray;
  EdgePlane plane;
  if (!unprojectRay(camera, seen, ray) || !plane.set(start_m - ray.origin_m, end_m - ray.origin_m))
    return false;
  const Eigen::Vector3d d = ray.direction.normalized();
  Eigen::Vector2d pixel;
  Eigen::Matrix<double, 2, 3> jacobian;
  if (!projectWithJacobian(camera, ray.origin_m + d, pixel, jacobian)) return false;
  const double sine = plane.normal.dot(d);
  // Pixels across the edge for a unit step of the ray along the plane's normal.
  const Eigen::Vector2d along = jacobian * plane.normal.cross(d);
  const Eigen::Vector2d across = jacobian * plane.normal;
  const double along_length = along.norm();
  if (!(along_length > 0.0)) return false;
  const double scale_px = (along.x() * across.y() - along.y() * across.x()) / along_length;
  made.across[i] = Eigen::Vector2d(-along.y(), along.x()) / along_length;
  made.residual_px[i] = scale_px * sine;
  // n = (a x b) / |a x b|: d n . d = (da x b + a x db) . m.
  const Eigen::Vector3d m = (d - sine * plane.normal) / plane.length;
  made.predicted_by_xi.row(i) = -scale_px * (rowOf(start_m, plane.b.cross(m).transpose()) +
                                             rowOf(end_m, m.cross(plane.a).transpose()));
  return true;
}

MarkResidual lineResidual(const Camera& camera, const LinePair& pair,
                          const Pose& camera_from_station) {
  MarkResidual made;
  const Eigen::Vector3d start_m = camera_from_station * pair.edge->start_in_station_m;
  const Eigen::Vector3d end_m = camera_from_station * pair.edge->end_in_station_m;
  if (!(start_m.z() > 0.0) || !(end_m.z() > 0.0)) return made;
  made.valid = endResidual(camera, start_m, end_m, pair.line->start, 0, made) &&
               endResidual(camera, start_m, end_m, pair.line->end, 1, made);
  made.depth_m = 0.5 * (start_m.z() + end_m.z());
  return made;
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

MarkResidual markResidual(const MarkedView& view, const MarkAddress& at,
                          const Pose& camera_from_station) {
  if (at.kind == MarkKind::kPoint)
    return pointResidual(view.camera, view.marks.points[at.index], camera_from_station);
  return lineResidual(view.camera, view.marks.lines[at.index], camera_from_station);
}

NormalEquations markEquations(std::span<const MarkedView> views, std::span<const MarkAddress> marks,
                              std::span<const double> weight, const Pose& rig_from_station) {
  NormalEquations sum;
  for (std::size_t i = 0; i < marks.size(); ++i) {
    const MarkedView& view = views[marks[i].view];
    const double factor = weight.empty() ? 1.0 : weight[i];
    if (factor == 0.0) continue;
    const MarkResidual mark = markResidual(view, marks[i], view.camera_from_rig * rig_from_station);
    if (!mark.valid) {
      ++sum.missing;
      continue;
    }
    const double sigma_px = markSigma_px(views, marks[i]);
    const double w = factor / (sigma_px * sigma_px);
    const Eigen::Matrix<double, 2, 6> rows = mark.predicted_by_xi * adjointOf(view.camera_from_rig);
    sum.information += w * rows.transpose() * rows;
    sum.gradient += w * rows.transpose() * mark.residual_px;
    sum.squares += w * mark.residual_px.squaredNorm();
    ++sum.projected;
  }
  return sum;
}

bool refineMarks(std::span<const MarkedView> views, std::span<const MarkAddress> marks,
                 std::span<const double> weight, Pose& rig_from_station,
                 NormalEquations& equations) {
  Pose pose = rig_from_station;
  equations = markEquations(views, marks, weight, pose);
  double damping = 0.0;
  for (int step = 0; step < kMostSteps && damping <= kLargestDamping; ++step) {
    Vector6d xi;
    if (!solve(equations, damping, xi)) {
      damping = std::max(kFirstDamping, damping * 10.0);
      continue;
    }
    Pose next = perturbed(xi, pose);
    next.rotation.normalize();
    const NormalEquations there = markEquations(views, marks, weight, next);
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

}  // namespace boresight::sessions
