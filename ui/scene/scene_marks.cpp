// SPDX-License-Identifier: Apache-2.0
#include "ui/scene/scene_marks.h"

#include <algorithm>
#include <cmath>
#include <map>

#include "ui/annotation/annotation_controller.h"

namespace boresight::ui {
namespace {

constexpr double kPick_px = 10.0;

template <class Pair>
SceneMark markOf(const Pair& pair, const AnnotationController& annotation,
                 const std::map<std::string, double>& outlying) {
  SceneMark mark;
  mark.id = pair.id;
  mark.complete = pair.complete();
  mark.enabled = pair.enabled;
  mark.locked = pair.locked;
  mark.chosen = pair.id == annotation.selected();
  const auto outlier = outlying.find(pair.id);
  if (pair.used() && outlier != outlying.end()) mark.outlier = outlier->second;
  return mark;
}

double distance(const QPointF& a, const QPointF& b) {
  return std::hypot(a.x() - b.x(), a.y() - b.y());
}

/// Of a pixel to a mark's sign or edge; nothing behind the eye.
std::optional<double> distanceTo(const SceneMark& mark, const Viewpoint& view,
                                 const QPointF& pixel) {
  QPointF from;
  QPointF to;
  double depth_m = 0.0;
  if (!mark.edge) {
    if (!view.toCanvas(mark.at_m, from, depth_m)) return std::nullopt;
    return distance(from, pixel);
  }
  if (!view.toCanvas(mark.edge->start_in_station_m, from, depth_m) ||
      !view.toCanvas(mark.edge->end_in_station_m, to, depth_m))
    return std::nullopt;
  const QPointF way = to - from;
  const double squared = QPointF::dotProduct(way, way);
  const double share =
      squared > 0.0 ? std::clamp(QPointF::dotProduct(pixel - from, way) / squared, 0.0, 1.0) : 0.0;
  return distance(from + share * way, pixel);
}

}  // namespace

std::vector<SceneMark> sceneMarks(const AnnotationController& annotation) {
  std::vector<SceneMark> marks;
  for (const sessions::Proposal& proposal : annotation.proposals()) {
    SceneMark mark;
    mark.id = proposal.landmark.name;
    mark.at_m = proposal.landmark.point_in_station_m;
    mark.proposed = true;
    marks.push_back(mark);
  }
  std::map<std::string, double> outlying;
  if (annotation.solution()) outlying = annotation.solution()->standingOut();
  for (const sessions::PointPair& point : annotation.marks().points) {
    if (!point.point_in_station_m) continue;
    marks.push_back(markOf(point, annotation, outlying));
    marks.back().at_m = *point.point_in_station_m;
  }
  for (const sessions::LinePair& line : annotation.marks().lines) {
    if (!line.edge) continue;
    marks.push_back(markOf(line, annotation, outlying));
    marks.back().edge = line.edge;
    marks.back().at_m = 0.5 * (line.edge->start_in_station_m + line.edge->end_in_station_m);
  }
  std::stable_partition(marks.begin(), marks.end(),
                        [](const SceneMark& mark) { return !mark.chosen; });
  return marks;
}

std::string pickMark(const std::vector<SceneMark>& marks, const Viewpoint& view,
                     const sessions::MeshSnapper& mesh, const QPointF& pixel) {
  std::string picked;
  double least_px = 2.0 * kPick_px;
  for (const SceneMark& mark : marks) {
    if (mark.proposed) continue;
    const auto distance_px = distanceTo(mark, view, pixel);
    if (!distance_px || *distance_px > kPick_px) continue;
    const double rank_px = *distance_px + (mark.edge ? kPick_px : 0.0);  // points lie upon lines
    if (rank_px > least_px || !mesh.seenFrom(view.eyeInStation_m(), mark.at_m)) continue;
    least_px = rank_px;
    picked = mark.id;
  }
  return picked;
}

}  // namespace boresight::ui
