// SPDX-License-Identifier: Apache-2.0
#include "sessions/io/cahv_camera.h"

#include <string>

#include <nlohmann/json.hpp>

#include "sessions/io/json_writer.h"

namespace boresight::sessions {
namespace {

constexpr double kLargest = 1e9;
constexpr const char* kOwnFrame = "CAMERA";

CahvModel readVectors(CameraModel model, const JsonReader& json) {
  const auto vector = [&json](const char* key) {
    return json.at(key).vector3(-kLargest, kLargest);
  };
  CahvModel cahv;
  cahv.model = model;
  cahv.c_m = vector("C");
  cahv.a = vector("A");
  cahv.h_px = vector("H");
  cahv.v_px = vector("V");
  if (model == CameraModel::kCahv) return cahv;
  cahv.o = vector("O");
  cahv.r = vector("R");
  if (model == CameraModel::kCahvor) return cahv;
  cahv.e_m = vector("E");
  cahv.type = static_cast<int>(json.at("cahvore_type").integer(1, 3));
  (void)json.has("cahvore_parameter");  // stated with every type, used with one
  if (cahv.type == 3) cahv.parameter = json.at("cahvore_parameter").number(-kLargest, kLargest);
  return cahv;
}

/// Vectors are those of the whole image: what of it the image at hand is.
void cutSubframe(const JsonReader& json, Camera& camera) {
  const double scale = json.find("scale") ? json.at("scale").number(1e-3, 1e3) : 1.0;
  const auto shifted = [&](const char* key, double centre_px) {
    const double first = json.find(key) ? json.at(key).number(-1e6, 1e6) : 0.0;
    return (centre_px - first + 0.5) / scale - 0.5;
  };
  camera.cx = shifted("first_sample", camera.cx);
  camera.cy = shifted("first_line", camera.cy);
  camera.fx /= scale;
  camera.fy /= scale;
  camera.cahv.skew_px /= scale;
}

}  // namespace

FrameName readFrameName(const JsonReader& json) {
  FrameName frame;
  frame.name = json.at("name").nonEmptyText();
  if (const auto index = json.find("index"))
    for (const JsonReader& one : index->elements()) frame.index.push_back(one.integer());
  return frame;
}

nlohmann::ordered_json toJson(const FrameName& frame) {
  nlohmann::ordered_json json = {{"name", frame.name}};
  if (!frame.index.empty()) json["index"] = frame.index;
  return json;
}

std::string frameText(const FrameName& frame) {
  if (frame.name.empty()) return "a frame without a name";
  std::string index;
  for (const std::int64_t one : frame.index)
    index += (index.empty() ? " (" : ", ") + std::to_string(one);
  return frame.name + (index.empty() ? "" : index + ")");
}

CameraFile readCahvCamera(CameraModel model, const JsonReader& json) {
  for (const char* key : {"fx", "fy", "cx", "cy", "dist"})
    if (json.has(key))
      json.failMember(key, std::string("a ") + cameraModelName(model) +
                               " camera is given by its vectors alone (C, A, H, V ...)");
  const CahvModel cahv = readVectors(model, json);
  const auto width = static_cast<int>(json.at("width").integer(1, kMaxImageSide_px));
  const auto height = static_cast<int>(json.at("height").integer(1, kMaxImageSide_px));
  CameraFile file;
  Pose camera_from_reference;
  Status status = cameraFromCahv(cahv, width, height, file.camera, camera_from_reference);
  const auto subframe = json.find("subframe");
  if (status == Status::kOk && subframe) {
    cutSubframe(*subframe, file.camera);
    status = prepareCamera(file.camera);
  }
  if (status != Status::kOk)
    json.fail(
        "the camera cannot project with these vectors: A and O must have length 1 and lie within "
        "60 deg, H and V must not lie along A or along each other, and 1 + r0 must be positive");
  file.reference = CameraReference{camera_from_reference, {}};
  if (const auto frame = json.find("reference_frame"))
    file.reference->frame = readFrameName(*frame);
  return file;
}

nlohmann::ordered_json cahvJson(const CameraFile& file) {
  const CahvModel cahv =
      cahvFromCamera(file.camera, file.reference ? file.reference->camera_from_reference : Pose());
  nlohmann::ordered_json json;
  json["model"] = cameraModelName(cahv.model);
  json["width"] = file.camera.width;
  json["height"] = file.camera.height;
  json["C"] = toJson(cahv.c_m);
  json["A"] = toJson(cahv.a);
  json["H"] = toJson(cahv.h_px);
  json["V"] = toJson(cahv.v_px);
  if (cahv.model != CameraModel::kCahv) {
    json["O"] = toJson(cahv.o);
    json["R"] = toJson(cahv.r);
  }
  if (cahv.model == CameraModel::kCahvore) {
    json["E"] = toJson(cahv.e_m);
    json["cahvore_type"] = cahv.type;
    json["cahvore_parameter"] = cahv.parameter;
  }
  const FrameName frame = file.reference ? file.reference->frame : FrameName{kOwnFrame, {}};
  if (!frame.name.empty()) json["reference_frame"] = toJson(frame);
  return json;
}

}  // namespace boresight::sessions
