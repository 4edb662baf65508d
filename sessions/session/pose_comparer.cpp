// SPDX-License-Identifier: Apache-2.0
#include "sessions/session/pose_comparer.h"

namespace boresight::sessions {

PoseComparer::PoseComparer(const LoadedCase& loaded)
    : PoseComparer(loaded.source, loaded.scene.view()) {}

PoseComparer::PoseComparer(const SessionCase& session_case, const MeshView& mesh)
    : camera_(session_case.camera),
      camera_from_end_effector_(session_case.camera_from_end_effector),
      symmetries_(session_case.symmetries),
      vertices_(matchedVertices(mesh)) {}

Pose PoseComparer::equivalent(const Pose& camera_from_station, const Pose& nearest_to) const {
  return nearestEquivalent(camera_from_station, nearest_to, model());
}

PoseError PoseComparer::difference(const Pose& camera_from_station_reference,
                                   const Pose& camera_from_station_estimated) const {
  return poseError(equivalent(camera_from_station_reference, camera_from_station_estimated),
                   camera_from_station_estimated, camera_from_end_effector_);
}

std::optional<double> PoseComparer::projection_px(const Pose& camera_from_station_reference,
                                                  const Pose& camera_from_station_estimated) const {
  if (!camera_) return std::nullopt;
  return projectionError(*camera_,
                         equivalent(camera_from_station_reference, camera_from_station_estimated),
                         camera_from_station_estimated, vertices_);
}

Matrix6d PoseComparer::determined(const Matrix6d& covariance,
                                  const Pose& camera_from_station) const {
  return determinedCovariance(covariance, camera_from_station, model());
}

std::optional<double> PoseComparer::projectionSigma_px(const Pose& camera_from_station,
                                                       const Matrix6d& covariance) const {
  if (!camera_) return std::nullopt;
  return projectionSigma(*camera_, camera_from_station, vertices_,
                         determined(covariance, camera_from_station));
}

PoseComparer differenceComparer(const LoadedCase& loaded) {
  return {loaded.source, loaded.source.symmetries.empty() ? MeshView() : loaded.scene.view()};
}

ComparisonLimits comparisonLimits(const LoadedCase& loaded) {
  ComparisonLimits limits;
  if (!loaded.source.symmetries.empty())
    limits.equivalent = [comparer = PoseComparer(loaded)](const Pose& pose,
                                                          const Pose& nearest_to) {
      return comparer.equivalent(pose, nearest_to);
    };
  return limits;
}

}  // namespace boresight::sessions
