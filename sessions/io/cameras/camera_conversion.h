// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <filesystem>
#include <limits>
#include <string>

#include <Eigen/Core>

#include "core/geometry/camera.h"
#include "sessions/io/cameras/camera_file.h"

namespace boresight::sessions {

/// A camera of another model that approximates the given one in the same camera frame, so that
/// poses remain valid; with the approximation error.
struct FittedCamera {
  Camera camera;  ///< prepared
  /// Largest distance between the pixels of the given and the fitted camera for the same point,
  /// over the image and its border.
  double worst_error_px = 0.0;
  Eigen::Vector2d worst_pixel = Eigen::Vector2d::Zero();
  double rms_error_px = 0.0;
  /// The same for points infinitely far off, where the fit was made for a distance.
  double worst_error_far_px = 0.0;
  int checked_count = 0;
  /// Of those: pixels without a ray in the given camera, and points that the fitted one does not
  /// see.
  int without_ray_count = 0;
  int unseen_count = 0;
};

/// Least squares over a grid of the image: fx fy cx cy and the coefficients of `model`
/// (Brown-Conrady with k1 k2 p1 p2 k3, and with k4 k5 k6 where the worst error is smaller by it;
/// Kannala-Brandt; or a pinhole, whose error is the whole distortion). A camera whose entrance
/// pupil moves has no equivalent for all distances at once: the fit is for points `distance_m` from
/// the camera's centre, infinity for the rays alone. Fields of more than 120 deg are fitted from
/// the inside out, from several starts. The smallest mean square wins; pixels that the fitted
/// camera does not see count as 20 px off. std::invalid_argument for a model of the CAHV family,
/// whose vectors are exact as they are; std::runtime_error with a sentence when no such camera can
/// replace it: a mirrored image, or a fit that fails.
FittedCamera fitCamera(const Camera& given, CameraModel model,
                       double distance_m = std::numeric_limits<double>::infinity());

/// "worst error 0.83 px at (1023, 0), rms 0.21 px", and the counts of points not seen.
std::string fitText(const FittedCamera& fitted);

/// The fitted camera as camera.json, with the calibration_sigma of the given one (by its
/// covariance, if it has one), and its source and its errors in `fitted_from`. OutputError.
void writeFittedCamera(const std::filesystem::path& file, const FittedCamera& fitted,
                       const CameraFile& given, const std::string& given_name, double distance_m);

}  // namespace boresight::sessions
