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

/// Parameters to be adjusted; the others are kept. CAHV-family and pinhole cameras have no
/// distortion that can be adjusted.
struct FreeParameters {
  bool focal = true;
  bool centre = true;
  bool distortion = false;
};

/// Observations of a view whose residuals are beyond 10 sigma, in units of the noise factor: two
/// points may be swapped.
struct OutlyingView {
  std::string case_id;
  int far_out = 0;       ///< number of them
  int observations = 0;  ///< of the view
  double largest_px = 0.0;
};

/// "c3: 2 of 30 observations are far out, by up to 85.3 px: check for swapped pairs".
std::string outlyingText(const OutlyingView& view);

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
  /// As of NoiseMeter: 1 when the observations are as accurate as their sigmas state; multiplies
  /// all sigmas where above 1.
  double noise_factor = 1.0;
  int degrees_of_freedom = 0;
  std::vector<OutlyingView> outlying;  ///< views with observations far out, the farthest first

  /// For camera.json. Of what was not adjusted the `former` sigma, where that is stated; empty when
  /// nothing is stated, or the focal length or the centre was adjusted and is not determined.
  std::optional<StatedCalibration> sigma(const StatedCalibration& former) const;
};

/// Adjusts the camera and the pose of every view, with a Cauchy loss of 3 sigma. All views are of
/// one camera. `std::invalid_argument` when nothing is free, or the distortion of a camera without
/// one, there are no views, or fewer observations than unknowns; `std::runtime_error` when the
/// adjustment does not converge.
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
