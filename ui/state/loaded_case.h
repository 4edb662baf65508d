// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <optional>

#include "core/localizer/problem.h"
#include "sessions/io/image_file.h"
#include "sessions/io/scene_mesh.h"

namespace boresight::ui {

/// Everything of one case in memory; never changed once it is shared.
struct LoadedCase {
  sessions::GrayImage image;
  std::optional<sessions::IgnoreMask> ignore_mask;
  BitImage ignore;  ///< of the mask
  Camera camera;
  sessions::SceneMesh scene;
  Pose camera_from_station_seed;
  SeedUncertainty uncertainty;
  std::optional<Pose> camera_from_station_truth;

  /// Points into this case.
  LocalizationProblem problem() const {
    LocalizationProblem made;
    made.image = image.view();
    made.ignore = ignore_mask ? &ignore : nullptr;
    made.camera = camera;
    made.mesh = scene.view();
    made.camera_from_station_seed = camera_from_station_seed;
    made.uncertainty = uncertainty;
    return made;
  }
};

}  // namespace boresight::ui
