// SPDX-License-Identifier: Apache-2.0
#include "sessions/evaluation/bop_scene.h"

#include <algorithm>
#include <cmath>
#include <map>
#include <set>
#include <utility>

#include <nlohmann/json.hpp>

#include "sessions/io/files/atomic_file.h"
#include "sessions/io/files/errors.h"
#include "sessions/io/json/json_reader.h"
#include "sessions/io/json/json_writer.h"
#include "sessions/text/plain_text.h"
#include "sessions/text/units.h"

namespace boresight::sessions {
namespace {

using nlohmann::ordered_json;
namespace fs = std::filesystem;

ordered_json cameraEntry(const Camera& camera) {
  ordered_json json;
  json["cam_K"] = {camera.fx, 0.0, camera.cx, 0.0, camera.fy, camera.cy, 0.0, 0.0, 1.0};
  json["depth_scale"] = 1.0;
  return json;
}

/// The rotation row by row.
std::vector<double> rotationOf(const Pose& pose) {
  const Eigen::Matrix3d transposed = pose.matrix().transpose();  // Eigen stores columns
  return {transposed.data(), transposed.data() + transposed.size()};
}

Eigen::Vector3d translationOf_mm(const Pose& pose) { return kMillimetres * pose.translation_m; }

ordered_json objectEntry(const PosedImage& image, int object_id) {
  ordered_json json;
  json["cam_R_m2c"] = rotationOf(image.camera_from_station);
  json["cam_t_m2c"] = toJson(translationOf_mm(image.camera_from_station));
  json["obj_id"] = object_id;
  if (!image.remark.empty()) json["remark"] = image.remark;  // readers ignore unknown members
  return json;
}

Camera readCameraEntry(const JsonReader& entry) {
  if (entry.has("cam_model"))
    entry.failMember("cam_model", "this camera model cannot be read, only pinhole cameras (cam_K)");
  const std::vector<JsonReader> k = entry.at("cam_K").elements(9);
  for (const std::size_t zero : {1u, 3u, 6u, 7u})
    if (k[zero].number() != 0.0) k[zero].fail("a camera with skew cannot be read");
  Camera camera;
  camera.fx = k[0].numberAbove(0.0);
  camera.cx = k[2].number();
  camera.fy = k[4].numberAbove(0.0);
  camera.cy = k[5].number();
  return camera;
}

Pose readPoseEntry(const JsonReader& entry) {
  const std::vector<JsonReader> numbers = entry.at("cam_R_m2c").elements(9);
  Eigen::Matrix3d rotation;
  for (int i = 0; i < 9; ++i)
    rotation(i / 3, i % 3) = numbers[static_cast<std::size_t>(i)].number();
  Pose pose;
  double deviation = 0.0;
  const Eigen::Vector3d translation_m = entry.at("cam_t_m2c").vector3() / kMillimetres;
  if (poseFromMatrix(rotation, translation_m, pose, deviation) != Status::kOk)
    entry.failMember("cam_R_m2c", "is not a rotation");
  return pose;
}

void requireWritableAsBop(const std::filesystem::path& folder, const PosedImage& image,
                          std::set<int>& ids) {
  const std::string name = "image " + std::to_string(image.id);
  if (image.id < 0 || !ids.insert(image.id).second)
    throw OutputError(folder / "scene_gt.json", name + " needs a unique id");
  const Camera& camera = image.camera;
  const bool undistorted =
      camera.model == CameraModel::kBrownConrady && camera.distortion == Camera().distortion;
  if (camera.model != CameraModel::kPinhole && !undistorted)
    throw OutputError(folder / "scene_camera.json",
                      name +
                          ": its camera distorts, which the format does not know; undistort "
                          "the image, the pose stays");
}

constexpr const char* kHeader = "scene_id,im_id,obj_id,score,R,t,time";
constexpr double kSameTime_s = 0.001;

void requireWritable(const fs::path& file, const BopResult& result,
                     std::map<std::pair<int, int>, double>& times) {
  const std::string image = "image " + std::to_string(result.image_id);
  if (result.scene_id < 0 || result.image_id < 0 || result.object_id < 0)
    throw OutputError(file, image + " has a negative id");
  if (!result.camera_from_station.isFinite() || !std::isfinite(result.score))
    throw OutputError(file, image + " has a pose or score that is not finite");
  const auto [known, is_new] = times.insert({{result.scene_id, result.image_id}, result.seconds});
  if (!is_new && std::abs(known->second - result.seconds) >= kSameTime_s)
    throw OutputError(file, image + " has lines with different times; the time is one per image");
}

std::string lineOf(const BopResult& result) {
  return std::to_string(result.scene_id) + "," + std::to_string(result.image_id) + "," +
         std::to_string(result.object_id) + "," + numberText(result.score) + "," +
         numbersText(rotationOf(result.camera_from_station)) + "," +
         numbersText(translationOf_mm(result.camera_from_station)) + "," +
         numberText(result.seconds) + "\n";
}

}  // namespace

void writeBopScene(const std::filesystem::path& folder, std::span<const BopObject> objects) {
  ordered_json cameras = ordered_json::object();
  ordered_json truth = ordered_json::object();
  std::set<int> ids;
  for (const auto& [image, object_id] : objects) {
    requireWritableAsBop(folder, image, ids);
    const std::string key = std::to_string(image.id);
    cameras[key] = cameraEntry(image.camera);
    truth[key] = ordered_json::array({objectEntry(image, object_id)});
  }
  writeJsonFile(folder / "scene_camera.json", cameras);
  writeJsonFile(folder / "scene_gt.json", truth);
}

std::string bopNumber(int number) { return formatText("%06d", number); }

std::map<int, JsonReader> bopEntries(const JsonReader& root) {
  std::map<int, JsonReader> entries;
  for (const auto& [key, entry] : root.members()) {
    const auto number = numberIn<int>(key);
    if (!number || *number < 0) entry.fail("'" + key + "' is not a number from 0 on");
    if (!entries.emplace(*number, entry).second)
      entry.fail("the number " + std::to_string(*number) + " is given twice");
  }
  return entries;
}

std::vector<BopObject> readBopScene(const std::filesystem::path& folder) {
  return readBopScene(folder / "scene_camera.json", folder / "scene_gt.json");
}

std::vector<BopObject> readBopScene(const std::filesystem::path& camera_file,
                                    const std::filesystem::path& truth_file) {
  std::map<int, Camera> cameras;
  const JsonDocument camera_document(camera_file);
  for (const auto& [id, entry] : bopEntries(camera_document.root()))
    cameras[id] = readCameraEntry(entry);
  std::vector<BopObject> bop_objects;
  const JsonDocument document(truth_file);
  for (const auto& [id, list] : bopEntries(document.root())) {
    const auto camera = cameras.find(id);
    if (camera == cameras.end()) list.fail(camera_file.filename().string() + " has no such image");
    for (const JsonReader& entry : list.elements()) {
      BopObject object;
      object.image.id = id;
      object.image.camera = camera->second;
      object.image.camera_from_station = readPoseEntry(entry);
      object.object_id = static_cast<int>(entry.at("obj_id").integer(0, 1 << 30));
      bop_objects.push_back(object);
    }
  }
  return bop_objects;
}

void writeBopResults(const fs::path& file, std::span<const BopResult> results) {
  std::map<std::pair<int, int>, double> times;
  std::string text = std::string(kHeader) + "\n";
  for (const BopResult& result : results) {
    requireWritable(file, result, times);
    text += lineOf(result);
  }
  writeFileAtomically(file, text);
}

}  // namespace boresight::sessions
