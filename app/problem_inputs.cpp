// SPDX-License-Identifier: Apache-2.0
#include "app/problem_inputs.h"

#include "sessions/io/camera_field.h"
#include "sessions/io/camera_file.h"
#include "sessions/run/problem.h"

namespace boresight::app {
namespace {

sessions::DeclaredUncertainty declaredUncertainty(const InputArguments& arguments,
                                                  const sessions::PoseFile& seed) {
  sessions::DeclaredUncertainty declared =
      seed.uncertainty.value_or(sessions::DeclaredUncertainty());
  setUncertainty(arguments.uncertainty, declared);
  if (!arguments.pivot.empty())
    declared.pivot = arguments.pivot == "station" ? sessions::UncertaintyPivot::kStation
                                                  : sessions::UncertaintyPivot::kCamera;
  return declared;
}

}  // namespace

void InputArguments::addTo(CLI::App& command) {
  addFile(command, "--image", image, "PNG, JPEG, TIFF, VICAR, PDS3 or PDS4")->required();
  addFile(command, "--camera", camera, kOwnCameraHelp);
  mesh.addTo(command);
  addFile(command, "--seed", seed, "pose.json: where the camera is believed to be")->required();
  frames.addTo(command);
  options.addTo(command);
  command
      .add_option("--feature-size", feature_size_m,
                  "Size of the station's features (sleeves, screws), m; 0: from the mesh's size")
      ->check(numberIn(0.0, 100.0))
      ->type_name("M");
  addUncertainty(command, uncertainty,
                 "How far the seed may be off along and about x, y, z of the camera: three "
                 "lengths in m, three angles in deg (instead of what the seed's file states)");
  command
      .add_option("--pivot", pivot,
                  "What the seed's rotation is uncertain about: camera (an arm camera) or station")
      ->check(CLI::IsMember({"camera", "station"}));
  addFile(command, "--ignore", ignore,
          "Mask image of the same size: nonzero pixels are not trusted");
  command
      .add_option("--bit-depth", bit_depth,
                  "Bits that the image's samples use, e.g. 12 in a 16-bit file")
      ->check(CLI::Range(1, 16))
      ->type_name("N");
}

LocalizationProblem ProblemInputs::problem() const {
  return sessions::problemOf(image, ignore_mask ? &ignore : nullptr, camera, scene.view(),
                             seed.camera_from_station, uncertainty);
}

ProblemInputs readProblemInputs(const InputArguments& arguments) {
  ProblemInputs inputs;
  inputs.options = arguments.options.read();
  if (arguments.feature_size_m > 0.0)
    inputs.options.templates.feature_size_m = arguments.feature_size_m;
  const sessions::CameraFile camera = sessions::readChosenCamera(arguments.camera, arguments.image);
  inputs.camera = camera.camera;
  inputs.frames = arguments.frames.of(camera);
  inputs.seed = sessions::readPose(std::filesystem::path(arguments.seed), inputs.frames);
  sessions::ImageReadOptions reading;
  if (arguments.bit_depth > 0) reading.bit_depth = arguments.bit_depth;
  inputs.image = sessions::readImage(arguments.image, reading);
  sessions::requireSameSize(inputs.image, inputs.camera);
  sessions::requireField(arguments.cameraFile(), "distortion", inputs.camera);
  if (!arguments.ignore.empty()) {
    inputs.ignore_mask =
        sessions::readIgnoreMask(arguments.ignore, inputs.image.width, inputs.image.height);
    inputs.ignore = inputs.ignore_mask->view();
  }
  inputs.scene = arguments.mesh.read();
  inputs.uncertainty = declaredUncertainty(arguments, inputs.seed);
  if (!inputs.seed.uncertainty && arguments.uncertainty.empty())
    inputs.notes.push_back(
        "the seed states no uncertainty; taking 0.03 m and 5 deg (see --uncertainty)");
  const std::string projected = sessions::projectionNote(inputs.seed.rotation_deviation);
  if (!projected.empty()) inputs.notes.push_back(arguments.seed + ": " + projected);
  return inputs;
}

void requireSensibleSeed(const ProblemInputs& inputs, const std::string& seed_file) {
  sessions::requireSensibleSeed(inputs.camera, inputs.scene, inputs.seed.camera_from_station,
                                seed_file, "camera_from_station");
}

}  // namespace boresight::app
