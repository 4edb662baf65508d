// SPDX-License-Identifier: Apache-2.0
#include "sessions/session/frames_json.h"

#include <nlohmann/json.hpp>

namespace boresight::sessions {

using nlohmann::ordered_json;

namespace {

/// A frame whose name may be missing: that of a text file of calibration.
ordered_json frameJson(const FrameName& frame) {
  return frame.name.empty() ? ordered_json::object() : toJson(frame);
}

FrameName readFrame(const JsonReader& json) {
  return json.has("name") ? readFrameName(json) : FrameName{};
}

ordered_json transformJson(const FrameTransform& transform) {
  ordered_json json;
  json["target"] = toJson(transform.target);
  json["source"] = toJson(transform.source);
  json["target_from_source"] = exactPoseJson(transform.target_from_source);
  json["comment"] = transform.comment;
  json["file"] = transform.file.filename().string();
  json["sha256"] = transform.file_sha256;
  return json;
}

FrameTransform readTransformMember(const JsonReader& json) {
  FrameTransform transform;
  transform.target = readFrameName(json.at("target"));
  transform.source = readFrameName(json.at("source"));
  transform.target_from_source = readExactPose(json.at("target_from_source"));
  transform.comment = json.at("comment").nonEmptyText();
  transform.file = json.at("file").nonEmptyText();
  transform.file_sha256 = readSha256(json.at("sha256"));
  return transform;
}

}  // namespace

ordered_json toJson(const CameraReference& reference) {
  ordered_json json = frameJson(reference.frame);
  json["camera_from_reference"] = exactPoseJson(reference.camera_from_reference);
  return json;
}

CameraReference readCameraReference(const JsonReader& json) {
  return {readExactPose(json.at("camera_from_reference")), readFrame(json)};
}

ordered_json toJson(const StationFrame& frame) {
  ordered_json json = frameJson(frame.frame);
  if (frame.joined_by) json["joined_by"] = transformJson(*frame.joined_by);
  return json;
}

StationFrame readStationFrame(const JsonReader& json) {
  StationFrame frame{readFrame(json)};
  if (const auto joined = json.find("joined_by")) frame.joined_by = readTransformMember(*joined);
  return frame;
}

ordered_json toJson(const std::vector<LabelItem>& label) {
  ordered_json json = ordered_json::array();
  for (const LabelItem& item : label) json.push_back(ordered_json::array({item.name, item.value}));
  return json;
}

std::vector<LabelItem> readLabelItems(const JsonReader& json) {
  std::vector<LabelItem> label;
  for (const JsonReader& item : json.elements()) {
    const auto pair = item.elements(2);
    label.push_back({pair[0].nonEmptyText(), pair[1].text()});
  }
  return label;
}

}  // namespace boresight::sessions
