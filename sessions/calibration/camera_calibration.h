// SPDX-License-Identifier: Apache-2.0
// A camera from many images of a station, by bundle adjustment (Triggs et al. 2000).
#pragma once

#include <span>
#include <string>
#include <vector>

#include <Eigen/Core>

#include "core/geometry/camera.h"
#include "sessions/calibration/information.h"
#include "sessions/calibration/observations.h"
#include "sessions/io/cameras/camera_file.h"

namespace boresight::sessions {

/// Parameters to be adjusted; the others are kept. The distortion of CAHV-family and pinhole
/// cameras is always kept.
struct FreeParameters {
  bool focal = true;
  bool centre = true;
  bool distortion = false;
};

/// The adjusted camera. Parameters: `focal_relative` (change of fx and fy together),
/// `centre_x_px`, `centre_y_px` (changes), and the distortion's coefficients (values).
struct CameraCalibration {
  Camera camera;
  std::vector<CalibrationParameter> parameters;
  /// Of the parameters in their order, without undetermined directions.
  Eigen::MatrixXd covariance;
  std::vector<Undetermined> undetermined;
  std::vector<Pose> camera_from_station;  ///< by view
  double rms_px = 0.0;
  /// Root of the weighted squares over the degrees of freedom: 1 when the observations are as
  /// accurate as their sigmas state; multiplies all sigmas where above 1.
  double noise_factor = 1.0;
  int degrees_of_freedom = 0;

  /// For camera.json; empty unless focal length and centre are determined.
  std::optional<CalibrationSigma> sigma() const;
};

/// Adjusts the camera and the pose of every view, with a Cauchy loss of 3 sigma. All views are of
/// one camera. `std::invalid_argument` when nothing is free, there are no views, or fewer
/// observations than unknowns; `std::runtime_error` when the adjustment does not converge.
CameraCalibration calibrateCamera(const Camera& camera, std::span<const CalibrationView> views,
                                  const FreeParameters& free);

/// Calibrates the camera of a case from all cases of the session that have the same camera.
/// InputError for a case that does not exist; otherwise as above.
CameraCalibration calibrateCameraOf(const Session& session, const std::string& case_id,
                                    ObservationSource source, const FreeParameters& free);

/// The same session with the adjusted camera and its sigmas in all cases with the camera of this
/// case.
Session withCalibration(const Session& session, const std::string& case_id,
                        const CameraCalibration& calibration);

}  // namespace boresight::sessions
