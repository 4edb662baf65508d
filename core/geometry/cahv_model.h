// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <Eigen/Core>

#include "core/base/status.h"
#include "core/geometry/camera.h"
#include "core/geometry/pose.h"

namespace boresight {

/// A camera as in labels of planetary images: vectors in a frame of the vehicle or the site (the
/// reference frame). The centre of the top-left pixel is (0, 0).
struct CahvModel {
  CameraModel model = CameraModel::kCahv;         ///< kCahv, kCahvor or kCahvore
  Eigen::Vector3d c_m = Eigen::Vector3d::Zero();  ///< centre
  Eigen::Vector3d a = Eigen::Vector3d::UnitZ();  ///< axis; rounded labels are not quite of length 1
  Eigen::Vector3d h_px = Eigen::Vector3d::Zero();  ///< horizontal: x = (P - C).H / (P - C).A
  Eigen::Vector3d v_px = Eigen::Vector3d::Zero();  ///< vertical
  Eigen::Vector3d o = Eigen::Vector3d::UnitZ();    ///< optical axis; CAHVOR and CAHVORE
  Eigen::Vector3d r = Eigen::Vector3d::Zero();     ///< radial terms; CAHVOR and CAHVORE
  Eigen::Vector3d e_m = Eigen::Vector3d::Zero();   ///< entrance pupil terms; CAHVORE
  int type = 1;                                    ///< CAHVORE: 1 perspective, 2 fisheye, 3 general
  double parameter = 1.0;                          ///< CAHVORE type 3 only: linearity

  bool operator==(const CahvModel&) const = default;
};

/// The camera in its own frame, and the pose of that frame: origin C, z = A, x along the part of H
/// across A, y = z cross x. A part of V along x becomes the skew; a V against y gives a mirrored
/// image (fy < 0). A, H and V are scaled together to |A| = 1, which changes no pixel; O is
/// normalized. kInvalidCamera when A or O are not within 1e-3 of length 1, an H or V is along A, or
/// the lens is invalid (see prepareCamera).
Status cameraFromCahv(const CahvModel& cahv, int width, int height, Camera& camera,
                      Pose& camera_from_reference);

/// The inverse of cameraFromCahv, with A and O of length 1.
CahvModel cahvFromCamera(const Camera& camera, const Pose& camera_from_reference);

}  // namespace boresight
