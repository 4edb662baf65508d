// SPDX-License-Identifier: Apache-2.0
#include "sessions/io/camera_file.h"

#include <algorithm>
#include <string>
#include <vector>

#include <nlohmann/json.hpp>

#include "sessions/io/cahv_camera.h"
#include "sessions/io/cahvor_file.h"
#include "sessions/io/json_document.h"
#include "sessions/io/json_writer.h"
#include "sessions/io/labels/image_label.h"

namespace boresight::sessions {
namespace {

constexpr const char* kFormat = "boresight-camera";
constexpr int kVersion = 1;
constexpr double kMinFocalLength_px = 1e-3;
constexpr double kMaxFocalLength_px = 1e7;
constexpr double kMaxPrincipalPoint_px = 1e6;

CameraModel readModel(const JsonReader& json) {
  const JsonReader model = json.at("model");
  const std::string name = model.text();
  for (const CameraModel known :
       {CameraModel::kPinhole, CameraModel::kBrownConrady, CameraModel::kKannalaBrandt,
        CameraModel::kCahv, CameraModel::kCahvor, CameraModel::kCahvore})
    if (name == cameraModelName(known)) return known;
  model.fail("unknown camera model '" + name +
             "' (pinhole, brown_conrady, kannala_brandt, cahv, cahvor or cahvore is needed)");
}

const char* expectedCoefficients(CameraModel model) {
  if (model == CameraModel::kBrownConrady) return "brown_conrady needs 4, 5 or 8 coefficients";
  return "kannala_brandt needs 4 coefficients";
}

bool coefficientCountFits(CameraModel model, std::size_t count) {
  if (model == CameraModel::kKannalaBrandt) return count == 4;
  return count == 4 || count == 5 || count == 8;
}

void readDistortion(const JsonReader& json, Camera& camera) {
  if (camera.model == CameraModel::kPinhole) {
    // Somebody who gives coefficients wants them used; all zeros say nothing.
    if (const auto dist = json.find("dist"))
      for (const JsonReader& coefficient : dist->elements())
        if (coefficient.number() != 0.0)
          coefficient.fail("a pinhole camera has no distortion (use brown_conrady)");
    return;
  }
  const JsonReader dist = json.at("dist");
  const std::vector<JsonReader> coefficients = dist.elements();
  if (!coefficientCountFits(camera.model, coefficients.size()))
    dist.fail(std::string(expectedCoefficients(camera.model)) + ", " +
              std::to_string(coefficients.size()) + " given");
  for (std::size_t i = 0; i < coefficients.size(); ++i)
    camera.distortion[i] = coefficients[i].number();
}

CameraFile readLensCamera(CameraModel model, const JsonReader& json) {
  Camera camera;
  camera.model = model;
  camera.width = static_cast<int>(json.at("width").integer(1, kMaxImageSide_px));
  camera.height = static_cast<int>(json.at("height").integer(1, kMaxImageSide_px));
  camera.fx = json.at("fx").number(kMinFocalLength_px, kMaxFocalLength_px);
  camera.fy = json.at("fy").number(kMinFocalLength_px, kMaxFocalLength_px);
  camera.cx = json.at("cx").number(-kMaxPrincipalPoint_px, kMaxPrincipalPoint_px);
  camera.cy = json.at("cy").number(-kMaxPrincipalPoint_px, kMaxPrincipalPoint_px);
  readDistortion(json, camera);
  const Status status = prepareCamera(camera);
  if (status != Status::kOk)
    json.fail(std::string("the camera cannot project with these parameters (") +
              statusText(status) + ")");
  return {camera};
}

}  // namespace

const char* cameraModelName(CameraModel model) {
  switch (model) {
    case CameraModel::kPinhole:
      return "pinhole";
    case CameraModel::kBrownConrady:
      return "brown_conrady";
    case CameraModel::kKannalaBrandt:
      return "kannala_brandt";
    case CameraModel::kCahv:
      return "cahv";
    case CameraModel::kCahvor:
      return "cahvor";
    case CameraModel::kCahvore:
      return "cahvore";
  }
  return "unknown";
}

CameraFile readCameraFile(const JsonReader& json) {
  if (json.has("format")) json.requireFormat(kFormat, kVersion);  // a file's content in a dataset
  (void)json.has("fitted_from");  // for people: the camera that this one was fitted to
  const CameraModel model = readModel(json);
  CameraFile file = isCahvFamily(model) ? readCahvCamera(model, json) : readLensCamera(model, json);
  if (const auto sigma = json.find("calibration_sigma"))
    file.calibration_sigma = readCalibrationSigma(*sigma);
  return file;
}

CameraFile readCameraFile(const std::filesystem::path& file) {
  if (isCahvorFile(file)) return readCahvorCamera(file);
  if (hasImageLabel(file)) return readLabelCamera(file);
  const JsonDocument document(file);
  return document.read(kFormat, kVersion,
                       [](const JsonReader& json) { return readCameraFile(json); });
}

Camera readCamera(const JsonReader& json) { return readCameraFile(json).camera; }

Camera readCamera(const std::filesystem::path& file) { return readCameraFile(file).camera; }

nlohmann::ordered_json toJson(const CameraFile& file) {
  nlohmann::ordered_json json =
      isCahvFamily(file.camera.model) ? cahvJson(file) : toJson(file.camera);
  if (file.calibration_sigma) json["calibration_sigma"] = toJson(*file.calibration_sigma);
  return json;
}

nlohmann::ordered_json toJson(const Camera& camera) {
  if (isCahvFamily(camera.model)) return cahvJson({camera});
  nlohmann::ordered_json json;
  json["model"] = cameraModelName(camera.model);
  json["width"] = camera.width;
  json["height"] = camera.height;
  json["fx"] = camera.fx;
  json["fy"] = camera.fy;
  json["cx"] = camera.cx;
  json["cy"] = camera.cy;
  if (camera.model == CameraModel::kPinhole) return json;
  const auto& distortion = camera.distortion;
  std::ptrdiff_t count = 4;
  if (camera.model == CameraModel::kBrownConrady) {
    const bool rational = std::any_of(distortion.begin() + 5, distortion.end(),
                                      [](double coefficient) { return coefficient != 0.0; });
    count = rational ? 8 : 5;
  }
  json["dist"] = std::vector<double>(distortion.begin(), distortion.begin() + count);
  return json;
}

void writeCamera(const std::filesystem::path& file, const Camera& camera) {
  writeCamera(file, CameraFile{camera});
}

void writeCamera(const std::filesystem::path& file, const CameraFile& camera) {
  nlohmann::ordered_json json;
  json["format"] = kFormat;
  json["version"] = kVersion;
  json.update(toJson(camera));
  writeJsonFile(file, json);
}

}  // namespace boresight::sessions
