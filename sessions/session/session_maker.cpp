// SPDX-License-Identifier: Apache-2.0
#include "sessions/session/session_maker.h"

#include <algorithm>
#include <map>
#include <system_error>

#include "sessions/decision/check_limits.h"
#include "sessions/evaluation/bop_dataset.h"
#include "sessions/io/files/errors.h"
#include "sessions/io/images/camera_of_file.h"
#include "sessions/io/images/labels/image_label.h"
#include "sessions/session/case_frames.h"
#include "sessions/session/input_check.h"

namespace boresight::sessions {
namespace {

namespace fs = std::filesystem;

fs::path wholePath(const fs::path& file) { return fs::absolute(file).lexically_normal(); }

/// As a case keeps them.
std::vector<FrameTransform> keptFrames(std::vector<FrameTransform> transforms) {
  for (FrameTransform& transform : transforms) transform.file = wholePath(transform.file);
  return transforms;
}

/// A line for the operator where the seed was converted by what the image's label states.
std::string labelNote(const PoseFrames& frames, const FrameName& frame) {
  const FrameTree tree = frameTree(frames.reference, frames.transforms);
  const auto chain = tree.chain(kCameraFrame, frame);
  const auto of_label = [](const FrameLink& link) {
    return link.transform->origin == TransformSource::kLabel;
  };
  if (!chain || std::ranges::none_of(chain->links, of_label)) return "";
  return "the seed is converted from " + frameText(frame) + " by the frames of the image's label";
}

/// InputError for a part without a place in the scene, and without a matched part.
void requireScene(const SessionCase& session_case, const fs::path& place) {
  const std::vector<PartSource> parts = partsOf(session_case);
  if (!anyMatched(parts)) throw InputError(place, "role", "no part of the station is matched");
  const FrameTree frames = framesOf(session_case);
  for (const PartSource& part : parts) (void)placedPart(part, frames);
}

TruthSource sourceOfTruth(const fs::path& file, const PoseFile& truth) {
  TruthSource source{TruthOrigin::kGiven, file.filename().string(), inputSha256(file), ""};
  if (!truth.run_digest) return source;
  source.origin = truth.run_digest->empty() ? TruthOrigin::kAnnotated : TruthOrigin::kRun;
  source.run = *truth.run_digest;
  return source;
}

InputFile maskInput(const fs::path& file, const ImageInput& image) {
  return {wholePath(file), readIgnoreMask(file, image.width, image.height).file_sha256};
}

SessionCase caseOf(const Dataset& dataset, const Case& dataset_case, const ImageInput& image,
                   const std::vector<MeshInput>& parts) {
  if (!dataset_case.uncertainty)
    throw InputError(dataset.file, "cases." + dataset_case.id + ".uncertainty",
                     "neither the case nor its station states one");
  SessionCase session_case;
  session_case.id = dataset_case.id;
  session_case.station = dataset_case.station;
  session_case.image = image;
  setCamera(session_case, dataset.cameras.at(dataset_case.camera));
  session_case.parts = parts;
  for (std::size_t i = 0; i < dataset_case.part_states.size(); ++i)
    session_case.parts[i].source.state = dataset_case.part_states[i];
  const auto& station = dataset.stations.at(dataset_case.station);
  session_case.feature_size_m = station.feature_size_m;
  session_case.symmetries = station.symmetries;
  session_case.mesh_scale_sigma = station.mesh_scale_sigma;
  session_case.camera_from_station_seed = dataset_case.seed_camera_from_station;
  session_case.station_frame = dataset_case.station_frame;
  session_case.uncertainty = *dataset_case.uncertainty;
  session_case.camera_from_station_truth = dataset_case.truth_camera_from_station;
  session_case.truth_frame = dataset_case.truth_frame;
  session_case.truth_covariance = dataset_case.truth_covariance;
  if (dataset_case.truth_camera_from_station)
    session_case.truth_source =
        TruthSource{TruthOrigin::kGiven, dataset.file.filename().string(), dataset.sha256, ""};
  if (dataset_case.ignore)
    session_case.ignore = maskInput(*dataset_case.ignore, session_case.image);
  session_case.rig = dataset_case.rig;
  session_case.tags = dataset_case.tags;
  session_case.requirement = dataset_case.requirement;
  session_case.camera_from_end_effector = dataset_case.camera_from_end_effector;
  session_case.frames = keptFrames(dataset.transforms);
  return session_case;
}

/// The preset that all cases need; the default when they need different ones or none.
std::string presetOfAll(const Session& session) {
  std::string preset;
  for (const auto& session_case : session.cases) {
    const std::string own =
        session_case->requirement ? presetFor(*session_case->requirement).name : "";
    if (own.empty() || (!preset.empty() && own != preset)) return kDefaultCheckPreset;
    preset = own;
  }
  return preset.empty() ? kDefaultCheckPreset : preset;
}

}  // namespace

std::vector<FrameTransform> readTransforms(const CaseFiles& files) {
  std::vector<FrameTransform> transforms;
  for (const fs::path& file : files.transforms)
    for (FrameTransform& transform : readFrameTransforms(file))
      transforms.push_back(std::move(transform));
  return transforms;
}

ImageInput imageInput(const fs::path& file, const ImageReadOptions& eight_bit) {
  const GrayImage image = readImage(file, eight_bit);
  ImageInput input{{wholePath(file), image.file_sha256},
                   image.width,
                   image.height,
                   eight_bit,
                   image.pixels_sha256,
                   image.color_sha256};
  if (image.label) input.label = image.label->identifiers;
  return input;
}

std::vector<MeshInput> meshInputs(const std::vector<PartSource>& parts) {
  std::vector<MeshInput> inputs;
  for (const PartSource& part : parts) {
    inputs.push_back({part, readMesh(part.mesh, part.mesh_unit).info.file_sha256});
    inputs.back().source.mesh = wholePath(part.mesh);
  }
  return inputs;
}

MadeCase makeCase(const CaseFiles& files) {
  MadeCase result;
  SessionCase& session_case = result.made;
  session_case.id = files.id.empty() ? files.image.stem().string() : files.id;
  const bool has_image = !files.image.empty();
  if (has_image) session_case.image = imageInput(files.image, files.eight_bit);
  const CameraFile camera = readChosenCamera(files.camera, files.image);
  setCamera(session_case, camera);
  if (!has_image) {
    session_case.image.width = camera.camera.width;
    session_case.image.height = camera.camera.height;
  }
  session_case.parts = meshInputs(files.parts);
  session_case.feature_size_m = files.feature_size_m;
  session_case.symmetries = files.symmetries;
  session_case.mesh_scale_sigma = files.mesh_scale_sigma;
  PoseFrames frames{camera.reference, readTransforms(files)};
  if (has_image) addLabelFrames(files.image, camera.reference, frames.transforms);
  session_case.frames = keptFrames(frames.transforms);
  requireScene(session_case, files.parts.empty() ? files.image : files.parts.front().mesh);
  if (const auto chain = framesOf(session_case).chain(kCameraFrame, kEndEffectorFrame))
    session_case.camera_from_end_effector = chain->a_from_b;
  if (files.camera_from_end_effector)
    session_case.camera_from_end_effector = files.camera_from_end_effector;
  session_case.requirement = files.requirement;
  const std::optional<PoseFile> given =
      files.seed.empty() ? seedOfFrames(frameTree(frames.reference, frames.transforms))
                         : readPose(files.seed, frames);
  session_case.has_seed = given.has_value();
  const PoseFile seed = given.value_or(PoseFile());
  session_case.camera_from_station_seed = seed.camera_from_station;
  session_case.station_frame = seed.station_frame;
  const DeclaredUncertainty stated = seed.uncertainty.value_or(DeclaredUncertainty());
  session_case.uncertainty = files.uncertainty.value_or(stated);
  session_case.uncertainty.pivot = files.pivot.value_or(stated.pivot);
  if (session_case.has_seed && !files.uncertainty && !seed.uncertainty)
    result.notes.push_back("the seed states no uncertainty; taking 0.03 m and 5 deg");
  if (const std::string by_label = labelNote(frames, seed.station_frame.value_or(kStationFrame));
      !by_label.empty())
    result.notes.push_back(by_label);
  const std::string projected = projectionNote(seed.rotation_deviation);
  if (!projected.empty()) result.notes.push_back(files.seed.string() + ": " + projected);
  if (files.truth) {
    const PoseFile truth = readPose(*files.truth, frames);
    setTruth(session_case, truth.camera_from_station, sourceOfTruth(*files.truth, truth),
             truth.covariance);
    session_case.truth_frame = truth.station_frame;
  }
  if (files.ignore) session_case.ignore = maskInput(*files.ignore, session_case.image);
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
  for (const Case& dataset_case : dataset.cases) {
    if (!case_ids.empty() && std::ranges::find(case_ids, dataset_case.id) == case_ids.end())
      continue;
    if (!parts.contains(dataset_case.station))
      parts[dataset_case.station] = meshInputs(dataset.stations.at(dataset_case.station).parts);
    if (!images.contains(dataset_case.image))
      images[dataset_case.image] = imageInput(dataset_case.image, {});
    session.cases.push_back(
        caseOf(dataset, dataset_case, images[dataset_case.image], parts[dataset_case.station]));
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
