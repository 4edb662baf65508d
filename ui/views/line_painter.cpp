// SPDX-License-Identifier: Apache-2.0
#include "ui/views/line_painter.h"

#include <algorithm>
#include <cmath>
#include <optional>
#include <utility>

#include <QPainter>
#include <QPolygonF>

#include "ui/views/view_transform.h"

namespace boresight::ui {
namespace {

constexpr double kDotLength_px = 0.05;  ///< a dash without length is not drawn

double dashOf(const LineToken& line) { return std::max(line.dash_px, kDotLength_px); }

/// Length of one repetition of the pattern; 0: solid.
double periodOf(const LineToken& line) {
  return line.gap_px > 0.0 ? dashOf(line) + line.gap_px : 0.0;
}

QPen penOf(const LineToken& line, const QColor& color, double width_px) {
  QPen pen(color, width_px, Qt::SolidLine, line.round_cap ? Qt::RoundCap : Qt::FlatCap,
           Qt::RoundJoin);
  // Qt counts dashes in widths of the pen.
  if (line.gap_px > 0.0) pen.setDashPattern({dashOf(line) / width_px, line.gap_px / width_px});
  return pen;
}

/// The part of a segment within a rectangle, as shares of the segment.
std::optional<std::pair<double, double>> shareWithin(const QRectF& area, const QPointF& from,
                                                     const QPointF& to) {
  double first = 0.0;
  double last = 1.0;
  const auto cut = [&](double start, double way, double low, double high) {
    if (way == 0.0) return start >= low && start <= high;
    const double a = (low - start) / way;
    const double b = (high - start) / way;
    first = std::max(first, std::min(a, b));
    last = std::min(last, std::max(a, b));
    return first <= last;
  };
  if (!cut(from.x(), to.x() - from.x(), area.left(), area.right()) ||
      !cut(from.y(), to.y() - from.y(), area.top(), area.bottom()))
    return std::nullopt;
  return std::pair(first, last);
}

/// Draws the parts of a line that are seen.
void paintLine(QPainter& painter, const ViewTransform& transform, const sessions::EdgeLine& line,
               QPen pen, double period_px, const QRectF& area) {
  QPolygonF run;
  double begin = 0.0;  // length of the line before the run
  const auto flush = [&] {
    if (run.size() > 1) {
      if (period_px > 0.0) pen.setDashOffset(std::fmod(begin, period_px) / pen.widthF());
      painter.setPen(pen);
      painter.drawPolyline(run);
    }
    run.clear();
  };
  double length = 0.0;  // up to `from`
  QPointF from = transform.toWidget(line.places_px.front());
  for (std::size_t i = 1; i < line.places_px.size(); ++i) {
    const QPointF to = transform.toWidget(line.places_px[i]);
    const double segment = distance_px(from, to);
    if (const auto share = shareWithin(area, from, to)) {
      if (run.isEmpty() || share->first > 0.0) {
        flush();
        begin = length + share->first * segment;
        run << from + share->first * (to - from);
      }
      run << from + share->second * (to - from);
      if (share->second < 1.0) flush();
    } else {
      flush();
    }
    length += segment;
    from = to;
  }
  flush();
}

}  // namespace

QPen linePen(const LineToken& line) { return penOf(line, QColor(line.color), line.width_px); }

QPen haloPen(const LineToken& line) {
  QColor color(line.halo);
  color.setAlphaF(line.halo_opacity);
  return penOf(line, color, line.width_px + line.halo_px);
}

void paintLines(QPainter& painter, const ViewTransform& transform, const sessions::EdgeLines& lines,
                const LineToken& line, const QRectF& seen) {
  const double margin = line.width_px + line.halo_px;
  const QRectF area = seen.adjusted(-margin, -margin, margin, margin);
  const QRectF pixels(transform.toPixel(area.topLeft()), transform.toPixel(area.bottomRight()));
  const Eigen::AlignedBox2d box(Eigen::Vector2d(pixels.left(), pixels.top()),
                                Eigen::Vector2d(pixels.right(), pixels.bottom()));
  painter.setBrush(Qt::NoBrush);
  // All halos first: none lies over a neighbouring line.
  for (const QPen& pen : {haloPen(line), linePen(line)})
    for (const sessions::EdgeLine& each : lines)
      if (box.intersects(each.box_px))
        paintLine(painter, transform, each, pen, periodOf(line), area);
}

void paintLineSample(QPainter& painter, const QRectF& box, const LineToken& line) {
  const double y = box.center().y();
  for (const QPen& pen : {haloPen(line), linePen(line)}) {
    painter.setPen(pen);
    painter.drawLine(QPointF(box.left(), y), QPointF(box.right(), y));
  }
}

}  // namespace boresight::ui
