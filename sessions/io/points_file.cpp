// SPDX-License-Identifier: Apache-2.0
#include "sessions/io/points_file.h"

#include <set>

#include <nlohmann/json.hpp>

#include "sessions/io/json_document.h"
#include "sessions/io/json_writer.h"

namespace boresight::sessions {
namespace {

constexpr const char* kFormat = "boresight-points";
constexpr int kVersion = 1;
constexpr double kMaxSigma_px = 1e4;

}  // namespace

PointPair readPoint(const JsonReader& json) {
  PointPair point;
  point.id = json.at("id").nonEmptyText();
  point.point_in_station_m = json.at("point_in_station_m").vector3(-1e6, 1e6);
  point.pixel = json.at("pixel").vector2();
  if (const auto sigma = json.find("sigma_px")) point.sigma_px = sigma->number(1e-6, kMaxSigma_px);
  if (const auto enabled = json.find("enabled")) point.enabled = enabled->boolean();
  if (const auto comment = json.find("comment")) point.comment = comment->text();
  return point;
}

nlohmann::ordered_json toJson(const PointPair& point) {
  nlohmann::ordered_json json;
  json["id"] = point.id;
  json["point_in_station_m"] = toJson(point.point_in_station_m);
  json["pixel"] = nlohmann::ordered_json::array({point.pixel.x(), point.pixel.y()});
  json["sigma_px"] = point.sigma_px;
  json["enabled"] = point.enabled;
  json["comment"] = point.comment;
  return json;
}

std::vector<PointPair> readPoints(const std::filesystem::path& file) {
  const JsonDocument document(file);
  std::vector<PointPair> points;
  std::set<std::string> ids;
  for (const JsonReader& json : document.root(kFormat, kVersion).at("points").elements()) {
    points.push_back(readPoint(json));
    if (!ids.insert(points.back().id).second)
      json.failMember("id", "'" + points.back().id + "' is given twice");
  }
  return points;
}

void writePoints(const std::filesystem::path& file, const std::vector<PointPair>& points) {
  nlohmann::ordered_json list = nlohmann::ordered_json::array();
  for (const PointPair& point : points) list.push_back(toJson(point));
  nlohmann::ordered_json json;
  json["format"] = kFormat;
  json["version"] = kVersion;
  json["points"] = list;
  writeJsonFile(file, json);
}

}  // namespace boresight::sessions
