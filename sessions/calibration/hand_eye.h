// SPDX-License-Identifier: Apache-2.0
// Pose of the camera on the arm, from poses of both: base_from_end_effector by telemetry,
// camera_from_station by images (AX = ZB; Tsai and Lenz 1989, Strobl and Hirzinger 2006).
#pragma once

#include <cstddef>
#include <span>
#include <vector>

#include "core/geometry/pose.h"
#include "sessions/calibration/information.h"

namespace boresight::sessions {

/// A posture of the arm in which the station was localized.
struct ArmPosture {
  Pose base_from_end_effector;        ///< by telemetry
  Pose camera_from_station;           ///< by the image
  double sigma_rotation_rad = 1e-3;   ///< of both together, per axis
  double sigma_translation_m = 1e-3;  ///< of both together, per axis, at the end effector
  std::size_t station = 0;            ///< number of the localized station, from 0
};

struct HandEye {
  Pose camera_from_end_effector;
  std::vector<Pose> base_from_station;  ///< by station
  /// Over (rotation rad, translation m) of camera_from_end_effector, left perturbation, camera
  /// frame, without undetermined directions.
  Matrix6d covariance = Matrix6d::Zero();
  std::vector<CalibrationParameter> parameters;  ///< changes from the start, with sigmas
  std::vector<Undetermined> undetermined;
  double noise_factor = 1.0;  ///< as of CameraCalibration
};

/// Adjusts the camera's transform from `camera_from_end_effector_start`, and that of each station.
/// Postures that turn about one axis only leave a direction undetermined, as listed in
/// `undetermined`. std::invalid_argument for fewer than three postures, or fewer than one more than
/// stations, std::runtime_error when the adjustment does not converge.
HandEye calibrateHandEye(std::span<const ArmPosture> postures,
                         const Pose& camera_from_end_effector_start);

}  // namespace boresight::sessions
