// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "core/geometry/pose.h"

namespace boresight::sessions {

/// Covariance of a pose by its causes, which are independent: over (rotation rad, translation m),
/// left perturbation, camera frame.
struct PoseCovariance {
  Matrix6d picture = Matrix6d::Zero();      ///< of the picture or the marks alone; zero: not known
  Matrix6d mesh_scale = Matrix6d::Zero();   ///< of the mesh's scale, which no single image shows
  Matrix6d calibration = Matrix6d::Zero();  ///< of focal length and principal point

  bool known() const { return picture.allFinite() && !picture.isZero(0.0); }
  /// Zero when it is not known.
  Matrix6d total() const {
    return known() ? Matrix6d(picture + mesh_scale + calibration) : Matrix6d::Zero();
  }

  bool operator==(const PoseCovariance&) const = default;
};

}  // namespace boresight::sessions
