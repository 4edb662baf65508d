// SPDX-License-Identifier: Apache-2.0
#include "sessions/annotation/marks_file.h"

#include <set>

#include <nlohmann/json.hpp>

#include "sessions/annotation/marks_csv.h"
#include "sessions/io/atomic_file.h"
#include "sessions/io/camera_file.h"
#include "sessions/io/file_bytes.h"
#include "sessions/io/json_reader.h"
#include "sessions/io/json_writer.h"
#include "sessions/io/pose_file.h"

namespace boresight::sessions {
namespace {

using nlohmann::ordered_json;

constexpr const char* kMarksFormat = "boresight-points";
constexpr int kMarksVersion = 1;
constexpr double kMaxSigma_px = 1e4;
constexpr double kMaxCoordinate_m = 1e6;

Eigen::Vector3d readPlace(const JsonReader& json) {
  return json.vector3(-kMaxCoordinate_m, kMaxCoordinate_m);
}

/// What points and lines have in common.
template <class Pair>
void readCommon(const JsonReader& json, Pair& pair) {
  pair.id = json.at("id").nonEmptyText();
  if (const auto sigma = json.find("sigma_px")) pair.sigma_px = sigma->number(1e-6, kMaxSigma_px);
  if (const auto enabled = json.find("enabled")) pair.enabled = enabled->boolean();
  if (const auto locked = json.find("locked")) pair.locked = locked->boolean();
  if (const auto comment = json.find("comment")) pair.comment = comment->text();
}

template <class Pair>
void writeCommon(const Pair& pair, ordered_json& json) {
  json["sigma_px"] = pair.sigma_px;
  json["enabled"] = pair.enabled;
  json["locked"] = pair.locked;
  json["comment"] = pair.comment;
}

PointPair readPoint(const JsonReader& json) {
  PointPair point;
  readCommon(json, point);
  if (const auto place = json.find("point_in_station_m"))
    point.point_in_station_m = readPlace(*place);
  if (const auto pixel = json.find("pixel")) point.pixel = pixel->vector2();
  return point;
}

LinePair readLine(const JsonReader& json) {
  LinePair line;
  readCommon(json, line);
  if (const auto edge = json.find("edge_in_station_m")) {
    const auto ends = edge->elements(2);
    line.edge = {readPlace(ends[0]), readPlace(ends[1])};
    if (line.edge->start_in_station_m == line.edge->end_in_station_m)
      edge->fail("both ends are the same point");
  }
  if (const auto seen = json.find("line_px")) {
    const auto ends = seen->elements(2);
    line.line = {ends[0].vector2(), ends[1].vector2()};
    if (line.line->start == line.line->end) seen->fail("both ends are the same place");
  }
  return line;
}

ordered_json pointJson(const PointPair& point) {
  ordered_json json;
  json["id"] = point.id;
  if (point.point_in_station_m) json["point_in_station_m"] = toJson(*point.point_in_station_m);
  if (point.pixel) json["pixel"] = toJson(*point.pixel);
  writeCommon(point, json);
  return json;
}

ordered_json lineJson(const LinePair& line) {
  ordered_json json;
  json["id"] = line.id;
  if (line.edge)
    json["edge_in_station_m"] = ordered_json::array(
        {toJson(line.edge->start_in_station_m), toJson(line.edge->end_in_station_m)});
  if (line.line)
    json["line_px"] = ordered_json::array({toJson(line.line->start), toJson(line.line->end)});
  writeCommon(line, json);
  return json;
}

bool isTable(const std::filesystem::path& file) { return file.extension() == ".csv"; }

std::vector<MarkedView> readViews(const JsonReader& root) {
  std::vector<MarkedView> views;
  std::set<std::string> names;
  for (const JsonReader& json : root.at("views").elements()) {
    MarkedView view;
    view.name = json.at("name").nonEmptyText();
    if (!names.insert(view.name).second)
      json.failMember("name", "'" + view.name + "' is given twice");
    view.camera = readCamera(json.at("camera").path());
    view.camera_from_rig = readTransform(json.at("camera_from_rig"));
    view.marks = readMarks(json.at("points").path());
    views.push_back(view);
  }
  if (views.empty()) root.failMember("views", "there is none");
  return views;
}

}  // namespace

Marks readMarks(const JsonReader& json) {
  Marks marks;
  std::set<std::string> ids;
  const auto requireNew = [&ids](const JsonReader& pair, const std::string& id) {
    if (!ids.insert(id).second) pair.failMember("id", "'" + id + "' is given twice");
  };
  if (const auto points = json.find("points")) {
    for (const JsonReader& point : points->elements()) {
      marks.points.push_back(readPoint(point));
      requireNew(point, marks.points.back().id);
    }
  }
  if (const auto lines = json.find("lines")) {
    for (const JsonReader& line : lines->elements()) {
      marks.lines.push_back(readLine(line));
      requireNew(line, marks.lines.back().id);
    }
  }
  return marks;
}

ordered_json toJson(const Marks& marks) {
  ordered_json json;
  json["points"] = ordered_json::array();
  for (const PointPair& point : marks.points) json["points"].push_back(pointJson(point));
  json["lines"] = ordered_json::array();
  for (const LinePair& line : marks.lines) json["lines"].push_back(lineJson(line));
  return json;
}

Marks readMarks(const std::filesystem::path& file) {
  const auto bytes = readFileBytes(file, kMaxJsonBytes, FileUse::kMarks);
  if (isTable(file)) return parseMarksCsv(file, asText(bytes));
  return JsonDocument(file, asText(bytes))
      .read(kMarksFormat, kMarksVersion, [](const JsonReader& root) { return readMarks(root); });
}

void writeMarks(const std::filesystem::path& file, const Marks& marks) {
  if (isTable(file)) {
    writeFileAtomically(file, marksCsv(marks), FileUse::kMarks);
    return;
  }
  ordered_json json = {{"format", kMarksFormat}, {"version", kMarksVersion}};
  json.update(toJson(marks));
  writeFileAtomically(file, prettyJson(json), FileUse::kMarks);
}

std::vector<MarkedView> readRig(const std::filesystem::path& file) {
  return JsonDocument(file).read("boresight-rig", 1, readViews);
}

}  // namespace boresight::sessions
