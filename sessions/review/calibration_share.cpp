// SPDX-License-Identifier: Apache-2.0
#include "sessions/review/calibration_share.h"

#include "core/pnp/normal_equations.h"

namespace boresight::sessions {

std::optional<Eigen::Matrix<double, 6, 3>> poseByCamera(std::span<const PredictedPlace> places,
                                                        const Camera& camera,
                                                        const Pose& camera_from_station) {
  Matrix6d information = Matrix6d::Zero();
  Eigen::Matrix<double, 6, 3> right = Eigen::Matrix<double, 6, 3>::Zero();
  for (const PredictedPlace& place : places) {
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

std::optional<Matrix6d> calibrationCovariance(std::span<const PredictedPlace> places,
                                              const Camera& camera, const Pose& camera_from_station,
                                              double focal_sigma_px, double centre_sigma_px) {
  if (focal_sigma_px == 0.0 && centre_sigma_px == 0.0) return Matrix6d::Zero();
  const auto follow = poseByCamera(places, camera, camera_from_station);
  if (!follow) return {};
  const Eigen::Vector3d sigmas_px(focal_sigma_px, centre_sigma_px, centre_sigma_px);
  const Eigen::Matrix<double, 6, 3> scaled = *follow * sigmas_px.asDiagonal();
  return Matrix6d(scaled * scaled.transpose());
}

}  // namespace boresight::sessions
