// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <cstdint>

#include <Eigen/Core>

#include "core/base/status.h"

namespace boresight {

/// Pixel frame: x right, y down, the *centre* of the top-left pixel is (0, 0) (OpenCV).
/// Camera frame: x right, y down, z forward, metres.
enum class CameraModel : std::int32_t { kPinhole = 0, kBrownConrady = 1, kKannalaBrandt = 2 };

/// A calibrated camera: a tagged struct with a switch, not a class hierarchy.
struct Camera {
  CameraModel model = CameraModel::kPinhole;
  int width = 0;
  int height = 0;
  double fx = 0.0, fy = 0.0;  ///< px
  double cx = 0.0, cy = 0.0;  ///< px
  /// Brown-Conrady in OpenCV order k1 k2 p1 p2 k3 k4 k5 k6; Kannala-Brandt k1..k4 (OpenCV fisheye).
  std::array<double, 8> distortion{};
  /// Largest undistorted radius |(x/z, y/z)| (Brown-Conrady) or angle theta in rad (Kannala-Brandt)
  /// up to which the distortion is one-to-one: the radial polynomial increases, by more than the
  /// tangential terms can take back in any direction. Set by `prepareCamera`; until then nothing
  /// projects. At most 1e4, and smaller where |(u - cx) / fx, (v - cy) / fy| would exceed 1e4.
  double valid_radius = 0.0;

  bool operator==(const Camera&) const = default;
};

/// Checks the parameters (finite, focal lengths and sizes positive) and computes the valid field.
/// kInvalidCamera when they cannot be those of a camera. Call once after filling a Camera;
/// projection outside the valid field then says so instead of folding back into the image.
Status prepareCamera(Camera& camera);

/// Pixel of a point in the camera frame. False when the point is behind the camera (z <= 0) or
/// outside the valid field of the distortion model; the pixel may lie outside the image.
[[nodiscard]] bool project(const Camera& camera, const Eigen::Vector3d& point_in_camera_m,
                           Eigen::Vector2d& pixel);
/// The same with d pixel / d point (2x3, px per m).
[[nodiscard]] bool projectWithJacobian(const Camera& camera,
                                       const Eigen::Vector3d& point_in_camera_m,
                                       Eigen::Vector2d& pixel,
                                       Eigen::Matrix<double, 2, 3>& jacobian);
/// Ray (x/z, y/z, 1) through a pixel (any real coordinates, also outside the image). False where
/// the model has no inverse or the ray does not point forward. project(unproject(p)) == p to 1e-6
/// px.
[[nodiscard]] bool unproject(const Camera& camera, const Eigen::Vector2d& pixel,
                             Eigen::Vector3d& ray);

/// The camera of an image pooled by 2^level: pixel centres move by x_level = (x + 0.5) / 2^level -
/// 0.5; the size is rounded up.
Camera cameraAtLevel(const Camera& camera, int level);

}  // namespace boresight
