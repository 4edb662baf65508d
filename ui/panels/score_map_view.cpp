// SPDX-License-Identifier: Apache-2.0
#include "ui/panels/score_map_view.h"

#include <cmath>
#include <utility>

#include <QtWidgets>

#include "ui/models/number_text.h"
#include "ui/plots/plot_colors.h"

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
          heatColor(range > 0.0 ? (map.scoreAt(x, y) - map.lowest) / range : 0.0).rgb();
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

ScoreMapView::ScoreMapView(QWidget* parent) : PixelPicture(parent) { setTitle(tr("Score map")); }

void ScoreMapView::setMap(MapPtr map, const Marks& marks) {
  map_ = std::move(map);
  marks_ = marks;
  const QImage picture = heatPicture(*map_);
  setTitle(tr("Score map, %1 x %2 px").arg(picture.width()).arg(picture.height()));
  setPicture(picture, legend());
}

void ScoreMapView::setNote(const QString& note) {
  map_.reset();
  setTitle(tr("Score map"));
  setPicture({}, note);
}

double ScoreMapView::marginRight() const {
  return fontMetrics().horizontalAdvance(QStringLiteral("0.000")) + 28;
}

QPointF ScoreMapView::toWidget(double x, double y) const {
  if (!map_) return {};
  const QRectF shown = place();
  const double scale = shown.width() / picture().width();
  return shown.topLeft() +
         QPointF(x - map_->window.x_min + 0.5, y - map_->window.y_min + 0.5) * scale;
}

QString ScoreMapView::textAt(const QPointF& widget) const {
  if (!map_ || !place().contains(widget)) return {};
  const QRectF shown = place();
  const double scale = picture().width() / shown.width();
  const QPointF inside = (widget - shown.topLeft()) * scale;
  const int x = map_->window.x_min + std::min(static_cast<int>(inside.x()), picture().width() - 1);
  const int y = map_->window.y_min + std::min(static_cast<int>(inside.y()), picture().height() - 1);
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
  if (event->type() != QEvent::ToolTip || !map_) return PixelPicture::event(event);
  const auto* help = static_cast<QHelpEvent*>(event);
  QToolTip::showText(help->globalPos(), textAt(help->pos()), this);
  return true;
}

void ScoreMapView::paintOver(QPainter& painter) const {
  paintScale(painter);
  painter.setRenderHint(QPainter::Antialiasing);
  painter.setClipRect(place().adjusted(-6, -6, 6, 6));
  drawMark(painter, Shape::kCross, toWidget(marks_.predicted_x, marks_.predicted_y), 7.0);
  if (marks_.peak.has_second)
    drawMark(painter, Shape::kSquare, toWidget(marks_.peak.second_x, marks_.peak.second_y), 5.0);
  drawMark(painter, Shape::kCircle, toWidget(marks_.peak.x, marks_.peak.y), 6.0);
}

void ScoreMapView::paintScale(QPainter& painter) const {
  const QRectF map = place();
  const int line = fontMetrics().height();
  const QRectF bar(map.right() + 8.0, map.top(), 12.0, map.height());
  QLinearGradient gradient(bar.bottomLeft(), bar.topLeft());
  for (int i = 0; i <= 8; ++i) gradient.setColorAt(i / 8.0, heatColor(i / 8.0));
  painter.fillRect(bar, gradient);
  painter.setPen(palette().color(QPalette::WindowText));
  const auto label = [&](double value, double y) {
    painter.drawText(QRectF(bar.right() + 4.0, y, width() - bar.right() - 4.0, line),
                     Qt::AlignLeft | Qt::AlignVCenter, numberText(value, 3));
  };
  label(map_->highest, bar.top());
  label(0.5 * (map_->lowest + map_->highest), bar.center().y() - 0.5 * line);
  label(map_->lowest, bar.bottom() - line);
}

/// The window is about the hypothesis without its roll, a template may come from a rolled render.
QString ScoreMapView::legend() const {
  const SearchWindow& window = map_->window;
  const bool inside = marks_.predicted_x >= window.x_min && marks_.predicted_x <= window.x_max &&
                      marks_.predicted_y >= window.y_min && marks_.predicted_y <= window.y_max;
  return (inside ? tr("+ predicted  ○ peak") : tr("+ predicted (outside)  ○ peak")) +
         (marks_.peak.has_second ? tr("  □ second") : QString());
}

}  // namespace boresight::ui
