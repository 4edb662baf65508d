// SPDX-License-Identifier: Apache-2.0
#include "sessions/annotation/annotations_file.h"

#include <set>

#include <nlohmann/json.hpp>

#include "sessions/io/cameras/camera_file.h"
#include "sessions/io/cameras/pose_file.h"
#include "sessions/io/files/atomic_file.h"
#include "sessions/io/files/file_bytes.h"
#include "sessions/io/images/camera_of_file.h"
#include "sessions/io/json/json_fields.h"

namespace boresight::sessions {
namespace {

using nlohmann::ordered_json;

constexpr const char* kAnnotationsFormat = "boresight-points";
constexpr int kAnnotationsVersion = 1;
constexpr double kMaxSigma_px = 1e4;

constexpr auto kPlace = jsonCodec<Eigen::Vector3d>(
    [](const JsonReader& json) { return json.vector3(-kMaxCoordinate_m, kMaxCoordinate_m); });
constexpr auto kPixel =
    jsonCodec<Eigen::Vector2d>([](const JsonReader& json) { return json.vector2(); });

/// Both ends of a segment, which differ.
template <class Segment, class End>
constexpr auto endsOf(End end) {
  return Codec{[end](const Segment& segment) {
                 const auto& [start, stop] = segment;
                 return ordered_json::array({end.write(start), end.write(stop)});
               },
               [end](const JsonReader& json) {
                 const auto ends = json.elements(2);
                 const Segment segment{end.read(ends[0]), end.read(ends[1])};
                 const auto& [start, stop] = segment;
                 if (start == stop) json.fail("both ends coincide");
                 return segment;
               }};
}

/// What points and lines have in common after their places.
template <class Archive, class Pair>
void commonFields(Archive& archive, Pair& pair) {
  archive.defaulted("sigma_px", pair.sigma_px, numberIn(1e-6, kMaxSigma_px));
  archive.defaulted("enabled", pair.enabled, kFlag);
  archive.defaulted("locked", pair.locked, kFlag);
  archive.defaulted("comment", pair.comment, kAnyText);
}

bool isTable(const std::filesystem::path& file) { return file.extension() == ".csv"; }

std::vector<AnnotatedView> readViews(const JsonReader& root) {
  std::vector<AnnotatedView> views;
  std::set<std::string> names;
  for (const JsonReader& json : root.at("views").elements()) {
    AnnotatedView view;
    view.name = json.at("name").nonEmptyText();
    if (!names.insert(view.name).second)
      json.failMember("name", "'" + view.name + "' is given twice");
    view.camera = readCamera(json.at("camera").path());
    view.camera_from_rig = readTransform(json.at("camera_from_rig"));
    view.annotations = readAnnotations(json.at("points").path());
    views.push_back(view);
  }
  if (views.empty()) root.failMember("views", "there is none");
  return views;
}

}  // namespace

template <class Archive, ConstOr<PointPair> Self>
void fields(Archive& archive, Self& point) {
  archive.field("id", point.id, kNonEmptyText);
  archive.optional("point_in_station_m", point.point_in_station_m, kPlace);
  archive.optional("pixel", point.pixel, kPixel);
  commonFields(archive, point);
}

template <class Archive, ConstOr<LinePair> Self>
void fields(Archive& archive, Self& line) {
  archive.field("id", line.id, kNonEmptyText);
  archive.optional("edge_in_station_m", line.edge, endsOf<ModelEdge>(kPlace));
  archive.optional("line_px", line.line, endsOf<ImageLine>(kPixel));
  commonFields(archive, line);
}

template <class Archive, ConstOr<Annotations> Self>
void fields(Archive& archive, Self& annotations) {
  archive.optionalList("points", annotations.points);
  archive.optionalList("lines", annotations.lines);
}

Annotations readAnnotations(const JsonReader& json) {
  const auto annotations = readFields<Annotations>(json);
  std::set<std::string> ids;
  for (const char* list : {"points", "lines"})
    if (const auto pairs = json.find(list))
      for (const JsonReader& pair : pairs->elements()) {
        const std::string id = pair.at("id").text();
        if (!ids.insert(id).second) pair.failMember("id", "'" + id + "' is given twice");
      }
  return annotations;
}

ordered_json toJson(const Annotations& annotations) { return fieldsJson(annotations); }

Annotations readAnnotations(const std::filesystem::path& file) {
  const auto bytes = readFileBytes(file, kMaxJsonBytes, FileUse::kMarks);
  if (isTable(file)) return parseAnnotationsCsv(file, textOf(file, asText(bytes)));
  return JsonDocument(file, asText(bytes))
      .read(kAnnotationsFormat, kAnnotationsVersion,
            [](const JsonReader& root) { return readAnnotations(root); });
}

void writeAnnotations(const std::filesystem::path& file, const Annotations& annotations) {
  if (isTable(file)) {
    writeFileAtomically(file, annotationsCsv(annotations), FileUse::kMarks);
    return;
  }
  ordered_json json = {{"format", kAnnotationsFormat}, {"version", kAnnotationsVersion}};
  json.update(toJson(annotations));
  writeFileAtomically(file, prettyJson(json), FileUse::kMarks);
}

std::vector<AnnotatedView> readRig(const std::filesystem::path& file) {
  return JsonDocument(file).read("boresight-rig", 1, readViews);
}

}  // namespace boresight::sessions
