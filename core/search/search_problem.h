// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "core/base/image.h"
#include "core/geometry/camera.h"
#include "core/geometry/mesh.h"
#include "core/geometry/pose.h"

namespace boresight {

/// Input of a search; the data that it points to must outlive the search.
struct SearchProblem {
  ImageView image;                   ///< 8-bit gray, raw, of the camera's size
  ColorView color;                   ///< of the same pixels; may be without data
  const BitImage* ignore = nullptr;  ///< set bits are ignored; may be nullptr
  Camera camera;                     ///< prepared
  MeshView mesh;                     ///< the scene
  BoundingBox scene;                 ///< of the matched parts
  Pose camera_from_station_seed;     ///< centre of the searched range
  SeedUncertainty uncertainty;       ///< how far the truth may be from the seed
  /// The image is flipped left-right about the camera's axis, and poses refer to the flipped
  /// camera: the image then shows the mirror image of the mesh. Parts that are fixed to the camera
  /// are not flipped.
  bool flipped = false;

  /// Converts a ray of the (flipped) pose camera to one of the image's camera, and back.
  Eigen::Vector3d seenAlong(const Eigen::Vector3d& ray) const {
    return flipped ? Eigen::Vector3d(-ray.x(), ray.y(), ray.z()) : ray;
  }
};

}  // namespace boresight
