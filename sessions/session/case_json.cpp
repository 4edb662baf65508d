// SPDX-License-Identifier: Apache-2.0
#include "sessions/session/case_json.h"

#include <algorithm>
#include <cmath>
#include <initializer_list>

#include <nlohmann/json.hpp>

#include "sessions/io/camera_file.h"
#include "sessions/io/config_file.h"
#include "sessions/io/errors.h"
#include "sessions/io/json_writer.h"
#include "sessions/io/mesh_container.h"
#include "sessions/session/frames_json.h"

namespace boresight::sessions {

namespace fs = std::filesystem;
using nlohmann::ordered_json;

namespace {

constexpr double kMaxLength_m = 1e6;

}  // namespace

PathWriter::PathWriter(const fs::path& file) : folder_(fs::absolute(file).parent_path()) {}

std::string PathWriter::operator()(const fs::path& file) const {
  const fs::path whole = fs::absolute(file).lexically_normal();
  const fs::path relative = whole.lexically_relative(folder_.lexically_normal());
  return relative.empty() ? whole.string() : relative.string();
}

std::string readSha256(const JsonReader& json) {
  std::string text = json.text();
  if (!isSha256Text(text)) json.fail("not a SHA-256 (64 lower-case hexadecimal digits)");
  return text;
}

fs::path readPath(const JsonReader& json, FileUse use) {
  return fs::absolute(json.path(use)).lexically_normal();
}

ordered_json exactPoseJson(const Pose& pose) {
  const Eigen::Quaterniond& q = pose.rotation;
  ordered_json json;
  json["rotation_wxyz"] = ordered_json::array({q.w(), q.x(), q.y(), q.z()});
  json["translation_m"] = toJson(pose.translation_m);
  return json;
}

Pose readExactPose(const JsonReader& json) {
  const JsonReader rotation = json.at("rotation_wxyz");
  const std::vector<JsonReader> q = rotation.elements(4);
  Pose pose;
  pose.rotation = Eigen::Quaterniond(q[0].number(), q[1].number(), q[2].number(), q[3].number());
  if (!(std::abs(pose.rotation.squaredNorm() - 1.0) <= 1e-9))
    rotation.fail("not a unit quaternion: its length is " + numberText(pose.rotation.norm()));
  pose.translation_m = json.at("translation_m").vector3(-kMaxLength_m, kMaxLength_m);
  return pose;
}

namespace {

constexpr double kMaxCoordinate_px = 1e6;

// ---- writing

ordered_json inputJson(const InputFile& input, const PathWriter& path) {
  ordered_json json;
  json["file"] = path(input.file);
  json["sha256"] = input.sha256;
  return json;
}

ordered_json imageJson(const ImageInput& image, const PathWriter& path) {
  ordered_json json = inputJson(image.source, path);
  json["width"] = image.width;
  json["height"] = image.height;
  json["pixels_sha256"] = image.pixels_sha256;
  if (!image.label.empty()) json["label"] = toJson(image.label);
  json["rule"] = image.eight_bit.levels          ? "levels"
                 : image.eight_bit.table.empty() ? "linear"
                                                 : "table";
  if (image.eight_bit.bit_depth) json["bit_depth"] = *image.eight_bit.bit_depth;
  if (!image.eight_bit.table.empty()) json["table"] = image.eight_bit.table;
  if (const auto& levels = image.eight_bit.levels) {
    json["black"] = levels->black;
    json["white"] = levels->white;
  }
  return json;
}

ordered_json partJson(const MeshInput& part, const PathWriter& path) {
  ordered_json json;
  json["file"] = path(part.source.mesh);
  json["sha256"] = part.sha256;
  if (!part.source.mesh_unit.empty()) json["mesh_unit"] = part.source.mesh_unit;
  if (part.source.station_from_mesh != Pose())
    json["station_from_mesh"] = exactPoseJson(part.source.station_from_mesh);
  json["normal_threshold_rad"] = part.source.part.normal_threshold_rad;
  json["depth_threshold_m"] = part.source.part.depth_threshold_m;
  json["match"] = part.source.part.match;
  return json;
}

constexpr const char* kStrokeNames[] = {"brush", "polygon", "saturation"};

ordered_json strokeJson(const MaskStroke& stroke) {
  ordered_json json;
  json["kind"] = kStrokeNames[static_cast<int>(stroke.kind)];
  json["erase"] = stroke.erase;
  if (!stroke.name.empty()) json["name"] = stroke.name;
  if (stroke.kind == StrokeKind::kBrush) json["radius_px"] = stroke.radius_px;
  if (stroke.kind == StrokeKind::kSaturation) json["level"] = stroke.level;
  if (stroke.kind == StrokeKind::kSaturation) return json;
  ordered_json points = ordered_json::array();
  for (const Eigen::Vector2d& point : stroke.points)
    points.push_back(ordered_json::array({point.x(), point.y()}));
  json["points"] = points;
  return json;
}

template <class List, class Convert>
ordered_json listJson(const List& list, Convert&& convert) {
  ordered_json json = ordered_json::array();
  for (const auto& element : list) json.push_back(convert(element));
  return json;
}

void addExtras(const SessionCase& one, const PathWriter& path, ordered_json& json) {
  if (one.camera_reference) json["camera_reference"] = toJson(*one.camera_reference);
  if (one.station_frame) json["station_frame"] = toJson(*one.station_frame);
  if (one.truth_frame) json["truth_frame"] = toJson(*one.truth_frame);
  if (one.camera_from_station_truth) json["truth"] = exactPoseJson(*one.camera_from_station_truth);
  if (one.truth_covariance) json["truth_covariance"] = toJson(*one.truth_covariance);
  if (one.camera_from_station_working)
    json["working"] = exactPoseJson(*one.camera_from_station_working);
  if (one.ignore) json["ignore"] = inputJson(*one.ignore, path);
  if (!one.ignore_strokes.empty())
    json["ignore_strokes"] = listJson(one.ignore_strokes, strokeJson);
  if (one.onboard_record) json["onboard_record"] = inputJson(*one.onboard_record, path);
  if (one.rig) {
    json["rig"]["id"] = one.rig->id;
    json["rig"]["camera_from_rig"] = exactPoseJson(one.rig->camera_from_rig);
  }
  if (!one.tags.empty()) json["tags"] = one.tags;
  if (one.requirement) json["requirement"] = toJson(*one.requirement);
  if (one.camera_from_end_effector)
    json["camera_from_end_effector"] = exactPoseJson(*one.camera_from_end_effector);
  if (one.landmarks) json["landmarks"] = path(*one.landmarks);
}

// ---- reading

InputFile readInput(const JsonReader& json) {
  return {readPath(json.at("file")), readSha256(json.at("sha256"))};
}

ImageReadOptions readEightBit(const JsonReader& json) {
  ImageReadOptions options;
  if (const auto depth = json.find("bit_depth"))
    options.bit_depth = static_cast<int>(depth->integer(1, 16));
  const std::string rule = json.at("rule").choice({"linear", "levels", "table"});
  if (rule != "table" && json.has("table"))
    json.failMember("table", "given although the rule is " + rule);
  if (rule == "linear") return options;
  if (rule == "levels") {
    const std::int64_t largest = (std::int64_t{1} << json.at("bit_depth").integer(1, 16)) - 1;
    const std::int64_t black = json.at("black").integer(0, largest - 1);
    const std::int64_t white = json.at("white").integer(black + 1, largest);
    options.levels = GrayLevels{static_cast<int>(black), static_cast<int>(white)};
    return options;
  }
  const JsonReader table = json.at("table");
  for (const JsonReader& value : table.elements())
    options.table.push_back(static_cast<std::uint8_t>(value.integer(0, 255)));
  const std::size_t count = std::size_t{1} << json.at("bit_depth").integer(1, 16);
  if (options.table.size() != count)
    table.fail("has " + std::to_string(options.table.size()) + " values, but bit_depth needs " +
               std::to_string(count));
  return options;
}

ImageInput readImageInput(const JsonReader& json) {
  ImageInput image;
  image.source = {readPath(json.at("file")), readSha256(json.at("sha256"))};
  image.width = static_cast<int>(json.at("width").integer(1, kMaxImageSide_px));
  image.height = static_cast<int>(json.at("height").integer(1, kMaxImageSide_px));
  image.pixels_sha256 = readSha256(json.at("pixels_sha256"));
  if (const auto label = json.find("label")) image.label = readLabelItems(*label);
  image.eight_bit = readEightBit(json);
  return image;
}

MeshInput readMeshInput(const JsonReader& json) {
  MeshInput part;
  part.source.mesh = readPath(json.at("file"));
  const std::optional<MeshFormat> format = knownMeshFormat(part.source.mesh);
  if (!format) json.failMember("file", unknownMeshFormat(part.source.mesh));
  part.sha256 = readSha256(json.at("sha256"));
  if (const auto unit = json.find("mesh_unit")) {
    part.source.mesh_unit = unit->text();
    if (!metresPerUnit(part.source.mesh_unit))
      unit->fail("unknown unit '" + part.source.mesh_unit + "'");
  } else if (!carriesUnit(*format)) {
    json.failMember("mesh_unit",
                    std::string("missing: ") + meshFormatName(*format) + " carries no unit");
  }
  if (const auto pose = json.find("station_from_mesh"))
    part.source.station_from_mesh = readExactPose(*pose);
  part.source.part.normal_threshold_rad = json.at("normal_threshold_rad").number(1e-3, 3.15);
  part.source.part.depth_threshold_m = json.at("depth_threshold_m").number(1e-6, 1000.0);
  part.source.part.match = json.at("match").boolean();
  return part;
}

MaskStroke readStroke(const JsonReader& json) {
  MaskStroke stroke;
  const std::string kind = json.at("kind").choice({"brush", "polygon", "saturation"});
  while (kind != kStrokeNames[static_cast<int>(stroke.kind)])
    stroke.kind = static_cast<StrokeKind>(static_cast<int>(stroke.kind) + 1);
  stroke.erase = json.at("erase").boolean();
  if (const auto name = json.find("name")) stroke.name = name->nonEmptyText();
  if (stroke.kind == StrokeKind::kSaturation) {
    stroke.level = static_cast<int>(json.at("level").integer(0, 255));
    return stroke;
  }
  if (stroke.kind == StrokeKind::kBrush)
    stroke.radius_px = json.at("radius_px").number(0.0, kMaxImageSide_px);
  for (const JsonReader& point : json.at("points").elements()) {
    stroke.points.push_back(point.vector2());
    if (stroke.points.back().cwiseAbs().maxCoeff() > kMaxCoordinate_px)
      point.fail("is more than " + numberText(kMaxCoordinate_px) + " px away");
  }
  return stroke;
}

void readExtras(const JsonReader& json, SessionCase& one) {
  if (const auto reference = json.find("camera_reference"))
    one.camera_reference = readCameraReference(*reference);
  if (const auto frame = json.find("station_frame")) one.station_frame = readStationFrame(*frame);
  if (const auto frame = json.find("truth_frame")) one.truth_frame = readStationFrame(*frame);
  if (const auto truth = json.find("truth")) one.camera_from_station_truth = readExactPose(*truth);
  if (const auto covariance = json.find("truth_covariance"))
    one.truth_covariance = readCovariance(*covariance);
  if (const auto working = json.find("working"))
    one.camera_from_station_working = readExactPose(*working);
  if (const auto ignore = json.find("ignore")) one.ignore = readInput(*ignore);
  if (const auto strokes = json.find("ignore_strokes"))
    for (const JsonReader& stroke : strokes->elements())
      one.ignore_strokes.push_back(readStroke(stroke));
  if (const auto record = json.find("onboard_record")) one.onboard_record = readInput(*record);
  if (const auto rig = json.find("rig"))
    one.rig = Rig{rig->at("id").nonEmptyText(), readExactPose(rig->at("camera_from_rig"))};
  if (const auto tags = json.find("tags"))
    for (const JsonReader& tag : tags->elements()) one.tags.push_back(tag.nonEmptyText());
  if (const auto requirement = json.find("requirement"))
    one.requirement = readRequirement(*requirement);
  if (const auto pose = json.find("camera_from_end_effector"))
    one.camera_from_end_effector = readExactPose(*pose);
  if (const auto landmarks = json.find("landmarks"))
    one.landmarks = readPath(*landmarks, FileUse::kLandmarks);
}

}  // namespace

ordered_json toJson(const SessionCase& one, const PathWriter& path) {
  ordered_json json;
  json["id"] = one.id;
  if (!one.station.empty()) json["station"] = one.station;
  json["image"] = imageJson(one.image, path);
  json["camera"] = toJson(CameraFile{one.camera, std::nullopt, one.calibration_sigma});
  json["parts"] =
      listJson(one.parts, [&path](const MeshInput& part) { return partJson(part, path); });
  if (one.feature_size_m) json["feature_size_m"] = *one.feature_size_m;
  if (one.mesh_scale_sigma) json["mesh_scale_sigma"] = *one.mesh_scale_sigma;
  json["seed"] = exactPoseJson(one.camera_from_station_seed);
  json["uncertainty"] = toJson(one.uncertainty);
  addExtras(one, path, json);
  return json;
}

SessionCase readSessionCase(const JsonReader& json) {
  SessionCase one;
  one.id = json.at("id").nonEmptyText();
  if (const auto station = json.find("station")) one.station = station->nonEmptyText();
  one.image = readImageInput(json.at("image"));
  const CameraFile camera = readCameraFile(json.at("camera"));
  one.camera = camera.camera;
  one.calibration_sigma = camera.calibration_sigma;
  const JsonReader parts = json.at("parts");
  for (const JsonReader& part : parts.elements()) one.parts.push_back(readMeshInput(part));
  if (std::none_of(one.parts.begin(), one.parts.end(),
                   [](const MeshInput& part) { return part.source.part.match; }))
    parts.fail("no part is to be matched");
  if (const auto size = json.find("feature_size_m")) one.feature_size_m = size->number(1e-6, 100.0);
  if (const auto sigma = json.find("mesh_scale_sigma"))
    one.mesh_scale_sigma = readMeshScaleSigma(*sigma);
  one.camera_from_station_seed = readExactPose(json.at("seed"));
  one.uncertainty = readUncertainty(json.at("uncertainty"));
  readExtras(json, one);
  return one;
}

}  // namespace boresight::sessions
