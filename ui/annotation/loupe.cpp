// SPDX-License-Identifier: Apache-2.0
#include "ui/annotation/loupe.h"

#include <algorithm>
#include <cmath>
#include <utility>
#include <vector>

#include <QtWidgets>

#include "ui/views/display_image.h"
#include "ui/views/image_view.h"
#include "ui/views/line_painter.h"
#include "ui/views/overlay_painters.h"

namespace boresight::ui {
namespace {

const QRgb kOutside = qRgb(24, 24, 24);

/// The image pixel under the centre of each of `count` screen pixels.
std::vector<int> pixelsUnder(const ViewTransform& transform, int count, double ratio, bool rows) {
  std::vector<int> pixels;
  for (int i = 0; i < count; ++i) {
    const double place = (i + 0.5) / ratio;
    const QPointF pixel = transform.toPixel(QPointF(place, place));
    pixels.push_back(static_cast<int>(std::floor((rows ? pixel.y() : pixel.x()) + 0.5)));
  }
  return pixels;
}

}  // namespace

QImage loupePicture(const sessions::ImageSamples& samples, const ViewTransform& transform,
                    const QSize& size, double device_pixel_ratio) {
  QImage picture(size, QImage::Format_RGB32);
  picture.fill(kOutside);
  const auto columns = pixelsUnder(transform, size.width(), device_pixel_ratio, false);
  const auto rows = pixelsUnder(transform, size.height(), device_pixel_ratio, true);
  const QRect shown =
      QRect(QPoint(columns.front(), rows.front()), QPoint(columns.back(), rows.back())) &
      QRect(0, 0, samples.width, samples.height);
  if (!shown.isEmpty()) {
    sessions::ImageSamples piece;
    piece.width = shown.width();
    piece.height = shown.height();
    piece.sample_bits = samples.sample_bits;
    for (int y = shown.top(); y <= shown.bottom(); ++y) {
      const auto row = samples.values.begin() + std::ptrdiff_t{y} * samples.width + shown.left();
      piece.values.insert(piece.values.end(), row, row + shown.width());
    }
    const QImage gray = stretched(piece, automaticLevels(piece));
    for (int y = 0; y < size.height(); ++y) {
      const int row = rows[static_cast<std::size_t>(y)];
      if (row < shown.top() || row > shown.bottom()) continue;
      auto* line = reinterpret_cast<QRgb*>(picture.scanLine(y));
      const uchar* from = gray.constScanLine(row - shown.top());
      for (int x = 0; x < size.width(); ++x) {
        const int column = columns[static_cast<std::size_t>(x)];
        if (column < shown.left() || column > shown.right()) continue;
        const int value = from[column - shown.left()];
        line[x] = qRgb(value, value, value);
      }
    }
  }
  picture.setDevicePixelRatio(device_pixel_ratio);
  return picture;
}

sessions::ImageSamples samplesOf(const QImage& gray) {
  sessions::ImageSamples samples;
  samples.width = gray.width();
  samples.height = gray.height();
  for (int y = 0; y < gray.height(); ++y)
    samples.values.insert(samples.values.end(), gray.constScanLine(y),
                          gray.constScanLine(y) + gray.width());
  return samples;
}

void putLoupeAside(QWidget& loupe, const LoupeSize& size, const QPoint& place, bool& left) {
  constexpr int kRaster = 4;  // whole screen pixels at ratios of quarters
  constexpr int kMargin = 8;
  constexpr int kShyness = 40;  // how near the pointer may come
  const auto on_raster = [](double length) {
    return kRaster * static_cast<int>(std::floor(length / kRaster));
  };
  const QSize view = loupe.parentWidget()->size();
  const double shorter = std::min(view.width(), view.height());
  const int side = on_raster(std::clamp(size.share * shorter, size.least, size.most));
  const QRect at_right(on_raster(view.width() - side - kMargin), kMargin, side, side);
  const QRect at_left(kMargin, kMargin, side, side);
  const QRect& current = left ? at_left : at_right;
  if (current.adjusted(-kShyness, -kShyness, kShyness, kShyness).contains(place)) left = !left;
  loupe.setGeometry(left ? at_left : at_right);
}

void paintLoupeFoot(QPainter& painter, const QWidget& loupe, const QString& text) {
  painter.setRenderHint(QPainter::Antialiasing, false);
  const int high = painter.fontMetrics().height() + 4;
  const QRect line(0, loupe.height() - high, loupe.width(), high);
  painter.fillRect(line, QColor(0, 0, 0, 170));
  painter.setPen(QColor(255, 255, 255));
  painter.drawText(line, Qt::AlignCenter, text);
  painter.setPen(QPen(loupe.palette().color(QPalette::Highlight), 2.0));
  painter.setBrush(Qt::NoBrush);
  painter.drawRect(loupe.rect().adjusted(1, 1, -1, -1));
}

namespace {

constexpr LoupeSize kLoupeSize = {0.5, 168.0, 320.0};
constexpr int kSmallestText = 9;
constexpr double kEdgeOpacity = 0.7;  ///< the image below stays to be seen
const LayerId kEdgeLayers[] = {LayerId::kSeedEdges, LayerId::kTruthEdges, LayerId::kIterationEdges,
                               LayerId::kNudgedEdges, LayerId::kAnnotationEdges};
const LayerId kAnnotationLayers[] = {LayerId::kAnnotationBand, LayerId::kProposals,
                                     LayerId::kPoints};

}  // namespace

Loupe::Loupe(ImageView& view) : QWidget(&view), view_(view) {
  setObjectName(QStringLiteral("loupe"));
  setAttribute(Qt::WA_TransparentForMouseEvents);  // the view takes them
  setAttribute(Qt::WA_OpaquePaintEvent);
  view_.installEventFilter(this);
  hide();
}

void Loupe::setSamples(std::shared_ptr<const sessions::ImageSamples> samples) {
  samples_ = std::move(samples);
  showOrHide();
}

double Loupe::magnification() const {
  const double of_view = view_.transform().scale() * view_.devicePixelRatioF();
  return std::clamp(2.0 * of_view, magnification_, std::max(kMostMagnification, magnification_));
}

void Loupe::setMagnification(double magnification) {
  const double next = std::clamp(magnification, kLeastMagnification, kMostMagnification);
  if (next == magnification_) return;
  magnification_ = next;
  update();
  Q_EMIT changed();
}

void Loupe::setSwitchedOn(bool on) {
  if (on == on_) return;
  on_ = on;
  showOrHide();
  Q_EMIT changed();
}

void Loupe::lookAt(const std::optional<QPointF>& pixel, const AnnotationAim& aim) {
  pixel_ = pixel;
  aim_ = aim;
  showOrHide();
}

void Loupe::showOrHide() {
  const bool shown = on_ && pixel_ && samples_;
  if (shown) putAside();
  setVisible(shown);
  update();
}

void Loupe::putAside() {
  putLoupeAside(*this, kLoupeSize, view_.transform().toWidget(*pixel_).toPoint(), left_);
}

ViewTransform Loupe::transform() const {
  ViewTransform view_transform;
  view_transform.zoomAt(QPointF(0.0, 0.0), magnification() / devicePixelRatioF());
  if (pixel_) view_transform.centreOn(*pixel_, size());
  return view_transform;
}

bool Loupe::eventFilter(QObject* watched, QEvent* event) {
  if (event->type() == QEvent::Resize && isVisible()) putAside();
  if (event->type() == QEvent::Wheel && isVisible()) {
    const auto& wheel = *static_cast<QWheelEvent*>(event);
    const double notches = wheel.angleDelta().y() / 120.0;
    if ((wheel.modifiers() & Qt::ControlModifier) != 0 && notches != 0.0) {
      setMagnification(magnification() * std::pow(kStep, notches));
      return true;
    }
  }
  return QWidget::eventFilter(watched, event);
}

void Loupe::paintEvent(QPaintEvent*) {
  if (!pixel_ || !samples_) return;
  QPainter painter(this);
  const double ratio = devicePixelRatioF();
  const QSize device(static_cast<int>(std::lround(width() * ratio)),
                     static_cast<int>(std::lround(height() * ratio)));
  const ViewTransform shown = transform();
  painter.drawImage(QPointF(0.0, 0.0), loupePicture(*samples_, shown, device, ratio));
  painter.setRenderHint(QPainter::Antialiasing, true);
  if (!view_.layersHidden()) {
    paintEdges(painter, shown);
    paintMarks(painter, shown);
  }
  paintAim(painter, shown, aim_, *pixel_);
  paintLoupeCross(painter, size());
  painter.setPen(Qt::NoPen);
  painter.setBrush(kLoupeCrossColor);
  painter.drawEllipse(QPointF(0.5 * width(), 0.5 * height()), 1.0, 1.0);
  paintText(painter);
}

void Loupe::paintEdges(QPainter& painter, const ViewTransform& transform) const {
  for (const LayerId id : kEdgeLayers) {
    const Layer& layer = view_.layer(id);
    if (!layer.style.visible || !layer.lines) continue;
    painter.setOpacity(kEdgeOpacity * layer.style.opacity);
    paintLines(painter, transform, *layer.lines, layer.shownLine(), QRectF(rect()));
  }
  painter.setOpacity(1.0);
}

void Loupe::paintMarks(QPainter& painter, const ViewTransform& transform) const {
  for (const LayerId id : kAnnotationLayers) {
    const Layer& layer = view_.layer(id);
    if (!layer.style.visible) continue;
    painter.setOpacity(layer.style.opacity);
    for (Mark mark : layer.marks) {
      mark.label.clear();  // words would hide what is looked at
      paintMark(painter, transform, mark, layer.style.color);
    }
  }
  painter.setOpacity(1.0);
}

/// Where the annotation would go, else what the cross is on.
void Loupe::paintText(QPainter& painter) const {
  const QPointF at =
      aim_.side == AimSide::kNone ? *pixel_ : QPointF(aim_.pixel.x(), aim_.pixel.y());
  const QString text = tr("x %1  y %2  %3x")
                           .arg(at.x(), 0, 'f', 2)
                           .arg(at.y(), 0, 'f', 2)
                           .arg(magnification(), 0, 'g', 3);
  QFont fitting = font();
  while (QFontMetrics(fitting).horizontalAdvance(text) > width() - 8 &&
         QFontInfo(fitting).pixelSize() > kSmallestText)
    fitting.setPixelSize(QFontInfo(fitting).pixelSize() - 1);
  painter.setFont(fitting);
  paintLoupeFoot(painter, *this, text);
}

}  // namespace boresight::ui
