// SPDX-License-Identifier: Apache-2.0
#include "ui/panels/diagnose/pixel_picture.h"

#include <algorithm>
#include <cmath>
#include <utility>

#include <QtWidgets>

#include "ui/models/text.h"
#include "ui/plots/plot_colors.h"
#include "ui/views/overlay_painters.h"

namespace boresight::ui {
namespace {

bool bitAt(const BitImage& image, const PatchPlace& place, int u, int v) {
  const int x = place.center_x - place.side_px / 2 + u;
  const int y = place.center_y - place.side_px / 2 + v;
  return image.contains(x, y) && image.get(x, y);
}

QSize sideOf(const PatchPlace& place) { return {place.side_px, place.side_px}; }

/// color_of(u, v) for every pixel.
template <class ColorOf>
QImage drawn(const QSize& size, const ColorOf& color_of) {
  QImage picture(size, QImage::Format_RGB32);
  for (int v = 0; v < size.height(); ++v) {
    auto* line = reinterpret_cast<QRgb*>(picture.scanLine(v));
    for (int u = 0; u < size.width(); ++u) line[u] = color_of(u, v);
  }
  return picture;
}

/// From here on squares of unequal size would be seen as such; below, size counts for more.
constexpr double kWholeScale = 3.0;

QImage heatPicture(const sessions::ScoreMap& map) {
  const SearchWindow& window = map.window;
  const double range = map.highest - map.lowest;
  return drawn(QSize(window.width(), window.height()), [&](int u, int v) {
    const double score = map.scoreAt(window.x_min + u, window.y_min + v);
    return heatColor(range > 0.0 ? (score - map.lowest) / range : 0.0).rgb();
  });
}

void drawMark(QPainter& painter, MarkShape shape, const QPointF& at, double radius) {
  Mark mark;
  mark.shape = shape;
  mark.at = at - QPointF(0.5, 0.5);
  mark.size_px = 2.0 * radius;
  mark.cased = true;  // shows on every colour
  mark.width = 1.8;
  paintMark(painter, ViewTransform(), mark, Qt::white);
}

}  // namespace

QImage templatePicture(const BitImage& edges, const BitImage& mask, const PatchPlace& place) {
  return drawn(sideOf(place), [&](int u, int v) {
    if (bitAt(edges, place, u, v)) return patch_colors::kEdge;
    return bitAt(mask, place, u, v) ? patch_colors::kMask : patch_colors::kGround;
  });
}

QImage seenPicture(const BitImage& test_edges, const PatchPlace& place) {
  return drawn(sideOf(place), [&](int u, int v) {
    return bitAt(test_edges, place, u, v) ? patch_colors::kEdge : patch_colors::kGround;
  });
}

QImage agreementPicture(const BitImage& edges, const BitImage& mask, const PatchPlace& rendered,
                        const BitImage& test_edges, const PatchPlace& found) {
  return drawn(sideOf(rendered), [&](int u, int v) {
    if (!bitAt(mask, rendered, u, v)) return patch_colors::kGround;
    const bool is_rendered = bitAt(edges, rendered, u, v);
    const bool is_seen = bitAt(test_edges, found, u, v);
    if (is_rendered && is_seen) return patch_colors::kEdge;
    if (is_rendered) return patch_colors::kOnlyRendered;
    return is_seen ? patch_colors::kOnlySeen : patch_colors::kMask;
  });
}

QRectF pixelPlace(const QSize& picture, const QRectF& room, double device_pixel_ratio) {
  const double across = room.width() * device_pixel_ratio / std::max(1, picture.width());
  const double down = room.height() * device_pixel_ratio / std::max(1, picture.height());
  const double fits = std::min(across, down);
  const double scale = (fits >= kWholeScale ? std::floor(fits) : fits) / device_pixel_ratio;
  QRectF place(QPointF(), QSizeF(picture) * scale);
  place.moveCenter(room.center());
  // On whole device pixels, or the squares blur.
  const auto whole = [&](double value) {
    return std::round(value * device_pixel_ratio) / device_pixel_ratio;
  };
  place.moveTopLeft({whole(place.left()), whole(place.top())});
  return place;
}

QString colorText(QRgb color, const QString& meaning) {
  return QStringLiteral("<span style='background:%1; color:%2'>■</span>&nbsp;%3 ")
      .arg(QColor(patch_colors::kGround).name(), QColor(color).name(), meaning);
}

PixelPicture::PixelPicture(QWidget* parent)
    : QWidget(parent), title_(new QLabel(this)), note_(new QLabel(this)) {
  auto* column = new QVBoxLayout(this);
  column->setContentsMargins(0, 0, 0, 0);
  column->addWidget(title_);
  column->addStretch(1);
  column->addWidget(note_);
  for (QLabel* label : {title_, note_}) {
    label->setAlignment(Qt::AlignCenter);
    label->setWordWrap(true);
  }
}

void PixelPicture::setTitle(const QString& title) {
  setAccessibleName(title);
  title_->setText(title);
}

void PixelPicture::setPicture(const QImage& picture, const QString& note) {
  picture_ = picture;
  note_->setText(note);
  static_cast<QVBoxLayout*>(layout())->setStretch(1, picture.isNull() ? 0 : 1);
  update();
}

QString PixelPicture::note() const { return note_->text(); }

QRectF PixelPicture::place() const {
  layout()->activate();  // the note may have changed its height
  const double top = title_->geometry().bottom() + 3.0;
  const QRectF room(0.0, top, width() - marginRight(), note_->geometry().top() - 2.0 - top);
  return pixelPlace(picture_.size(), room, devicePixelRatioF());
}

void PixelPicture::paintEvent(QPaintEvent* /*event*/) {
  if (picture_.isNull()) return;
  QPainter painter(this);
  painter.drawImage(place(), picture_);
  paintOver(painter);
}

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
  return tr("%1, %2 px from the predicted position (level %3)\nS = %4\nS+/c+ = %5/%6, S-/c- = "
            "%7/%8")
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
  drawMark(painter, MarkShape::kCross, toWidget(marks_.predicted_x, marks_.predicted_y), 7.0);
  if (marks_.peak.has_second)
    drawMark(painter, MarkShape::kSquare, toWidget(marks_.peak.second_x, marks_.peak.second_y),
             5.0);
  drawMark(painter, MarkShape::kCircle, toWidget(marks_.peak.x, marks_.peak.y), 6.0);
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
