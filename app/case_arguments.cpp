// SPDX-License-Identifier: Apache-2.0
#include "app/case_arguments.h"

#include <iterator>

#include "sessions/io/cameras/camera_field.h"
#include "sessions/io/files/errors.h"
#include "sessions/run/problem.h"
#include "sessions/session/input_sheet.h"

namespace boresight::app {
namespace {

/// CLI::ValidationError.
sessions::Requirement requirementOf(const std::vector<double>& numbers) {
  sessions::Requirement requirement;
  if (numbers.size() == 2)
    throw CLI::ValidationError("--requirement", "takes three numbers (mm, mm, deg), or one (px)");
  if (numbers.size() == 1) {
    requirement.projection_px = numbers[0];
    return requirement;
  }
  requirement.normal_mm = numbers[0];
  requirement.lateral_mm = numbers[1];
  requirement.rotation_deg = numbers[2];
  return requirement;
}

}  // namespace

void CaseArguments::addTo(CLI::App& command) {
  addFile(command, "--image", image, "PNG, JPEG, TIFF, VICAR, PDS3 or PDS4");
  addFile(command, "--camera", camera, kOwnCameraHelp);
  addFile(command, "--mesh", mesh, kMeshHelp);
  addMeshUnit(command, mesh_unit, kMeshUnitHelp);
  addFile(command, "--seed", seed,
          "pose.json with the approximate pose of the camera (default: as --frames joins "
          "CAMERA and STATION)");
  frames.addTo(command);
  options.addTo(command);
  addOption(command, "--feature-size", "M", feature_size_m,
            "Size of the station's features (sleeves, screws), m; 0: from the mesh's size")
      ->check(numberIn(0.0, 100.0));
  addFile(command, "--ignore", ignore, "Mask image of the same size: nonzero pixels are ignored");
  addOption(command, "--bit-depth", "N", bit_depth,
            "Bit depth of the image's samples, e.g. 12 in a 16-bit file")
      ->check(CLI::Range(1, 16));
  addOption(command, "--levels", "BLACK WHITE", levels,
            "Samples that become 0 and 255, e.g. 1489 5828 of a radiometric product (default: "
            "the whole range of the bit depth)")
      ->expected(2)
      ->check(CLI::Range(0, 65535));
  addChoice(command, "--bayer", bayer,
            std::vector<std::string>(std::begin(sessions::kBayerPatternNames),
                                     std::end(sessions::kBayerPatternNames)),
            "The samples are a mosaic of colours, whose first two lines begin like this");
}

void CaseArguments::addEndEffectorTo(CLI::App& command) {
  addOption(command, "--end-effector", "X Y Z M", end_effector_m,
            "End effector in the camera frame (default: as --frames joins CAMERA and "
            "END_EFFECTOR)")
      ->expected(3)
      ->check(numberIn(-100.0, 100.0));
}

void CaseArguments::addRequirementTo(CLI::App& command) {
  addOption(command, "--requirement", "MM MM DEG", requirement,
            "Largest normal and lateral error (mm) and rotation (deg), or one number: px in "
            "the image")
      ->expected(1, 3)
      ->check(numberIn(1e-6, 1e6));
}

void CaseArguments::addSymmetryTo(CLI::App& command) {
  addOption(command, "--symmetry", "TEXT", symmetries,
            "Turns after which the station looks the same, so that poses count as the same: \"z\" "
            "any about its z axis, \"z 90\" by multiples of 90 deg, \"z 90 at X Y Z\" about a "
            "line through a point (m), \"none\"; may be repeated");
}

std::optional<sessions::Symmetries> CaseArguments::statedSymmetries() const {
  if (symmetries.empty()) return std::nullopt;
  std::string text;
  for (const std::string& each : symmetries) text += (text.empty() ? "" : ";") + each;
  try {
    return sessions::symmetriesIn(text);
  } catch (const sessions::InputError& error) {
    const std::string item = error.field().empty() ? "" : error.field() + ": ";
    throw CLI::ValidationError("--symmetry", item + error.reason());
  }
}

void CaseArguments::addUncertaintyTo(CLI::App& command) {
  addUncertainty(command, uncertainty,
                 "Largest error of the seed along and about x, y, z of the camera: three lengths "
                 "in m, three angles in deg (default: those in the seed's file)");
  addChoice(command, "--pivot", pivot, {"camera", "station"},
            "Centre of the seed's rotation uncertainty: camera (an arm camera) or station");
}

CLI::Option* CaseArguments::addTruthTo(CLI::App& command) {
  return addFile(command, "--truth", truth, "pose.json with the true pose");
}

void CaseArguments::requireSeed() const {
  if (seed.empty() && frames.files.empty()) throw CLI::RequiredError("--seed (or --frames)");
}

sessions::CaseFiles CaseArguments::files() const {
  sessions::CaseFiles files;
  files.image = image;
  if (bit_depth > 0) files.eight_bit.bit_depth = bit_depth;
  if (!levels.empty()) {
    if (levels[0] >= levels[1]) throw CLI::ValidationError("--levels", "black must be below white");
    files.eight_bit.levels = sessions::GrayLevels{levels[0], levels[1]};
  }
  if (!bayer.empty()) files.eight_bit.bayer = sessions::bayerPatternNamed(bayer);
  files.camera = camera;
  files.transforms.assign(frames.files.begin(), frames.files.end());
  files.parts.resize(1);
  files.parts[0].mesh = mesh;
  files.parts[0].mesh_unit = mesh_unit;
  files.seed = seed;
  if (!truth.empty()) files.truth = truth;
  if (!ignore.empty()) files.ignore = ignore;
  if (feature_size_m > 0.0) files.feature_size_m = feature_size_m;
  if (!uncertainty.empty()) setUncertainty(uncertainty, files.uncertainty.emplace());
  if (!end_effector_m.empty())
    files.camera_from_end_effector.emplace().translation_m =
        Eigen::Map<const Eigen::Vector3d>(end_effector_m.data());
  if (!requirement.empty()) files.requirement = requirementOf(requirement);
  files.symmetries = statedSymmetries().value_or(sessions::Symmetries());
  if (!pivot.empty())
    files.pivot = pivot == "station" ? sessions::UncertaintyPivot::kStation
                                     : sessions::UncertaintyPivot::kCamera;
  return files;
}

LocalizerOptions CaseArguments::optionsOf(const sessions::SessionCase& session_case) const {
  LocalizerOptions result = options.read();
  double& size_m = result.templates.feature_size_m;
  if (feature_size_m > 0.0) size_m = feature_size_m;
  if (size_m == 0.0) size_m = session_case.feature_size_m.value_or(0.0);
  return result;
}

ReadCase readCase(const CaseArguments& arguments) {
  (void)arguments.options.read();  // unknown options are rejected before files are read
  sessions::MadeCase new_case = sessions::makeCase(arguments.files());
  ReadCase read{sessions::loadCase(new_case.made), std::move(new_case.notes)};
  for (std::string& warning : sessions::labelWarnings(read.loaded->source))
    read.notes.push_back(std::move(warning));
  for (std::string& text : sessions::fileNotes(*read.loaded)) read.notes.push_back(std::move(text));
  return read;
}

void requireRunnable(const sessions::LoadedCase& loaded, const std::string& camera_file,
                     const std::string& seed_file) {
  const sessions::SessionCase& session_case = loaded.source;
  if (!session_case.has_seed)
    throw sessions::InputError(
        seed_file,
        "the transforms do not join CAMERA and STATION; add the missing one, "
        "or give a seed");
  sessions::requireSameSize(loaded.image, session_case.camera);
  sessions::requireField(camera_file, "distortion", session_case.camera);
  sessions::requireSensibleSeed(session_case.camera, loaded.scene,
                                session_case.camera_from_station_seed, seed_file,
                                "camera_from_station");
}

}  // namespace boresight::app
