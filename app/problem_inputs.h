// SPDX-License-Identifier: Apache-2.0
// What localize and problem share: the arguments and files that make up one localization.
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "app/commands.h"
#include "core/localizer/problem.h"
#include "sessions/io/image_file.h"
#include "sessions/io/pose_file.h"
#include "sessions/io/scene_mesh.h"

namespace boresight::app {

/// --image, --camera, --mesh, --seed and what belongs to them.
struct InputArguments {
  std::string image, camera, seed, ignore;
  MeshArguments mesh;
  FrameArguments frames;
  OptionArguments options;
  double feature_size_m = 0.0;
  std::vector<double> uncertainty;
  std::string pivot;
  int bit_depth = 0;

  void addTo(CLI::App& command);
  /// The image itself where its label is the camera.
  const std::string& cameraFile() const { return camera.empty() ? image : camera; }
};

/// Everything that was read, and the problem that points into it.
struct ProblemInputs {
  sessions::GrayImage image;
  Camera camera;
  sessions::SceneMesh scene;
  sessions::PoseFrames frames;
  sessions::PoseFile seed;
  std::optional<sessions::IgnoreMask> ignore_mask;
  BitImage ignore;
  sessions::DeclaredUncertainty uncertainty;
  LocalizerOptions options;
  std::vector<std::string> notes;  ///< said when everything has been accepted

  LocalizationProblem problem() const;
};

/// InputError, CLI::ValidationError.
ProblemInputs readProblemInputs(const InputArguments& arguments);

/// InputError naming `seed_file` (or the mesh's) when the seed does not see the station.
void requireSensibleSeed(const ProblemInputs& inputs, const std::string& seed_file);

}  // namespace boresight::app
