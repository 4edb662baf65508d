// SPDX-License-Identifier: Apache-2.0
#include "ui/annotation/annotation_content.h"

#include <utility>

#include <QCoreApplication>

#include "sessions/annotation/annotations_on_image.h"
#include "ui/style/tokens.h"
#include "ui/views/view_transform.h"

namespace boresight::ui {
namespace {

constexpr double kSize = 2.0 * kMarkRadius_px;  ///< on the screen
constexpr double kEndSize = 7.0;
constexpr double kChosenSize = 32.0;

QString contentText(const char* text) { return QCoreApplication::translate("MarkContent", text); }

Mark sign(MarkShape shape, const Eigen::Vector2d& pixel, int item) {
  Mark mark;
  mark.shape = shape;
  mark.at = pointOf(pixel);
  mark.size_px = kSize;
  mark.cased = true;
  mark.item = item;
  return mark;
}

QString unplacedLabel(const std::string& id) {
  return contentText("%1 (not placed)").arg(QString::fromStdString(id));
}

/// Collects the signs of one case's annotations.
struct Signs {
  const AnnotationLook& look;
  std::vector<Mark> signs = {};

  void addPoint(const sessions::PointPair& point, int item) {
    if (point.pixel) {
      finish(sign(shapeOf(point), *point.pixel, item), point,
             annotationLabel(point.id, stateOf(point)));
    } else if (point.point_in_station_m && look.camera_from_station) {
      const auto place =
          sessions::predictPlace(look.camera, *look.camera_from_station, *point.point_in_station_m);
      if (!place.valid) return;
      Mark mark = sign(MarkShape::kDiamond, place.pixel, item);
      mark.dashed = true;
      finish(std::move(mark), point, unplacedLabel(point.id));
    }
  }

  void addLine(const sessions::LinePair& line, int item) {
    if (line.line) {
      Mark mark = segment(line.line->start, line.line->end, item);
      mark.dashed = !line.edge;
      finish(std::move(mark), line, annotationLabel(line.id, stateOf(line)));
      for (const Eigen::Vector2d& end : {line.line->start, line.line->end}) {
        Mark handle = sign(line.locked ? MarkShape::kSquare : MarkShape::kCircle, end, item);
        handle.size_px = kEndSize;
        if (!line.enabled) handle.color = kDisabledAnnotation;
        signs.push_back(std::move(handle));
      }
    } else if (line.edge && look.camera_from_station) {
      addPredictedEdge(line, item);
    }
  }

  static Mark segment(const Eigen::Vector2d& start, const Eigen::Vector2d& end, int item) {
    Mark mark = sign(MarkShape::kSegment, start, item);
    mark.to = pointOf(end);
    return mark;
  }

  /// As the camera bends it; each piece is a sign of its own.
  void addPredictedEdge(const sessions::LinePair& line, int item) {
    const auto places = sessions::edgeOnImage(look.camera, *look.camera_from_station, *line.edge);
    for (std::size_t i = 1; i < places.size(); ++i) {
      Mark mark = segment(places[i - 1], places[i], item);
      mark.dashed = true;
      if (2 * i == places.size() + 1) mark.label = unplacedLabel(line.id);
      if (line.id == look.selected) mark.color = kChosenAnnotation;
      signs.push_back(std::move(mark));
    }
  }

  static MarkShape shapeOf(const sessions::PointPair& point) {
    if (!point.enabled) return MarkShape::kStruck;
    if (!point.point_in_station_m) return MarkShape::kCircle;
    return point.locked ? MarkShape::kSquare : MarkShape::kTarget;
  }

  template <class Pair>
  AnnotationState stateOf(const Pair& pair) const {
    return ui::stateOf(pair, look.selected, look.outliers);
  }

  template <class Pair>
  void finish(Mark mark, const Pair& pair, const QString& label) {
    mark.label = label;
    for (Mark& each : withState(std::move(mark), stateOf(pair))) signs.push_back(std::move(each));
  }
};

}  // namespace

QString annotationLabel(const std::string& id, const AnnotationState& state) {
  const QString name = QString::fromStdString(id);
  if (!state.complete) return contentText("%1 ?").arg(name);
  if (!state.enabled) return contentText("%1 (off)").arg(name);
  if (state.outlier > 0.0)
    return contentText("%1 ! %2 sigma").arg(name).arg(state.outlier, 0, 'f', 1);
  return name;
}

QColor annotationColor(const AnnotationState& state) {
  if (state.outlier > 0.0) return kOutlierAnnotation;
  if (state.chosen) return kChosenAnnotation;
  if (!state.complete) return QColor(kUnfinishedMarkLine.color);
  return state.enabled ? QColor() : kDisabledAnnotation;
}

namespace {

/// A light halo round dark lines, a dark one round the chosen annotation's bright ones.
LineToken markLine(const AnnotationState& state, bool dashed) {
  LineToken line = state.outlier > 0.0 ? kBadMarkLine
                   : !state.complete   ? kUnfinishedMarkLine
                                       : kMarkLine;
  if (dashed && line.gap_px == 0.0) {
    line.dash_px = kBadMarkLine.dash_px;
    line.gap_px = kBadMarkLine.gap_px;
  }
  if (state.chosen && state.outlier == 0.0) {
    line.halo = 0x000000;
    line.halo_opacity = 0.7;
  }
  return line;
}

}  // namespace

std::vector<Mark> withState(Mark sign, const AnnotationState& state) {
  std::vector<Mark> signs;
  sign.color = annotationColor(state);
  sign.line = markLine(state, sign.dashed);
  const auto add_round = [&](MarkShape shape, double size_px) {
    Mark& round = signs.emplace_back(sign);
    round.shape = shape;
    round.size_px = size_px;
    round.label.clear();
  };
  if (state.outlier > 0.0) add_round(MarkShape::kTriangle, 2.0 * kSize);
  if (state.chosen) add_round(MarkShape::kCircle, kChosenSize);
  signs.push_back(std::move(sign));
  return signs;
}

std::vector<Mark> annotationSigns(const sessions::Annotations& annotations,
                                  const AnnotationLook& look) {
  Signs signs{look};
  int item = 0;
  for (const sessions::PointPair& point : annotations.points) signs.addPoint(point, item++);
  for (const sessions::LinePair& line : annotations.lines) signs.addLine(line, item++);
  return std::move(signs.signs);
}

std::vector<Mark> residualSigns(const std::vector<sessions::AnnotationVector>& vectors,
                                const AnnotationLook& look, double magnification, bool stale) {
  std::vector<Mark> signs;
  for (const sessions::AnnotationVector& vector : vectors) {
    Mark mark = sign(MarkShape::kArrow, vector.predicted, -1);
    mark.to = pointOf(vector.predicted + magnification * (vector.seen - vector.predicted));
    mark.dashed = stale;
    if (look.outliers.contains(vector.id)) mark.color = kOutlierAnnotation;
    signs.push_back(std::move(mark));
  }
  return signs;
}

std::vector<Mark> proposalSigns(const std::vector<sessions::Proposal>& proposals) {
  std::vector<Mark> signs;
  for (const sessions::Proposal& proposal : proposals) {
    Mark mark = sign(proposal.seen ? MarkShape::kCircle : MarkShape::kDiamond, proposal.pixel, -1);
    mark.dashed = true;
    const QString name = QString::fromStdString(proposal.landmark.name);
    mark.label =
        proposal.seen ? contentText("%1 ?").arg(name) : contentText("%1 ? (hidden)").arg(name);
    signs.push_back(std::move(mark));
  }
  return signs;
}

std::vector<Mark> bandSigns(const std::vector<sessions::BandPiece>& band) {
  std::vector<Mark> signs;
  for (const sessions::BandPiece& piece : band) {
    if (piece.places.size() < 2) continue;
    Mark mark;
    mark.shape = MarkShape::kStrip;
    mark.width = 1.0;
    for (const sessions::BandPlace& place : piece.places)
      mark.outline << pointOf(place.pixel + place.half_width_px * place.normal);
    for (auto place = piece.places.rbegin(); place != piece.places.rend(); ++place)
      mark.outline << pointOf(place->pixel - place->half_width_px * place->normal);
    signs.push_back(std::move(mark));
  }
  return signs;
}

std::string idOfSign(const sessions::Annotations& annotations, int item) {
  if (item < 0) return {};
  const auto index = static_cast<std::size_t>(item);
  if (index < annotations.points.size()) return annotations.points[index].id;
  const std::size_t line = index - annotations.points.size();
  return line < annotations.lines.size() ? annotations.lines[line].id : std::string();
}

}  // namespace boresight::ui
