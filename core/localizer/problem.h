// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "core/base/image.h"
#include "core/geometry/camera.h"
#include "core/geometry/mesh.h"
#include "core/geometry/pose.h"

namespace boresight {

/// Input of one localization. The caller owns all data, which must outlive the run.
struct LocalizationProblem {
  ImageView image;                   ///< 8-bit gray, of the camera's size
  ColorView color;                   ///< of the same pixels; may be without data
  const BitImage* ignore = nullptr;  ///< set bits are ignored; the image's size; may be nullptr
  Camera camera;                     ///< after prepareCamera
  MeshView mesh;                     ///< the scene
  Pose camera_from_station_seed;     ///< where the search begins
  SeedUncertainty uncertainty;       ///< how far the truth may be from the seed
  /// End effector, fixed to the camera; the camera's centre if unknown. For
  /// CorrectionPoint::kEndEffector.
  Eigen::Vector3d end_effector_in_camera_m = Eigen::Vector3d::Zero();
};

/// Start pose of a localization with its uncertainty.
struct Seed {
  Pose camera_from_station;     ///< the pose to search around
  SeedUncertainty uncertainty;  ///< how far it may be off
};
inline Seed seedOf(const LocalizationProblem& problem) {
  return {problem.camera_from_station_seed, problem.uncertainty};
}

/// Sizes that decide how much memory a run needs.
struct ProblemSize {
  int width = 0;                              ///< px
  int height = 0;                             ///< px
  int vertices = 0;                           ///< of the mesh
  int faces = 0;                              ///< of the mesh
  int parts = 1;                              ///< of the scene
  CameraModel model = CameraModel::kPinhole;  ///< of the camera
};
inline ProblemSize sizeOf(const LocalizationProblem& problem) {
  return {problem.image.width,
          problem.image.height,
          static_cast<int>(problem.mesh.vertices_in_station_m.size()),
          static_cast<int>(problem.mesh.faces.size()),
          static_cast<int>(problem.mesh.parts.size()),
          problem.camera.model};
}

}  // namespace boresight
