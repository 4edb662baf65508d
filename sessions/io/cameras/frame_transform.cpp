// SPDX-License-Identifier: Apache-2.0
#include "sessions/io/cameras/frame_transform.h"

#include <nlohmann/json.hpp>

#include "sessions/io/cameras/pose_file.h"
#include "sessions/io/files/errors.h"
#include "sessions/io/files/file_bytes.h"
#include "sessions/io/json/json_reader.h"
#include "sessions/io/json/json_writer.h"

namespace boresight::sessions {
namespace {

constexpr const char* kTransformFormat = "boresight-transform";
constexpr const char* kFramesFormat = "boresight-frames";
constexpr int kVersion = 1;
constexpr double kMaxSigma_mm = 1e4;
constexpr double kMaxSigma_mrad = 1e3;

std::string tooManyText(std::size_t count) {
  return std::to_string(count) + " exceed the limit of " + std::to_string(kMostFrameTransforms) +
         ": give those that join the frames of these cases";
}

Eigen::Matrix3d crossMatrix(const Eigen::Vector3d& v) {
  return Eigen::Matrix3d{{0.0, -v.z(), v.y()}, {v.z(), 0.0, -v.x()}, {-v.y(), v.x(), 0.0}};
}

/// {"translation_mm", "rotation_mrad"}: one sigma per axis of the target frame, at the origin of
/// the source frame.
Matrix6d readSigma(const JsonReader& json, const Pose& target_from_source) {
  Vector6d variances;
  variances << json.at("rotation_mrad").vector3(0.0, kMaxSigma_mrad) * 1e-3,
      json.at("translation_mm").vector3(0.0, kMaxSigma_mm) * 1e-3;
  variances = variances.cwiseAbs2();
  // A turn about the source's origin o by w is one about the target's and a shift of o x w.
  Matrix6d about_target = Matrix6d::Identity();
  about_target.bottomLeftCorner<3, 3>() = crossMatrix(target_from_source.translation_m);
  return about_target * variances.asDiagonal() * about_target.transpose();
}

TransformSource readOrigin(const JsonReader& json) {
  const std::string name = json.choice({"telemetry", "calibration", "label", "commanded"});
  std::size_t index = 0;
  while (name != kTransformSourceNames[index]) ++index;
  return static_cast<TransformSource>(index);
}

FrameTransform readTransformMembers(const JsonReader& json) {
  FrameTransform transform;
  transform.target = readFrameName(json.at("target"));
  transform.source = readFrameName(json.at("source"));
  if (transform.target == transform.source)
    json.failMember("source", "is the same frame as the target");
  transform.target_from_source = readTransform(json.at("target_from_source"));
  const auto covariance = json.find("covariance");
  const auto sigma = json.find("sigma");
  if (covariance && sigma) sigma->fail("cannot be combined with covariance; give one of the two");
  if (covariance) transform.covariance = readCovariance(*covariance);
  if (sigma) transform.covariance = readSigma(*sigma, transform.target_from_source);
  json.optional("origin", transform.origin, readOrigin);
  json.optional("comment", transform.comment, &JsonReader::nonEmptyText);
  return transform;
}

std::vector<FrameTransform> readList(const JsonReader& root) {
  std::vector<FrameTransform> transforms;
  const auto items = root.at("transforms").elements();
  if (items.size() > kMostFrameTransforms) root.failMember("transforms", tooManyText(items.size()));
  for (const JsonReader& item : items) transforms.push_back(readTransformMembers(item));
  if (transforms.empty()) root.failMember("transforms", "is empty");
  return transforms;
}

}  // namespace

std::vector<FrameTransform> readFrameTransforms(const std::filesystem::path& file) {
  const auto bytes = readFileBytes(file, kMaxJsonBytes);
  const JsonDocument document(file, asText(bytes));
  std::vector<FrameTransform> transforms;
  if (document.root().hasFormat(kFramesFormat))
    transforms = document.read(kFramesFormat, kVersion, readList);
  else
    transforms = {document.read(kTransformFormat, kVersion, readTransformMembers)};
  for (FrameTransform& transform : transforms) {
    transform.file = file;
    transform.file_sha256 = sha256Text(bytes);
    if (transform.comment.empty()) transform.comment = file.filename().string();
  }
  return transforms;
}

std::vector<FrameTransform> readFrameTransforms(const std::vector<std::string>& files) {
  std::vector<FrameTransform> transforms;
  for (const std::string& file : files)
    for (FrameTransform& transform : readFrameTransforms(std::filesystem::path(file)))
      transforms.push_back(std::move(transform));
  if (transforms.size() > kMostFrameTransforms)
    throw InputError(files.back(), "transforms of all files", tooManyText(transforms.size()));
  return transforms;
}

void writeFrameTransform(const std::filesystem::path& file, const FrameTransform& transform) {
  nlohmann::ordered_json json = {{"format", kTransformFormat},
                                 {"version", kVersion},
                                 {"target", toJson(transform.target)},
                                 {"source", toJson(transform.source)},
                                 {"target_from_source", toJson(transform.target_from_source)}};
  if (transform.covariance) json["covariance"] = toJson(*transform.covariance);
  if (transform.origin != TransformSource::kUnstated)
    json["origin"] = kTransformSourceNames[static_cast<std::size_t>(transform.origin)];
  json["comment"] = transform.comment;
  writeJsonFile(file, json);
}

}  // namespace boresight::sessions
