// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <cstdint>

#include <Eigen/Core>

#include "core/base/status.h"

namespace boresight {

/// Pixel frame: x right, y down, the *centre* of the top-left pixel is (0, 0) (OpenCV).
/// Camera frame: x right, y down, z forward, metres.
enum class CameraModel : std::int32_t {
  kPinhole = 0,
  kBrownConrady = 1,
  kKannalaBrandt = 2,
  kCahv = 3,
  kCahvor = 4,
  kCahvore = 5
};
inline constexpr CameraModel kLastCameraModel = CameraModel::kCahvore;

/// The models of planetary cameras (Yakimovsky and Cunningham 1978; Gennery 2006), whose vectors
/// are kept in the camera frame: C = 0, A = (0, 0, 1), H = (fx, 0, cx), V = (skew_px, fy, cy).
inline bool isCahvFamily(CameraModel model) { return model >= CameraModel::kCahv; }

/// Parameters of those models in addition to fx .. cy. cahv_model.h computes them from vectors in
/// any frame.
struct CahvLens {
  double skew_px = 0.0;  ///< V along x: 0 when the image's axes are square to each other
  Eigen::Vector3d optical_axis = Eigen::Vector3d::UnitZ();  ///< O, of unit length
  Eigen::Vector3d radial = Eigen::Vector3d::Zero();         ///< R = (r0, r1, r2)
  /// E = (e0, e1, e2): the entrance pupil, from which a ray at the angle theta to O starts, lies at
  /// (theta / sin theta - 1) (e0 + e1 theta^2 + e2 theta^4) along O. CAHVORE.
  Eigen::Vector3d entrance_m = Eigen::Vector3d::Zero();
  double linearity = 1.0;  ///< L of CAHVORE: 1 perspective (type 1), 0 fisheye (type 2), or between
  /// Range of the entrance pupil along O over all rays in and around the image; from
  /// `prepareCamera`.
  double pupil_low_m = 0.0;
  double pupil_high_m = 0.0;  ///< the far end of the same range

  bool operator==(const CahvLens&) const = default;
};

/// A calibrated camera.
struct Camera {
  CameraModel model = CameraModel::kPinhole;  ///< how a ray becomes a pixel
  int width = 0;                              ///< px
  int height = 0;                             ///< px
  double fx = 0.0, fy = 0.0;  ///< px; fy < 0 (CAHV family only) where y runs up the image
  double cx = 0.0, cy = 0.0;  ///< px
  /// Brown-Conrady in OpenCV order k1 k2 p1 p2 k3 k4 k5 k6; Kannala-Brandt k1..k4 (OpenCV fisheye).
  std::array<double, 8> distortion{};
  CahvLens cahv;  ///< CAHV family only
  /// Largest undistorted radius |(x/z, y/z)| (Brown-Conrady), tangent of the angle to O (CAHVOR) or
  /// angle theta in rad (Kannala-Brandt; to O: CAHVORE) up to which the distortion is one-to-one:
  /// the radial polynomial increases by more than the tangential terms reduce it in any direction.
  /// `prepareCamera` sets it; before, all projections fail. At most 1e4, and less where |(u - cx) /
  /// fx, (v - cy) / fy| would exceed 1e4.
  double valid_radius = 0.0;

  bool operator==(const Camera&) const = default;
};

/// Checks the parameters (finite, focal lengths and sizes positive) and computes the valid field.
/// kInvalidCamera when a check fails or the field is empty. Call once after filling a Camera;
/// projection outside the valid field then returns false instead of folding back into the image.
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
/// Direction (x/z, y/z, 1) of the ray through a pixel (any real coordinates, also outside the
/// image). False where the model has no inverse or the ray does not point forward.
/// project(unproject(p)) == p to 1e-6 px; with CAHVORE the ray starts at the entrance pupil.
[[nodiscard]] bool unproject(const Camera& camera, const Eigen::Vector2d& pixel,
                             Eigen::Vector3d& ray);

/// The ray of a pixel: the points origin_m + depth direction, depth > 0. A point's depth is its z
/// measured from the pupil; where all rays have one centre, the pupil is the origin.
struct Ray {
  Eigen::Vector3d origin_m = Eigen::Vector3d::Zero();    ///< camera frame
  Eigen::Vector3d direction = Eigen::Vector3d::UnitZ();  ///< (x/z, y/z, 1)

  /// The point of the ray at a depth.
  Eigen::Vector3d at(double depth_m) const { return origin_m + direction * depth_m; }
};
/// `unproject` with the origin of the ray.
[[nodiscard]] bool unprojectRay(const Camera& camera, const Eigen::Vector2d& pixel, Ray& ray);
/// Pixel of the ray with a direction (any length): `project` of a point infinitely far off, and the
/// inverse of `unproject`.
[[nodiscard]] bool projectDirection(const Camera& camera, const Eigen::Vector3d& direction,
                                    Eigen::Vector2d& pixel);
/// True when not all rays start at the camera's centre: CAHVORE whose pupil moves by more than 10
/// nm (a thousandth of a pixel at 10 mm).
inline bool pupilMoves(const Camera& camera) {
  return camera.cahv.pupil_high_m - camera.cahv.pupil_low_m > 1e-8;
}
/// A point relative to the entrance pupil of its ray: its direction is that of the ray, and its z
/// is the depth along the ray. Returns the point itself where the pupil does not move. For points
/// outside the image, the nearest pupil position of the image's rays is used.
Eigen::Vector3d seenFromPupil(const Camera& camera, const Eigen::Vector3d& point_in_camera_m);

/// Whether the image is mirrored (left-handed axes).
inline bool isMirrored(const Camera& camera) { return camera.fy < 0.0; }

/// The camera of a part of the image, or of a larger one around it: the pixel `first` (any sign)
/// becomes (0, 0). The camera is prepared again; kInvalidCamera.
Status cutToFrame(int first_x, int first_y, int width, int height, Camera& camera);
/// The camera of an image pooled by 2^level: pixel centres move by x_level = (x + 0.5) / 2^level -
/// 0.5; the size is rounded up.
Camera cameraAtLevel(const Camera& camera, int level);
/// Pixels of the full image along a pixel of a level.
inline double levelScale(int level) { return static_cast<double>(1 << level); }
/// The pixel of the full image at a pixel of a level: x = (x_level + 0.5) 2^level - 0.5.
inline Eigen::Vector2d atFullResolution(const Eigen::Vector2d& level_px, int level) {
  return (level_px.array() + 0.5).matrix() * levelScale(level) - Eigen::Vector2d::Constant(0.5);
}

}  // namespace boresight
