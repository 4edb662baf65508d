// SPDX-License-Identifier: Apache-2.0
#include "sessions/io/cameras/camera_file.h"

#include <algorithm>
#include <array>
#include <iterator>
#include <string>
#include <vector>

#include <nlohmann/json.hpp>

#include "sessions/io/cameras/raw_metadata.h"
#include "sessions/io/files/errors.h"
#include "sessions/io/json/json_fields.h"
#include "sessions/io/json/json_reader.h"
#include "sessions/io/json/json_writer.h"

namespace boresight::sessions {
namespace {

constexpr double kLargest = 1e9;
constexpr const char* kOwnFrame = "CAMERA";

/// By CameraModel.
constexpr const char* kModelNames[] = {"pinhole", "brown_conrady", "kannala_brandt",
                                       "cahv",    "cahvor",        "cahvore"};
static_assert(std::size(kModelNames) == static_cast<std::size_t>(kLastCameraModel) + 1);

CahvModel readVectors(CameraModel model, const JsonReader& json) {
  CahvModel cahv;
  cahv.model = model;
  forVectors(cahv, [&json](const char* key, Eigen::Vector3d& vector) {
    vector = json.at(key).vector3(-kLargest, kLargest);
  });
  if (model != CameraModel::kCahvore) return cahv;
  cahv.type = static_cast<int>(json.at("cahvore_type").integer(1, 3));
  (void)json.has("cahvore_parameter");  // stated with every type, used with one
  if (cahv.type == 3) cahv.parameter = json.at("cahvore_parameter").number(-kLargest, kLargest);
  return cahv;
}

/// Cuts the camera to the sub-frame of the image: vectors are those of the whole image.
void cutSubframe(const JsonReader& json, CameraFile& file) {
  Camera& camera = file.camera;
  double scale = 1.0, first_x = 0.0, first_y = 0.0;
  json.optional("scale", scale, numberIn(1e-3, 1e3));
  json.optional("first_sample", first_x, numberIn(-1e6, 1e6));
  json.optional("first_line", first_y, numberIn(-1e6, 1e6));
  camera.cx = (camera.cx - first_x + 0.5) / scale - 0.5;
  camera.cy = (camera.cy - first_y + 0.5) / scale - 0.5;
  const double to_centre_px = 0.5 - 0.5 * scale;
  if (file.covariance)
    file.covariance =
        ofSubframe(*file.covariance, to_centre_px - first_x, to_centre_px - first_y, scale);
  camera.fx /= scale;
  camera.fy /= scale;
  camera.cahv.skew_px /= scale;
}

constexpr const char* kCameraFormat = "boresight-camera";
constexpr int kCameraVersion = 1;
constexpr double kMinFocalLength_px = 1e-3;
constexpr double kMaxFocalLength_px = 1e7;
constexpr double kMaxPrincipalPoint_px = 1e6;

CameraModel readModel(const JsonReader& json) {
  const JsonReader model = json.at("model");
  const std::string name = model.text();
  for (int i = 0; i < std::ssize(kModelNames); ++i)
    if (name == kModelNames[i]) return static_cast<CameraModel>(i);
  model.fail("unknown camera model '" + name +
             "' (pinhole, brown_conrady, kannala_brandt, cahv, cahvor or cahvore is needed)");
}

void readDistortion(const JsonReader& json, Camera& camera) {
  if (camera.model == CameraModel::kPinhole) {
    // Coefficients that would be ignored are rejected; zeros change nothing.
    if (const auto dist = json.find("dist"))
      for (const JsonReader& coefficient : dist->elements())
        if (coefficient.number() != 0.0)
          coefficient.fail("a pinhole camera has no distortion (use brown_conrady)");
    return;
  }
  const JsonReader dist = json.at("dist");
  const std::vector<JsonReader> coefficients = dist.elements();
  const std::size_t count = coefficients.size();
  const bool brown_conrady = camera.model == CameraModel::kBrownConrady;
  if (count != 4 && !(brown_conrady && (count == 5 || count == 8)))
    dist.fail(
        std::string(brown_conrady ? "brown_conrady needs 4, 5 or 8" : "kannala_brandt needs 4") +
        " coefficients, " + std::to_string(count) + " given");
  for (std::size_t i = 0; i < count; ++i) camera.distortion[i] = coefficients[i].number();
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

/// A camera of the CAHV family: its vectors in a reference frame into the camera's own frame.
CameraFile readCahvCamera(CameraModel model, const JsonReader& json) {
  for (const char* key : {"fx", "fy", "cx", "cy", "dist"})
    if (json.has(key))
      json.failMember(key, std::string("a ") + cameraModelName(model) +
                               " camera is given by its vectors only (C, A, H, V ...)");
  const CahvModel cahv = readVectors(model, json);
  const auto width = static_cast<int>(json.at("width").integer(1, kMaxImageSide_px));
  const auto height = static_cast<int>(json.at("height").integer(1, kMaxImageSide_px));
  std::optional<CameraFile> file = cameraOfVectors(cahv, width, height);
  const auto covariance = json.find("covariance");
  if (file && covariance)
    file->covariance =
        inFrame(readCameraCovariance(*covariance, model), file->reference->camera_from_reference);
  const auto subframe = json.find("subframe");
  if (file && subframe) {
    cutSubframe(*subframe, *file);
    if (prepareCamera(file->camera) != Status::kOk) file.reset();
  }
  if (!file) json.fail(kVectorsCannotProject);
  json.optional("reference_frame", file->reference->frame, readFrameName);
  return *file;
}

/// The vectors in the reference frame; in the camera's own where there is none.
nlohmann::ordered_json cahvJson(const CameraFile& file) {
  const CahvModel cahv =
      cahvFromCamera(file.camera, file.reference ? file.reference->camera_from_reference : Pose());
  nlohmann::ordered_json json = {{"model", cameraModelName(cahv.model)},
                                 {"width", file.camera.width},
                                 {"height", file.camera.height}};
  forVectors(cahv, [&json](const char* key, const Eigen::Vector3d& vector) {
    json[key] = toJson(vector);
  });
  if (cahv.model == CameraModel::kCahvore) {
    json["cahvore_type"] = cahv.type;
    json["cahvore_parameter"] = cahv.parameter;
  }
  const FrameName frame = file.reference ? file.reference->frame : FrameName{kOwnFrame, {}};
  if (!frame.name.empty()) json["reference_frame"] = toJson(frame);
  if (file.covariance)
    json["covariance"] =
        toJson(inFrame(*file.covariance,
                       file.reference ? file.reference->camera_from_reference.inverse() : Pose()));
  return json;
}

}  // namespace

bool isImageSide(double side_px) {
  return side_px >= 1.0 && side_px <= kMaxImageSide_px && side_px == std::floor(side_px);
}

std::optional<CameraFile> cameraOfVectors(const CahvModel& cahv, int width, int height) {
  CameraFile file;
  CameraReference& reference = file.reference.emplace();
  if (cameraFromCahv(cahv, width, height, file.camera, reference.camera_from_reference) !=
      Status::kOk)
    return std::nullopt;
  return file;
}

FrameName readFrameName(const JsonReader& json) {
  FrameName frame;
  frame.name = json.at("name").nonEmptyText();
  if (const auto index = json.find("index"))
    for (const JsonReader& item : index->elements()) frame.index.push_back(item.integer());
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
  for (const std::int64_t item : frame.index)
    index += (index.empty() ? " (" : ", ") + std::to_string(item);
  return frame.name + (index.empty() ? "" : index + ")");
}

StatedCalibration readCalibrationSigma(const JsonReader& json) {
  StatedCalibration sigma;
  if (const auto focal = json.find("focal_relative"))
    sigma.focal_relative = focal->number(0.0, kMaxFocalSigma);
  if (const auto centre = json.find("principal_point_px"))
    sigma.principal_point_px = centre->number(0.0, kMaxPrincipalPointSigma_px);
  if (sigma == StatedCalibration())
    json.fail("states neither focal_relative nor principal_point_px");
  return sigma;
}

nlohmann::ordered_json toJson(const StatedCalibration& sigma) {
  nlohmann::ordered_json json;
  if (sigma.focal_relative) json["focal_relative"] = *sigma.focal_relative;
  if (sigma.principal_point_px) json["principal_point_px"] = *sigma.principal_point_px;
  return json;
}

std::optional<StatedCalibration> statedCalibration(const CameraFile& file) {
  if (!file.covariance) return file.calibration_sigma;
  const CalibrationSigma sigma = calibrationSigmaOf(file.camera, *file.covariance);
  return StatedCalibration{std::min(sigma.focal_relative, kMaxFocalSigma),
                           std::min(sigma.principal_point_px, kMaxPrincipalPointSigma_px)};
}

const char* cameraModelName(CameraModel model) { return kModelNames[static_cast<int>(model)]; }

std::span<const int> coefficientCounts(CameraModel model) {
  static constexpr std::array kNone = {0};
  static constexpr std::array kKannalaBrandt = {4};
  static constexpr std::array kBrownConrady = {5, 8};
  switch (model) {
    case CameraModel::kPinhole:
    case CameraModel::kCahv:
    case CameraModel::kCahvor:
    case CameraModel::kCahvore:
      return kNone;
    case CameraModel::kKannalaBrandt:
      return kKannalaBrandt;
    case CameraModel::kBrownConrady:
      return kBrownConrady;
  }
  return kNone;
}

int coefficientCount(const Camera& camera) {
  const std::span<const int> counts = coefficientCounts(camera.model);
  const auto leavesZeros = [&camera](int count) {
    return std::all_of(camera.distortion.begin() + count, camera.distortion.end(),
                       [](double coefficient) { return coefficient == 0.0; });
  };
  const auto found = std::ranges::find_if(counts, leavesZeros);
  return found == counts.end() ? counts.back() : *found;
}

std::optional<CameraModel> cahvModelOf(const std::string& name) {
  for (const CameraModel model : {CameraModel::kCahv, CameraModel::kCahvor, CameraModel::kCahvore})
    if (lowerCase(name) == cameraModelName(model)) return model;
  return std::nullopt;
}

CameraFile readCameraFile(const JsonReader& json) {
  if (json.has("format"))
    json.requireFormat(kCameraFormat, kCameraVersion);  // a file's content in a dataset
  (void)json.has("fitted_from");  // not read: the camera that this one was fitted to
  const CameraModel model = readModel(json);
  CameraFile file = isCahvFamily(model) ? readCahvCamera(model, json) : readLensCamera(model, json);
  json.optional("calibration_sigma", file.calibration_sigma, readCalibrationSigma);
  return file;
}

CameraFile readCameraJson(const std::filesystem::path& file) {
  const JsonDocument document(file);
  if (isRawMetadata(document.root())) return readRawMetadata(document.root());
  return document.read(kCameraFormat, kCameraVersion,
                       [](const JsonReader& json) { return readCameraFile(json); });
}

nlohmann::ordered_json toJson(const CameraFile& file) {
  nlohmann::ordered_json json =
      isCahvFamily(file.camera.model) ? cahvJson(file) : toJson(file.camera);
  if (file.calibration_sigma) json["calibration_sigma"] = toJson(*file.calibration_sigma);
  return json;
}

nlohmann::ordered_json toJson(const Camera& camera) {
  if (isCahvFamily(camera.model)) return cahvJson({camera});
  nlohmann::ordered_json json = {{"model", cameraModelName(camera.model)},
                                 {"width", camera.width},
                                 {"height", camera.height},
                                 {"fx", camera.fx},
                                 {"fy", camera.fy},
                                 {"cx", camera.cx},
                                 {"cy", camera.cy}};
  const int count = coefficientCount(camera);
  if (count == 0) return json;
  const auto& distortion = camera.distortion;
  json["dist"] = std::vector<double>(distortion.begin(), distortion.begin() + count);
  return json;
}

void writeCamera(const std::filesystem::path& file, const CameraFile& camera) {
  nlohmann::ordered_json json = {{"format", kCameraFormat}, {"version", kCameraVersion}};
  json.update(toJson(camera));
  writeJsonFile(file, json);
}

}  // namespace boresight::sessions
