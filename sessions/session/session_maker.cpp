// SPDX-License-Identifier: Apache-2.0
#include "sessions/session/session_maker.h"

#include <algorithm>
#include <map>
#include <system_error>

#include "sessions/evaluation/bop_dataset.h"
#include "sessions/io/camera_file.h"
#include "sessions/io/errors.h"
#include "sessions/session/check_limits.h"
#include "sessions/session/input_check.h"

namespace boresight::sessions {
namespace {

namespace fs = std::filesystem;

fs::path wholePath(const fs::path& file) { return fs::absolute(file).lexically_normal(); }

ImageInput imageInput(const fs::path& file, const ImageReadOptions& eight_bit) {
  const GrayImage image = readImage(file, eight_bit);
  ImageInput input;
  input.source = {wholePath(file), image.file_sha256};
  input.width = image.width;
  input.height = image.height;
  input.eight_bit = eight_bit;
  input.pixels_sha256 = image.pixels_sha256;
  if (image.label) input.label = image.label->identifiers;
  return input;
}

std::vector<MeshInput> meshInputs(const std::vector<PartSource>& parts) {
  const SceneMesh scene = readScene(parts);
  std::vector<MeshInput> inputs;
  for (std::size_t i = 0; i < parts.size(); ++i) {
    inputs.push_back({parts[i], scene.infos[i].file_sha256});
    inputs.back().source.mesh = wholePath(parts[i].mesh);
  }
  return inputs;
}

InputFile maskInput(const fs::path& file, const ImageInput& image) {
  return {wholePath(file), readIgnoreMask(file, image.width, image.height).file_sha256};
}

SessionCase caseOf(const Dataset& dataset, const Case& one, const ImageInput& image,
                   const std::vector<MeshInput>& parts) {
  if (!one.uncertainty)
    throw InputError(dataset.file, "cases." + one.id + ".uncertainty",
                     "neither the case nor its station states one");
  SessionCase made;
  made.id = one.id;
  made.station = one.station;
  made.image = image;
  made.camera = dataset.cameras.at(one.camera);
  if (const auto known = dataset.camera_references.find(one.camera);
      known != dataset.camera_references.end())
    made.camera_reference = known->second;
  if (const auto known = dataset.calibration_sigmas.find(one.camera);
      known != dataset.calibration_sigmas.end())
    made.calibration_sigma = known->second;
  made.parts = parts;
  made.feature_size_m = dataset.stations.at(one.station).feature_size_m;
  made.mesh_scale_sigma = dataset.stations.at(one.station).mesh_scale_sigma;
  made.camera_from_station_seed = one.seed_camera_from_station;
  made.station_frame = one.station_frame;
  made.uncertainty = *one.uncertainty;
  made.camera_from_station_truth = one.truth_camera_from_station;
  made.truth_frame = one.truth_frame;
  made.truth_covariance = one.truth_covariance;
  if (one.ignore) made.ignore = maskInput(*one.ignore, made.image);
  made.rig = one.rig;
  made.tags = one.tags;
  made.requirement = one.requirement;
  made.camera_from_end_effector = one.camera_from_end_effector;
  return made;
}

/// By what all of its cases ask for; the default when they ask for different things or nothing.
std::string presetOfAll(const Session& session) {
  std::string preset;
  for (const auto& one : session.cases) {
    const std::string own = one->requirement ? presetFor(*one->requirement).name : "";
    if (own.empty() || (!preset.empty() && own != preset)) return kDefaultCheckPreset;
    preset = own;
  }
  return preset.empty() ? kDefaultCheckPreset : preset;
}

}  // namespace

MadeCase makeCase(const CaseFiles& files) {
  MadeCase result;
  SessionCase& made = result.made;
  made.id = files.id.empty() ? files.image.stem().string() : files.id;
  made.image = imageInput(files.image, files.eight_bit);
  const CameraFile camera = readChosenCamera(files.camera, files.image);
  made.camera = camera.camera;
  made.camera_reference = camera.reference;
  made.calibration_sigma = camera.calibration_sigma;
  made.parts = meshInputs(files.parts);
  made.feature_size_m = files.feature_size_m;
  made.mesh_scale_sigma = files.mesh_scale_sigma;
  PoseFrames frames{camera.reference};
  for (const fs::path& file : files.transforms)
    frames.transforms.push_back(readFrameTransform(file));
  const PoseFile seed = readPose(files.seed, frames);
  made.camera_from_station_seed = seed.camera_from_station;
  made.station_frame = seed.station_frame;
  const DeclaredUncertainty stated = seed.uncertainty.value_or(DeclaredUncertainty());
  made.uncertainty = files.uncertainty.value_or(stated);
  made.uncertainty.pivot = files.pivot.value_or(stated.pivot);
  if (!files.uncertainty && !seed.uncertainty)
    result.notes.push_back("the seed states no uncertainty; taking 0.03 m and 5 deg");
  const std::string projected = projectionNote(seed.rotation_deviation);
  if (!projected.empty()) result.notes.push_back(files.seed.string() + ": " + projected);
  if (files.truth) {
    const PoseFile truth = readPose(*files.truth, frames);
    made.camera_from_station_truth = truth.camera_from_station;
    made.truth_frame = truth.station_frame;
    made.truth_covariance = truth.covariance;
  }
  if (files.ignore) made.ignore = maskInput(*files.ignore, made.image);
  return result;
}

Session makeSession(const fs::path& dataset_file, const std::vector<std::string>& case_ids) {
  return makeSession(openDataset(dataset_file), case_ids);
}

Session makeSession(const Dataset& dataset, const std::vector<std::string>& case_ids) {
  for (const std::string& id : case_ids)
    if (dataset.findCase(id) == nullptr)
      throw InputError(dataset.file, "cases", "there is no case '" + id + "'");
  Session session;
  std::map<fs::path, ImageInput> images;
  std::map<std::string, std::vector<MeshInput>> parts;
  for (const Case& one : dataset.cases) {
    if (!case_ids.empty() && std::find(case_ids.begin(), case_ids.end(), one.id) == case_ids.end())
      continue;
    if (!parts.contains(one.station))
      parts[one.station] = meshInputs(dataset.stations.at(one.station).parts);
    if (!images.contains(one.image)) images[one.image] = imageInput(one.image, {});
    session.cases.push_back(caseOf(dataset, one, images[one.image], parts[one.station]));
  }
  session.review.preset = presetOfAll(session);
  return session;
}

std::filesystem::path examplesFolder() {
  std::error_code ignored;
  const std::filesystem::path program = std::filesystem::read_symlink("/proc/self/exe", ignored);
  for (std::filesystem::path folder = program.parent_path(); folder != folder.root_path();
       folder = folder.parent_path()) {
    for (const char* place : {"share/boresight/examples", "sessions/examples"}) {
      if (std::filesystem::is_directory(folder / place / "stations", ignored))
        return folder / place;
    }
  }
  throw InputError(program,
                   "the examples are neither in share/boresight/examples next to the program nor "
                   "in the source tree above it");
}

}  // namespace boresight::sessions
