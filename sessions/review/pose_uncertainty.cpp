// SPDX-License-Identifier: Apache-2.0
#include "sessions/review/pose_uncertainty.h"

#include "core/pnp/normal_equations.h"
#include "sessions/review/edge_evidence.h"

namespace boresight::sessions {
namespace {

/// This number of points gives the sums to a percent.
constexpr std::size_t kPlaces = 4000;

using ByCamera = Eigen::Matrix<double, 6, 3>;

/// That of a single point, without turning.
ByCamera pointByCamera(const Camera& camera, const Eigen::Vector3d& point_in_camera_m) {
  ByCamera by = ByCamera::Zero();
  by.bottomRows<3>() = point_in_camera_m.z() / camera.fx *
                       Eigen::Matrix3d{{0.0, -1.0, 0.0},  //
                                       {0.0, 0.0, -1.0},
                                       {1.0, 0.0, 0.0}};
  return by;
}

}  // namespace

std::optional<ByCamera> poseByCamera(std::span<const EdgePlace> places, const Camera& camera,
                                     const Pose& camera_from_station) {
  Matrix6d information = Matrix6d::Zero();
  ByCamera right = ByCamera::Zero();
  for (const EdgePlace& place : places) {
    PlaceDerivative by;
    if (!placeDerivative(camera, camera_from_station, place.point_in_station_m, by)) continue;
    const Vector6d row = by.by_pose.transpose() * place.normal;
    information += row * row.transpose();
    right -= row * (place.normal.transpose() * by.by_camera);
  }
  Matrix6d inverse;
  if (!invert(information, inverse)) return {};
  return inverse * right;
}

PoseCovariance poseCovariance(const SessionCase& session_case, const MeshView& mesh,
                              const Pose& camera_from_station, const Matrix6d& picture) {
  const Camera& camera = session_case.camera;
  const InputSigmas sigmas(session_case);
  const Eigen::Vector3d middle_in_camera_m = camera_from_station * matchedBounds(mesh).centre();
  PoseCovariance covariance;
  covariance.picture = picture;
  Vector6d by_scale = Vector6d::Zero();
  by_scale.tail<3>() = sigmas.mesh_scale * middle_in_camera_m;
  covariance.mesh_scale = by_scale * by_scale.transpose();
  const PredictedEdges edges = predictEdges(camera, mesh, camera_from_station);
  const auto by_camera = poseByCamera(thinned(edges.places, kPlaces), camera, camera_from_station);
  const double centre_px = sigmas.calibration.principal_point_px;
  const Eigen::Vector3d sigmas_px(sigmas.calibration.focal_relative * camera.fx, centre_px,
                                  centre_px);
  const ByCamera scaled =
      by_camera.value_or(pointByCamera(camera, middle_in_camera_m)) * sigmas_px.asDiagonal();
  covariance.calibration = scaled * scaled.transpose();
  return covariance;
}

EndEffectorPose endEffectorPose(const Pose& camera_from_station_seed,
                                const Pose& camera_from_station,
                                const Pose& camera_from_end_effector, const Matrix6d& covariance) {
  EndEffectorPose end_effector_pose;
  end_effector_pose.station_from_end_effector =
      camera_from_station.inverse() * camera_from_end_effector;
  end_effector_pose.end_effector_seed_from_end_effector_estimated =
      camera_from_end_effector.inverse() * camera_from_station_seed *
      end_effector_pose.station_from_end_effector;
  // camera_from_station -> Exp(xi) camera_from_station turns station_from_end_effector into
  // camera_from_station^-1 Exp(-xi) camera_from_end_effector, which is it times Exp(-Ad xi).
  const Matrix6d turn = adjointOf(camera_from_end_effector.inverse());
  end_effector_pose.covariance = turn * covariance * turn.transpose();
  return end_effector_pose;
}

}  // namespace boresight::sessions
