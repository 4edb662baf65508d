// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <algorithm>
#include <filesystem>
#include <map>
#include <optional>
#include <string>
#include <vector>

#include <Eigen/Core>

#include "core/geometry/camera.h"
#include "core/geometry/pose.h"
#include "sessions/io/cameras/camera_file.h"
#include "sessions/io/cameras/pose_file.h"
#include "sessions/io/datasets/symmetries.h"
#include "sessions/io/images/image_file.h"
#include "sessions/io/json/json_reader.h"
#include "sessions/io/meshes/scene_mesh.h"

namespace boresight::sessions {

/// `symmetries_discrete` (16 numbers each, row by row) and `symmetries_continuous` (axis, offset)
/// of an entry of BOP's models_info.json, millimetres. InputError.
Symmetries readBopSymmetries(const JsonReader& model);

/// Limits of the errors of a result; at least one is stated, the others are not judged.
struct Requirement {
  std::optional<double> normal_mm;
  std::optional<double> lateral_mm;
  std::optional<double> rotation_deg;
  std::optional<double> projection_px;

  bool operator==(const Requirement&) const = default;
};

struct Station {
  std::vector<PartSource> parts;  ///< at least one
  std::optional<double> feature_size_m;
  std::optional<double> mesh_scale_sigma;  ///< relative, one sigma
  std::optional<DeclaredUncertainty> uncertainty;
  std::optional<Pose> camera_from_end_effector;
  Symmetries symmetries;  ///< poses that differ by one of them count as the same
};

/// Cases with the same `id` were taken at once by rigidly linked cameras.
struct Rig {
  std::string id;
  Pose camera_from_rig;

  bool operator==(const Rig&) const = default;
};

/// Ids of a case in a BOP dataset.
struct BopKey {
  int scene_id = 0;
  int image_id = 0;
  int object_id = 0;
};

struct Case {
  std::string id;
  std::string station;  ///< a key of Dataset::stations
  std::string camera;   ///< a key of Dataset::cameras
  std::filesystem::path image;
  std::optional<std::filesystem::path> ignore;
  Pose seed_camera_from_station;
  /// Of a seed that was given in a named frame.
  std::optional<FrameName> station_frame = std::nullopt;
  std::optional<Pose> truth_camera_from_station;
  /// Of a truth that was given in a named frame.
  std::optional<FrameName> truth_frame = std::nullopt;
  std::optional<Matrix6d> truth_covariance = std::nullopt;  ///< empty: it is exact
  std::optional<Rig> rig;
  std::vector<std::string> tags;
  /// Values in force for the case: its own, otherwise its seed's (uncertainty), its station's or
  /// the dataset's (requirement).
  std::optional<DeclaredUncertainty> uncertainty;
  std::optional<Requirement> requirement;
  std::optional<Pose> camera_from_end_effector;
  std::vector<PartState> part_states = {};  ///< one per part of the station; empty: the station's
  std::optional<BopKey> bop = {};

  bool hasTag(const std::string& tag) const { return std::ranges::count(tags, tag) > 0; }
};

/// dataset.json (`boresight-dataset`, version 1), checked whole; images and meshes are read later.
struct Dataset {
  std::filesystem::path file;
  std::string sha256;  ///< of the file, or of the selection of a folder
  std::optional<Requirement> requirement;
  std::map<std::string, Station> stations;
  std::map<std::string, CameraFile> cameras;
  std::vector<FrameTransform> transforms;  ///< between frames of camera models and of poses
  std::vector<Case> cases;
  std::vector<std::string> notes;  ///< e.g. matrices that were projected to rotations

  const Camera& cameraOf(const Case& dataset_case) const {
    return cameras.at(dataset_case.camera).camera;
  }
  /// nullptr when no case has this id.
  const Case* findCase(const std::string& id) const;
};

/// InputError with the place in the file: formats, ranges, references to missing stations and
/// cameras, duplicate ids, a mesh without a unit.
Dataset readDataset(const std::filesystem::path& file);

/// InputError when an image, mask or mesh that the dataset names does not exist; called before a
/// long run starts.
void requireFiles(const Dataset& dataset);

/// SHA-256 of a file that a dataset or session names: of its bytes; of a glTF mesh with its
/// buffers, of an image with its label where the label is another file. InputError.
std::string inputSha256(const std::filesystem::path& file);

Requirement readRequirement(const JsonReader& json);
nlohmann::ordered_json toJson(const Requirement& requirement);

/// The image of a case; InputError also when its size is not the camera's.
GrayImage readCaseImage(const Dataset& dataset, const Case& dataset_case);
/// Empty when the case has no mask.
std::optional<IgnoreMask> readCaseMask(const Dataset& dataset, const Case& dataset_case);

/// The frames that a case's poses and parts may be given in.
FrameTree framesOf(const Dataset& dataset, const Case& dataset_case);
/// The parts of a case's station in the state that they have in the case.
std::vector<PartSource> partsOf(const Dataset& dataset, const Case& dataset_case);

/// A change of a part's state; see changedState.
struct PartChange {
  std::string part;  ///< its name
  std::string state;
};
/// The dataset with these changes in all cases whose station has the part. Its hash changes, so
/// that results of different states are not mixed. InputError.
Dataset withPartStates(Dataset dataset, const std::vector<PartChange>& changes);

}  // namespace boresight::sessions
