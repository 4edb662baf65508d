// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <algorithm>
#include <cstdint>
#include <filesystem>
#include <string>

#include "core/localizer/problem.h"
#include "sessions/io/cameras/pose_file.h"
#include "sessions/io/images/camera_of_file.h"
#include "sessions/io/images/image_file.h"
#include "sessions/io/meshes/scene_mesh.h"

namespace boresight::test {

/// The folder of the example that ships; tests that use it define BORESIGHT_EXAMPLES.
inline std::filesystem::path exampleFolder() {
  return std::filesystem::path(BORESIGHT_EXAMPLES) / "stations";
}

/// One station of the example with everything a run needs.
struct ExampleCase {
  sessions::GrayImage image;
  Camera camera;
  sessions::SceneMesh scene;
  sessions::PoseFile seed;
  sessions::PoseFile truth;

  explicit ExampleCase(const std::string& station) {
    const std::filesystem::path folder = exampleFolder() / station;
    image = sessions::readImage(folder / "image.png");
    camera = sessions::readCamera(folder / "camera.json");
    seed = sessions::readPose(folder / "seed.json");
    truth = sessions::readPose(folder / "truth.json");
    sessions::PartSource part;
    part.mesh = folder / "model.ply";
    part.mesh_unit = "m";
    scene = sessions::readScene({&part, 1});
  }

  /// Points into this case.
  LocalizationProblem problem() const {
    LocalizationProblem localization_problem;
    localization_problem.image = image.view();
    localization_problem.camera = camera;
    localization_problem.mesh = scene.view();
    localization_problem.camera_from_station_seed = seed.camera_from_station;
    localization_problem.uncertainty = sessions::seedUncertainty(
        seed.uncertainty.value(), seed.camera_from_station, matchedBounds(scene.view()).centre());
    return localization_problem;
  }
};

/// Station os, read once.
inline const ExampleCase& osExample() {
  static const ExampleCase example("os");
  return example;
}

/// Width of the plate of halfHiddenImage(), px.
inline constexpr int kHidden_px = 320;

/// The image of station os with a plate over its left: a run with its feature size finds the pose
/// with a probability of 13 %.
inline sessions::GrayImage halfHiddenImage() {
  sessions::GrayImage image = osExample().image;
  for (int y = 0; y < image.height; ++y)
    std::fill_n(image.pixels.begin() + y * image.width, kHidden_px, std::uint8_t{90});
  return image;
}

}  // namespace boresight::test
