// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "core/base/image.h"
#include "core/geometry/camera.h"
#include "core/geometry/mesh.h"
#include "core/geometry/pose.h"

namespace boresight {

/// What one localization works on; everything is the caller's and must outlive the run.
struct LocalizationProblem {
  ImageView image;                   ///< 8-bit gray, of the camera's size
  const BitImage* ignore = nullptr;  ///< set bits are not trusted; the image's size; may be nullptr
  Camera camera;                     ///< after prepareCamera
  MeshView mesh;
  Pose camera_from_station_seed;
  SeedUncertainty uncertainty;
};

/// Sizes that decide how much memory a run needs.
struct ProblemSize {
  int width = 0;
  int height = 0;
  int vertices = 0;
  int faces = 0;
  int parts = 1;
  CameraModel model = CameraModel::kPinhole;
  bool ignore = false;
};
ProblemSize sizeOf(const LocalizationProblem& problem);

}  // namespace boresight
