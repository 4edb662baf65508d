// SPDX-License-Identifier: Apache-2.0
#include "ui/annotation/annotation_aim.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <numbers>

#include <QCoreApplication>
#include <QFontMetricsF>

#include "sessions/annotation/annotations_on_image.h"
#include "sessions/trace/surface_point.h"
#include "ui/models/text.h"
#include "ui/views/overlay_painters.h"

namespace boresight::ui {

using sessions::ImageSnap;
using sessions::MeshSnap;

namespace {

constexpr double kSnapRadius = 12.0;  ///< on the screen
constexpr double kLeastRadius_px = 2.0;
constexpr double kMostRadius_px = 12.0;
constexpr double kRims = 3.0;  ///< an ellipse's rim may be this many radii away
constexpr double kLeastRim_px = 16.0;

QString aimText(const char* text) { return QCoreApplication::translate("MarkAim", text); }

constexpr std::array<const char*, 3> kImageSnapNames = {"corner", "ellipse centre", "edge"};
constexpr std::array<const char*, 3> kMeshSnapNames = {"vertex", "model edge", "circle centre"};

/// Which of several, and how many there are to choose from.
template <class Snap>
const Snap& chosenOf(const std::vector<Snap>& snaps, int turn, AnnotationAim& aim) {
  aim.found = static_cast<int>(snaps.size());
  aim.chosen = turn % aim.found;
  return snaps[static_cast<std::size_t>(aim.chosen)];
}

}  // namespace

double snapRadius_px(double scale) {
  return std::clamp(kSnapRadius / scale, kLeastRadius_px, kMostRadius_px);
}

AnnotationAim aimAtImage(const sessions::LoadedCase& loaded_case, const Eigen::Vector2d& pointer,
                         const AimRules& rules) {
  AnnotationAim aim;
  aim.side = AimSide::kImage;
  aim.pixel = pointer;
  aim.text = aimText("free");
  if (!rules.snaps) return aim;
  std::vector<ImageSnap> snaps =
      sessions::imageSnaps(loaded_case.image.view(), pointer, rules.radius_px,
                           std::max(kLeastRim_px, kRims * rules.radius_px));
  // Ends of a line lie on an edge; where it ends or what it goes round does not count.
  if (rules.line)
    std::stable_partition(snaps.begin(), snaps.end(), [](const ImageSnap& snap) {
      return snap.kind == sessions::ImageSnapKind::kEdge;
    });
  if (snaps.empty()) return aim;
  aim.snap = chosenOf(snaps, rules.turn, aim);
  aim.pixel = aim.snap->pixel;
  aim.text = aimText(kImageSnapNames[static_cast<std::size_t>(aim.snap->kind)]);
  return aim;
}

AnnotationAim aimAtStation(const sessions::LoadedCase& loaded_case, const Pose& camera_from_station,
                           const Eigen::Vector2d& pointer, std::vector<MeshSnap> snaps,
                           const AimRules& rules) {
  AnnotationAim aim;
  const Camera& camera = loaded_case.source.camera;
  // "circle centre, z -10.00 mm": which of two that lie one behind the other.
  const auto aim_at = [&aim](const Eigen::Vector2d& pixel,
                             const Eigen::Vector3d& point_in_station_m, const char* name) {
    aim.side = AimSide::kStation;
    aim.pixel = pixel;
    aim.point_in_station_m = point_in_station_m;
    aim.text =
        aimText("%1, z %2 mm").arg(aimText(name), numberText(1e3 * point_in_station_m.z(), 2));
  };
  if (rules.line) std::erase_if(snaps, [](const MeshSnap& snap) { return !snap.edge; });
  if (!snaps.empty() && (rules.snaps || rules.line)) {
    const MeshSnap& snap = chosenOf(snaps, rules.turn, aim);
    aim_at(snap.pixel, snap.point_in_station_m,
           kMeshSnapNames[static_cast<std::size_t>(snap.kind)]);
    aim.edge = snap.edge;
    if (snap.edge)
      aim.edge_on_image = sessions::edgeOnImage(camera, camera_from_station, *snap.edge);
    return aim;
  }
  if (rules.line) return aim;
  const auto surface =
      sessions::surfacePointAt(camera, loaded_case.scene.view(), camera_from_station, pointer);
  if (surface) aim_at(pointer, surface->in_station_m, "surface");
  return aim;
}

namespace {

constexpr double kPlaceHalf = 7.0;  ///< of the place's sign
constexpr double kNormal = 26.0;    ///< length of an edge's normal
constexpr double kBeside = 16.0;
constexpr double kPadding = 6.0;
const QColor kImageColor(255, 255, 255);
const QColor kStationColor(120, 220, 255);
const QColor kAimRim(0, 0, 0, 170);

QPolygonF ellipseOnWidget(const ViewTransform& transform, const sessions::EllipseSnap& ellipse) {
  constexpr int kPieces = 72;
  QPolygonF line;
  const Eigen::Vector2d along(std::cos(ellipse.angle_rad), std::sin(ellipse.angle_rad));
  const Eigen::Vector2d across(-along.y(), along.x());
  for (int i = 0; i <= kPieces; ++i) {
    const double angle = 2.0 * std::numbers::pi * i / kPieces;
    line << transform.toWidget(ellipse.centre + ellipse.half_axes_px.x() * std::cos(angle) * along +
                               ellipse.half_axes_px.y() * std::sin(angle) * across);
  }
  return line;
}

QSizeF boxSize(const QPainter& painter, const QString& text) {
  const QFontMetricsF metrics(painter.font());
  return {metrics.horizontalAdvance(text) + 2.0 * kPadding, metrics.height() + 4.0};
}

void paintFound(QPainter& painter, const ViewTransform& transform, const AnnotationAim& aim) {
  const QPointF at = transform.toWidget(aim.pixel);
  if (aim.snap && aim.snap->kind == sessions::ImageSnapKind::kEllipse)
    painter.drawPolyline(ellipseOnWidget(transform, aim.snap->ellipse));
  if (aim.snap && aim.snap->kind == sessions::ImageSnapKind::kEdge) {
    const QPointF normal = pointOf(aim.snap->edge.normal);
    const QPointF along(-normal.y(), normal.x());
    painter.drawLine(at - kNormal * along, at + kNormal * along);
    painter.drawLine(at + kPlaceHalf * normal, at + kNormal * normal);  // towards the bright side
  }
  QPolygonF edge;
  for (const Eigen::Vector2d& pixel : aim.edge_on_image) edge << transform.toWidget(pixel);
  if (edge.size() > 1) painter.drawPolyline(edge);
}

}  // namespace

void paintAim(QPainter& painter, const ViewTransform& transform, const AnnotationAim& aim,
              const QPointF& pointer) {
  if (aim.side == AimSide::kNone) return;
  const QPointF at = transform.toWidget(aim.pixel);
  const QColor color = aim.side == AimSide::kImage ? kImageColor : kStationColor;
  painter.save();
  painter.setRenderHint(QPainter::Antialiasing, true);
  painter.setBrush(Qt::NoBrush);
  for (const QPen& pen : {QPen(kAimRim, 3.2), QPen(color, 1.4)}) {
    painter.setPen(pen);
    paintFound(painter, transform, aim);
    paintTicks(painter, at, 2.5, kPlaceHalf + 3.0);
    if (aim.found > 0) painter.drawPolygon(diamond(at, kPlaceHalf));
  }
  if (aim.found > 0) {
    painter.setPen(QPen(color, 1.0, Qt::DotLine));
    painter.drawLine(transform.toWidget(pointer), at);
  }
  painter.restore();
}

QRectF paintBox(QPainter& painter, const QPointF& top_left, const QString& text, double room) {
  const QSizeF size = boxSize(painter, text);
  const QRectF box(top_left, size + QSizeF(room, 0.0));
  painter.save();
  painter.setRenderHint(QPainter::Antialiasing, true);
  painter.setPen(Qt::NoPen);
  painter.setBrush(QColor(0, 0, 0, 190));
  painter.drawRoundedRect(box, 3.0, 3.0);
  painter.setPen(QColor(255, 255, 255));
  painter.drawText(QRectF(top_left, size), Qt::AlignCenter, text);
  painter.restore();
  return box;
}

void paintNote(QPainter& painter, const QRectF& area, const QRectF& taken, const QPointF& anchor,
               const QString& text) {
  if (text.isEmpty()) return;
  QRectF box(anchor + QPointF(kBeside, kBeside), boxSize(painter, text));
  if (box.right() > area.right() || box.intersects(taken)) box.moveRight(anchor.x() - kBeside);
  if (box.left() < area.left()) box.moveTopLeft(QPointF(area.left(), anchor.y() + 2.0 * kBeside));
  if (box.bottom() > area.bottom()) box.moveBottom(anchor.y() - kBeside);
  paintBox(painter, box.topLeft(), text);
}

}  // namespace boresight::ui
