// SPDX-License-Identifier: Apache-2.0
#include "sessions/io/datasets/dataset_file.h"

#include <algorithm>
#include <set>

#include <nlohmann/json.hpp>

#include "core/base/math.h"
#include "sessions/io/cameras/camera_field.h"
#include "sessions/io/cameras/camera_file.h"
#include "sessions/io/files/errors.h"
#include "sessions/io/files/file_bytes.h"
#include "sessions/io/images/camera_of_file.h"
#include "sessions/io/images/labels/image_label.h"
#include "sessions/io/images/labels/label_files.h"
#include "sessions/io/json/json_fields.h"
#include "sessions/io/meshes/mesh_container.h"
#include "sessions/text/units.h"

namespace boresight::sessions {
namespace {

Pose readDiscrete(const JsonReader& json) {
  const std::vector<JsonReader> numbers = json.elements(16);
  Eigen::Matrix4d matrix;
  for (int i = 0; i < 16; ++i) matrix(i / 4, i % 4) = numbers[static_cast<std::size_t>(i)].number();
  if (matrix.row(3) != Eigen::RowVector4d(0.0, 0.0, 0.0, 1.0)) json.fail("last row is not 0 0 0 1");
  Pose pose;
  double deviation = 0.0;
  const Eigen::Vector3d translation_m = matrix.block<3, 1>(0, 3) / kMillimetres;
  if (poseFromMatrix(matrix.block<3, 3>(0, 0), translation_m, pose, deviation) != Status::kOk)
    json.fail("is not a rotation with a translation");
  return pose;
}

/// `axis` (of any length) and, under `point_key`, a point on it, station frame.
AxisSymmetry readAxisSymmetry(const JsonReader& json, const char* point_key,
                              double units_per_metre) {
  AxisSymmetry symmetry;
  symmetry.axis = json.at("axis").vector3();
  const double length = symmetry.axis.norm();
  if (!(length > 1e-9)) json.failMember("axis", "has no direction");
  symmetry.axis /= length;
  if (const auto point = json.find(point_key))
    symmetry.point_m = point->vector3() / units_per_metre;
  return symmetry;
}

constexpr const char* kDatasetFormat = "boresight-dataset";
constexpr int kDatasetVersion = 1;
constexpr double kMaxFeatureSize_m = 100.0;
constexpr double kMaxError = 1e6;
constexpr std::pair<const char*, std::optional<double> Requirement::*> kLimits[] = {
    {"normal_mm", &Requirement::normal_mm},
    {"lateral_mm", &Requirement::lateral_mm},
    {"rotation_deg", &Requirement::rotation_deg},
    {"projection_px", &Requirement::projection_px}};

/// Reads a transform and notes when it was not quite a rotation.
Pose readNotedTransform(const JsonReader& json, Dataset& dataset) {
  double deviation = 0.0;
  Pose pose = readTransform(json, &deviation);
  const std::string note = projectionNote(deviation);
  if (!note.empty()) dataset.notes.push_back(json.place() + ": " + note);
  return pose;
}

/// `json` is an entry of `parts`, or a station in its short form.
PartSource readPart(const JsonReader& json, Dataset& dataset) {
  PartSource source;
  source.mesh = json.at("mesh").path();
  const std::optional<MeshFormat> format = knownMeshFormat(source.mesh);
  if (!format) json.failMember("mesh", unknownMeshFormat(source.mesh));
  if (const auto unit = json.find("mesh_unit")) {
    source.mesh_unit = unit->text();
    if (!metresPerUnit(source.mesh_unit))
      unit->fail("unknown unit '" + source.mesh_unit + "' (m, dm, cm, mm, um, in, ft, yd, km)");
  } else if (!carriesUnit(*format)) {
    json.failMember("mesh_unit",
                    std::string("missing: ") + meshFormatName(*format) + " carries no unit");
  }
  json.optional("name", source.name, kNonEmptyText);
  json.optional("frame", source.frame, readPartFrame);
  if (const auto transform = json.find("frame_from_mesh"))
    source.frame_from_mesh = readNotedTransform(*transform, dataset);
  if (const auto transform = json.find("station_from_mesh")) {
    if (source.frame != kStationFrame || json.has("frame_from_mesh"))
      transform->fail("cannot be combined with 'frame' or 'frame_from_mesh': use only the latter");
    source.frame_from_mesh = readNotedTransform(*transform, dataset);
  }
  if (const auto threshold = json.find("normal_threshold_deg"))
    source.normal_threshold_rad = threshold->number(0.1, 180.0) * kDegree_rad;
  json.optional("depth_threshold_m", source.depth_threshold_m, numberIn(1e-6, 1000.0));
  source.state = readPartState(json);
  json.optional("albedo", source.albedo, numberIn(0.0, 1.0));
  return source;
}

std::vector<PartSource> readParts(const JsonReader& json, Dataset& dataset) {
  const auto parts = json.find("parts");
  if (!parts) {
    const PartSource only = readPart(json, dataset);
    if (!only.state.matched())
      json.failMember(json.has("match") ? "match" : "role",
                      "the station's only part must be matched");
    return {only};
  }
  if (json.has("mesh")) json.failMember("mesh", "cannot be combined with 'parts'");
  std::vector<PartSource> all;
  for (const JsonReader& part : parts->elements()) all.push_back(readPart(part, dataset));
  const auto matched = [](const PartSource& source) {
    return source.state.role == PartRole::kMatched;
  };
  if (all.empty()) parts->fail("is empty");
  if (std::none_of(all.begin(), all.end(), matched)) parts->fail("no part is to be matched");
  return all;
}

/// Discrete ones as transforms, turns as axis and a point on it, metres, station frame.
Symmetries readStationSymmetries(const JsonReader& json, Dataset& dataset) {
  Symmetries symmetries;
  const auto readPose = [&](const JsonReader& item) { return readNotedTransform(item, dataset); };
  const auto readAxis = [](const JsonReader& item) {
    return readAxisSymmetry(item, "point_m", 1.0);
  };
  json.optional("discrete", symmetries.discrete, listOf(plainCodec(readPose)));
  json.optional("continuous", symmetries.continuous, listOf(plainCodec(readAxis)));
  if (symmetries.empty()) json.fail("has neither 'discrete' nor 'continuous' symmetries");
  return symmetries;
}

Station readStation(const JsonReader& json, Dataset& dataset) {
  Station station;
  station.parts = readParts(json, dataset);
  json.optional("feature_size_m", station.feature_size_m, numberIn(1e-6, kMaxFeatureSize_m));
  json.optional("mesh_scale_sigma", station.mesh_scale_sigma, numberIn(0.0, kMaxScaleSigma));
  json.optional("uncertainty", station.uncertainty, readUncertainty);
  if (const auto transform = json.find("camera_from_end_effector"))
    station.camera_from_end_effector = readNotedTransform(*transform, dataset);
  if (const auto symmetries = json.find("symmetries"))
    station.symmetries = readStationSymmetries(*symmetries, dataset);
  return station;
}

/// Text that must be a key of `known`.
template <class Map>
std::string readReference(const JsonReader& json, const Map& known, const char* what) {
  std::string id = json.text();
  if (!known.contains(id)) json.fail(std::string("there is no ") + what + " '" + id + "'");
  return id;
}

void readPoses(const JsonReader& json, Case& dataset_case, Dataset& dataset) {
  const PoseFrames frames{dataset.cameras.at(dataset_case.camera).reference, dataset.transforms};
  const auto read = [&](const JsonReader& pose_json) {
    PoseFile pose = readPose(pose_json, frames);
    const std::string note = projectionNote(pose.rotation_deviation);
    if (!note.empty()) dataset.notes.push_back(pose_json.place() + ".camera_from_station: " + note);
    return pose;
  };
  const PoseFile seed = read(json.at("seed"));
  dataset_case.seed_camera_from_station = seed.camera_from_station;
  dataset_case.uncertainty = seed.uncertainty;
  dataset_case.station_frame = seed.station_frame;
  if (const auto given = json.find("truth")) {
    const PoseFile truth = read(*given);
    dataset_case.truth_camera_from_station = truth.camera_from_station;
    dataset_case.truth_frame = truth.station_frame;
    dataset_case.truth_covariance = truth.covariance;
  }
  if (const auto rig = json.find("rig"))
    dataset_case.rig =
        Rig{rig->at("id").nonEmptyText(), readNotedTransform(rig->at("camera_from_rig"), dataset)};
}

/// What a case may override, and what holds for it otherwise.
void readOverrides(const JsonReader& json, const Station& station, Case& dataset_case,
                   Dataset& dataset) {
  json.optional("uncertainty", dataset_case.uncertainty, readUncertainty);
  if (!dataset_case.uncertainty) dataset_case.uncertainty = station.uncertainty;
  dataset_case.requirement = dataset.requirement;
  json.optional("requirement", dataset_case.requirement, readRequirement);
  dataset_case.camera_from_end_effector = station.camera_from_end_effector;
  if (const auto transform = json.find("camera_from_end_effector"))
    dataset_case.camera_from_end_effector = readNotedTransform(*transform, dataset);
}

/// One of the data set's cameras, or that of the image's own label.
std::string readCaseCamera(const JsonReader& json, const Case& dataset_case, Dataset& dataset) {
  if (const auto named = json.find("camera"))
    return readReference(*named, dataset.cameras, "camera");
  if (!hasImageLabel(dataset_case.image))
    json.failMember("camera", "missing, and the image has no label with a camera model");
  const std::string id = "label of " + dataset_case.id;
  if (dataset.cameras.contains(id))
    json.failMember("camera", "missing, and there is a camera called '" + id + "'");
  dataset.cameras.emplace(id, readCameraFile(dataset_case.image));
  return id;
}

/// `state` of a case: the states of parts by their names, where they differ from the station's.
void readState(const JsonReader& json, const Station& station, Case& dataset_case) {
  std::vector<PartState> states;
  for (const PartSource& part : station.parts) states.push_back(part.state);
  for (const auto& [name, change] : json.members()) {
    const std::size_t part = partOfName(station.parts, name, json.file(), json.place());
    const auto state = changedState(states[part], change.text());
    if (!state) change.fail(std::string("is not one of ") + kStateChanges);
    states[part] = *state;
  }
  dataset_case.part_states = std::move(states);
}

/// Refuses parts that have no place in the scene of a case, and a scene without a matched part.
void requireScene(const JsonReader& json, const Dataset& dataset, const Case& dataset_case,
                  const JsonReader& stations) {
  const std::vector<PartSource> parts = partsOf(dataset, dataset_case);
  if (!anyMatched(parts))
    json.fail("no part of its station is matched: check 'state' and 'present'");
  const auto moves = [](const PartSource& part) { return part.frame != kStationFrame; };
  if (std::none_of(parts.begin(), parts.end(), moves)) return;
  const FrameTree frames = framesOf(dataset, dataset_case);
  for (std::size_t i = 0; i < parts.size(); ++i) {
    const PartConcern concern = partConcern(parts[i], frames);
    if (concern.member.empty()) continue;
    const JsonReader station = stations.at(dataset_case.station);
    const JsonReader part = station.has("parts") ? station.at("parts").elements()[i] : station;
    part.failMember(concern.member, concern.reason);
  }
}

Case readCase(const JsonReader& json, Dataset& dataset) {
  Case dataset_case;
  dataset_case.id = json.at("id").nonEmptyText();
  dataset_case.station = readReference(json.at("station"), dataset.stations, "station");
  dataset_case.image = json.at("image").path();
  dataset_case.camera = readCaseCamera(json, dataset_case, dataset);
  if (const auto ignore = json.find("ignore")) dataset_case.ignore = ignore->path();
  readPoses(json, dataset_case, dataset);
  const Station& station = dataset.stations.at(dataset_case.station);
  readOverrides(json, station, dataset_case, dataset);
  if (const auto state = json.find("state")) readState(*state, station, dataset_case);
  json.optional("tags", dataset_case.tags, listOf(kNonEmptyText));
  return dataset_case;
}

Dataset readMembers(const JsonReader& json) {
  Dataset dataset;
  json.optional("requirement", dataset.requirement, readRequirement);
  for (const auto& [id, station] : json.at("stations").members())
    dataset.stations.emplace(id, readStation(station, dataset));
  if (const auto transforms = json.find("transforms"))
    for (const JsonReader& item : transforms->elements())
      for (FrameTransform& transform : readFrameTransforms(item.path()))
        dataset.transforms.push_back(std::move(transform));
  if (const auto cameras = json.find("cameras"))
    for (const auto& [id, camera] : cameras->members())
      dataset.cameras.emplace(id, readCameraFile(camera));
  std::set<std::string> ids;
  for (const JsonReader& item : json.at("cases").elements()) {
    dataset.cases.push_back(readCase(item, dataset));
    if (!ids.insert(dataset.cases.back().id).second)
      item.failMember("id", "'" + dataset.cases.back().id + "' is given twice");
    requireScene(item, dataset, dataset.cases.back(), json.at("stations"));
  }
  return dataset;
}

void requireFile(const Dataset& dataset, const std::string& place,
                 const std::filesystem::path& file) {
  std::error_code error;
  if (!std::filesystem::exists(file, error))
    throw InputError(dataset.file, place, "no such file: " + file.string());
  if (std::filesystem::is_directory(file, error))
    throw InputError(dataset.file, place, "is a folder: " + file.string());
}

}  // namespace

Symmetries readBopSymmetries(const JsonReader& model) {
  Symmetries symmetries;
  const auto readAxis = [](const JsonReader& item) {
    return readAxisSymmetry(item, "offset", kMillimetres);
  };
  model.optional("symmetries_discrete", symmetries.discrete, listOf(plainCodec(readDiscrete)));
  model.optional("symmetries_continuous", symmetries.continuous, listOf(plainCodec(readAxis)));
  return symmetries;
}

FrameTree framesOf(const Dataset& dataset, const Case& dataset_case) {
  return frameTree(dataset.cameras.at(dataset_case.camera).reference, dataset.transforms);
}

std::vector<PartSource> partsOf(const Dataset& dataset, const Case& dataset_case) {
  std::vector<PartSource> parts = dataset.stations.at(dataset_case.station).parts;
  for (std::size_t i = 0; i < dataset_case.part_states.size(); ++i)
    parts[i].state = dataset_case.part_states[i];
  return parts;
}

Dataset withPartStates(Dataset dataset, const std::vector<PartChange>& changes) {
  for (const PartChange& change : changes) {
    bool known = false;
    std::set<std::string> names;
    for (auto& [id, station] : dataset.stations) {
      const std::string place = "stations." + id + ".parts";
      const auto named = [&](const PartSource& part) { return partName(part) == change.part; };
      for (const PartSource& part : station.parts) names.insert(partName(part));
      if (std::none_of(station.parts.begin(), station.parts.end(), named)) continue;
      known = true;
      const std::size_t part = partOfName(station.parts, change.part, dataset.file, place);
      const auto set = [&](PartState& state) {
        const auto changed = changedState(state, change.state);
        if (!changed)
          throw InputError(dataset.file, place,
                           "'" + change.state + "' is not one of " + kStateChanges);
        state = *changed;
      };
      set(station.parts[part].state);
      for (Case& dataset_case : dataset.cases)
        if (dataset_case.station == id && !dataset_case.part_states.empty())
          set(dataset_case.part_states[part]);
    }
    if (!known)
      throw InputError(dataset.file, "stations",
                       "no station has a part '" + change.part +
                           "'; there are: " + joined({names.begin(), names.end()}));
    dataset.sha256 = sha256Text(dataset.sha256 + change.part + "=" + change.state);
  }
  for (const Case& dataset_case : dataset.cases) {
    const std::vector<PartSource> parts = partsOf(dataset, dataset_case);
    if (!anyMatched(parts))
      throw InputError(dataset.file, "cases." + dataset_case.id,
                       "no part of its station is matched");
    const FrameTree frames = framesOf(dataset, dataset_case);
    for (const PartSource& part : parts) (void)placedPart(part, frames);
  }
  return dataset;
}

const Case* Dataset::findCase(const std::string& id) const {
  const auto found = std::find_if(cases.begin(), cases.end(), [&id](const Case& dataset_case) {
    return dataset_case.id == id;
  });
  return found == cases.end() ? nullptr : &*found;
}

Requirement readRequirement(const JsonReader& json) {
  Requirement requirement;
  for (const auto& [key, limit] : kLimits) {
    const auto stated = json.find(key);
    if (!stated) continue;
    (void)stated->numberAbove(0.0);
    requirement.*limit = stated->number(0.0, kMaxError);
  }
  if (requirement == Requirement())
    json.fail("names none of normal_mm, lateral_mm, rotation_deg, projection_px");
  return requirement;
}

nlohmann::ordered_json toJson(const Requirement& requirement) {
  nlohmann::ordered_json json = nlohmann::ordered_json::object();
  for (const auto& [key, limit] : kLimits)
    if (requirement.*limit) json[key] = *(requirement.*limit);
  return json;
}

Dataset readDataset(const std::filesystem::path& file) {
  const auto bytes = readFileBytes(file, kMaxJsonBytes);
  Dataset dataset =
      JsonDocument(file, asText(bytes)).read(kDatasetFormat, kDatasetVersion, readMembers);
  dataset.file = file;
  dataset.sha256 = sha256Text(bytes);
  return dataset;
}

void requireFiles(const Dataset& dataset) {
  for (const auto& [id, station] : dataset.stations)
    for (const PartSource& part : station.parts) requireFile(dataset, "stations." + id, part.mesh);
  for (std::size_t i = 0; i < dataset.cases.size(); ++i) {
    const std::string place = "cases[" + std::to_string(i) + "]";
    requireFile(dataset, place + ".image", dataset.cases[i].image);
    if (dataset.cases[i].ignore) requireFile(dataset, place + ".ignore", *dataset.cases[i].ignore);
  }
}

GrayImage readCaseImage(const Dataset& dataset, const Case& dataset_case) {
  GrayImage image = readImage(dataset_case.image);
  const Camera& camera = dataset.cameraOf(dataset_case);
  requireSameSize(image, camera);
  requireField(dataset.file, "cameras." + dataset_case.camera, camera);
  return image;
}

std::optional<IgnoreMask> readCaseMask(const Dataset& dataset, const Case& dataset_case) {
  if (!dataset_case.ignore) return std::nullopt;
  const Camera& camera = dataset.cameraOf(dataset_case);
  return readIgnoreMask(*dataset_case.ignore, camera.width, camera.height);
}

std::string inputSha256(const std::filesystem::path& file) {
  constexpr std::size_t kMaxInputBytes = 4096 * kMegabyte;
  if (knownMeshFormat(file)) return readMeshFiles(file).sha256;
  if (const auto label = labelFileOf(file)) return readLabelFiles(*label).sha256;
  return sha256Text(readFileBytes(file, kMaxInputBytes));
}

}  // namespace boresight::sessions
