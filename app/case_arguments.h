// SPDX-License-Identifier: Apache-2.0
// The arguments and files of one case: shared by localize, problem and new.
#pragma once

#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "app/commands.h"
#include "sessions/session/session_maker.h"

namespace boresight::app {

/// --image, --camera, --mesh, --seed and the options of a run.
struct CaseArguments {
  std::string image, camera, mesh, mesh_unit, seed, truth, ignore;
  FrameArguments frames;
  OptionArguments options;
  double feature_size_m = 0.0;
  int bit_depth = 0;
  std::vector<int> levels;
  std::string bayer;
  std::vector<double> uncertainty, end_effector_m, requirement;
  std::vector<std::string> symmetries;
  std::string pivot;

  /// Adds all options but --uncertainty, --pivot and --truth. None is required.
  void addTo(CLI::App& command);
  void addUncertaintyTo(CLI::App& command);
  void addEndEffectorTo(CLI::App& command);
  void addRequirementTo(CLI::App& command);
  void addSymmetryTo(CLI::App& command);
  CLI::Option* addTruthTo(CLI::App& command);
  /// The camera file; without it the image, for the camera model in its label.
  const std::string& cameraFile() const { return camera.empty() ? image : camera; }
  /// The seed file; without it the first file of transforms, which may join CAMERA and STATION.
  const std::string& seedFile() const {
    return seed.empty() && !frames.files.empty() ? frames.files.front() : seed;
  }
  /// CLI::RequiredError unless there is a seed, or transforms that may join CAMERA and STATION.
  void requireSeed() const;
  /// CLI::ValidationError.
  sessions::CaseFiles files() const;
  /// As declared; empty: nothing stated. CLI::ValidationError.
  std::optional<sessions::Symmetries> statedSymmetries() const;
  /// The options of a run: --feature-size, else --set or --config, else the case's feature size.
  LocalizerOptions optionsOf(const sessions::SessionCase& session_case) const;
};

/// A case that is ready to run, and notes for the operator.
struct ReadCase {
  std::shared_ptr<const sessions::LoadedCase> loaded;
  std::vector<std::string> notes;
};

/// InputError, CLI::ValidationError.
ReadCase readCase(const CaseArguments& arguments);

/// InputError, naming the file: image and camera differ in size, the distortion folds back within
/// the image, or the station is not visible from the seed.
void requireRunnable(const sessions::LoadedCase& loaded, const std::string& camera_file,
                     const std::string& seed_file);

}  // namespace boresight::app
