// SPDX-License-Identifier: Apache-2.0
#include "ui/panels/score_map_view.h"

#include <cmath>
#include <utility>
#include <vector>

#include <QtWidgets>

#include "ui/models/number_text.h"
#include "ui/panels/pixel_picture.h"

namespace boresight::ui {
namespace {

enum class Shape { kCross, kCircle, kSquare };

QImage heatPicture(const sessions::ScoreMap& map) {
  const SearchWindow& window = map.window;
  const double range = map.highest - map.lowest;
  QImage picture(window.width(), window.height(), QImage::Format_RGB32);
  for (int y = window.y_min; y <= window.y_max; ++y) {
    auto* line = reinterpret_cast<QRgb*>(picture.scanLine(y - window.y_min));
    for (int x = window.x_min; x <= window.x_max; ++x)
      line[x - window.x_min] =
          heatColor(range > 0.0 ? (map.scoreAt(x, y) - map.lowest) / range : 0.0);
  }
  return picture;
}

void drawShape(QPainter& painter, Shape shape, const QPointF& at, double radius) {
  switch (shape) {
    case Shape::kCross:
      painter.drawLine(at - QPointF(radius, 0), at + QPointF(radius, 0));
      painter.drawLine(at - QPointF(0, radius), at + QPointF(0, radius));
      break;
    case Shape::kCircle:
      painter.drawEllipse(at, radius, radius);
      break;
    case Shape::kSquare:
      painter.drawRect(QRectF(at - QPointF(radius, radius), at + QPointF(radius, radius)));
      break;
  }
}

/// White with a black rim, so that it shows on every colour.
void drawMark(QPainter& painter, Shape shape, const QPointF& at, double radius) {
  painter.setBrush(Qt::NoBrush);
  painter.setPen(QPen(Qt::black, 4.0));
  drawShape(painter, shape, at, radius);
  painter.setPen(QPen(Qt::white, 1.8));
  drawShape(painter, shape, at, radius);
}

}  // namespace

ScoreMapView::ScoreMapView(QWidget* parent) : QWidget(parent) {
  setAccessibleName(tr("Score map"));
}

void ScoreMapView::setMap(MapPtr map, const Marks& marks) {
  map_ = std::move(map);
  marks_ = marks;
  picture_ = map_ ? heatPicture(*map_) : QImage();
  note_.clear();
  update();
}

void ScoreMapView::setNote(const QString& note) {
  map_.reset();
  picture_ = QImage();
  note_ = note;
  update();
}

QRectF ScoreMapView::mapPlace() const {
  const int line = fontMetrics().height();
  const int scale = fontMetrics().horizontalAdvance(QStringLiteral("0.000")) + 28;
  const int below = layOutLegend(nullptr) * line;
  const QRectF room(0, line + 4, width() - scale, height() - line - below - 8);
  return pixelPlace(picture_.size(), room, devicePixelRatioF());
}

QPointF ScoreMapView::toWidget(double x, double y) const {
  if (!map_) return {};
  const QRectF place = mapPlace();
  const double scale = place.width() / picture_.width();
  return place.topLeft() +
         QPointF(x - map_->window.x_min + 0.5, y - map_->window.y_min + 0.5) * scale;
}

QString ScoreMapView::textAt(const QPointF& widget) const {
  if (!map_ || !mapPlace().contains(widget)) return {};
  const QRectF place = mapPlace();
  const double scale = picture_.width() / place.width();
  const QPointF inside = (widget - place.topLeft()) * scale;
  const int x = map_->window.x_min + std::min(static_cast<int>(inside.x()), picture_.width() - 1);
  const int y = map_->window.y_min + std::min(static_cast<int>(inside.y()), picture_.height() - 1);
  const WhsCounts& counts = map_->countsAt(x, y);
  return tr("%1, %2 px from the predicted place (level %3)\nS = %4\nS+/c+ = %5/%6, S-/c- = %7/%8")
      .arg(x - marks_.predicted_x)
      .arg(y - marks_.predicted_y)
      .arg(map_->level)
      .arg(numberText(map_->scoreAt(x, y), 3))
      .arg(counts.edge_hits)
      .arg(map_->norms.edges)
      .arg(counts.empty_hits)
      .arg(map_->norms.empties);
}

bool ScoreMapView::event(QEvent* event) {
  if (event->type() != QEvent::ToolTip) return QWidget::event(event);
  const auto* help = static_cast<QHelpEvent*>(event);
  QToolTip::showText(help->globalPos(), textAt(help->pos()), this);
  return true;
}

void ScoreMapView::paintEvent(QPaintEvent* /*event*/) {
  QPainter painter(this);
  const int line = fontMetrics().height();
  painter.setPen(palette().color(QPalette::WindowText));
  if (!map_) {
    painter.drawText(QRect(0, 0, width(), line), Qt::AlignCenter, tr("Score map"));
    painter.drawText(rect().adjusted(4, line, -4, 0), Qt::AlignCenter | Qt::TextWordWrap, note_);
    return;
  }
  painter.drawText(QRect(0, 0, width(), line), Qt::AlignCenter,
                   fontMetrics().elidedText(
                       tr("Score map, %1 x %2 px").arg(picture_.width()).arg(picture_.height()),
                       Qt::ElideRight, width()));
  const QRectF place = mapPlace();
  painter.drawImage(place, picture_);
  paintScale(painter, place);
  painter.setRenderHint(QPainter::Antialiasing);
  paintMarks(painter);
  layOutLegend(&painter);
}

void ScoreMapView::paintScale(QPainter& painter, const QRectF& beside) const {
  const int line = fontMetrics().height();
  const QRectF bar(beside.right() + 8, line + 4, 12,
                   height() - (1 + layOutLegend(nullptr)) * line - 8);
  const int steps = static_cast<int>(bar.height());
  for (int i = 0; i < steps; ++i) {
    const QColor color(heatColor(1.0 - static_cast<double>(i) / std::max(1, steps - 1)));
    painter.fillRect(QRectF(bar.left(), bar.top() + i, bar.width(), 1.0), color);
  }
  painter.setPen(palette().color(QPalette::WindowText));
  const auto label = [&](double value, double y) {
    painter.drawText(QRectF(bar.right() + 4, y, width() - bar.right() - 4, line),
                     Qt::AlignLeft | Qt::AlignVCenter, numberText(value, 3));
  };
  label(map_->highest, bar.top());
  label(0.5 * (map_->lowest + map_->highest), bar.center().y() - 0.5 * line);
  label(map_->lowest, bar.bottom() - line);
}

void ScoreMapView::paintMarks(QPainter& painter) const {
  painter.save();
  painter.setClipRect(mapPlace().adjusted(-6, -6, 6, 6));
  drawMark(painter, Shape::kCross, toWidget(marks_.predicted_x, marks_.predicted_y), 7.0);
  if (marks_.peak.has_second)
    drawMark(painter, Shape::kSquare, toWidget(marks_.peak.second_x, marks_.peak.second_y), 5.0);
  drawMark(painter, Shape::kCircle, toWidget(marks_.peak.x, marks_.peak.y), 6.0);
  painter.restore();
}

int ScoreMapView::layOutLegend(QPainter* painter) const {
  std::vector<std::pair<Shape, QString>> entries = {
      {Shape::kCross, tr("predicted") + outsideText()}, {Shape::kCircle, tr("peak")}};
  if (marks_.peak.has_second) entries.emplace_back(Shape::kSquare, tr("second"));
  const int line = fontMetrics().height();
  std::vector<QPoint> places;
  int x = 0;
  int lines = 1;
  for (const auto& [shape, text] : entries) {
    const int wide = 16 + fontMetrics().horizontalAdvance(text);
    if (x > 0 && x + wide > width()) {
      x = 0;
      ++lines;
    }
    places.emplace_back(x, (lines - 1) * line);
    x += wide + 8;
  }
  if (!painter) return lines;
  const QPoint top(0, height() - lines * line);
  for (std::size_t i = 0; i < entries.size(); ++i) {
    const QPoint at = top + places[i];
    drawMark(*painter, entries[i].first, at + QPointF(8.0, 0.5 * line), 4.0);
    painter->setPen(palette().color(QPalette::WindowText));
    painter->drawText(QRect(at + QPoint(16, 0), QSize(width(), line)),
                      Qt::AlignLeft | Qt::AlignVCenter, entries[i].second);
  }
  return lines;
}

/// The window is about the hypothesis without its roll, a template may come from a rolled render.
QString ScoreMapView::outsideText() const {
  const SearchWindow& window = map_->window;
  const bool inside = marks_.predicted_x >= window.x_min && marks_.predicted_x <= window.x_max &&
                      marks_.predicted_y >= window.y_min && marks_.predicted_y <= window.y_max;
  return inside ? QString() : tr(" (outside)");
}

}  // namespace boresight::ui
