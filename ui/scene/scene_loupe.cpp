// SPDX-License-Identifier: Apache-2.0
#include "ui/scene/scene_loupe.h"

#include <algorithm>
#include <cmath>
#include <utility>

#include <QPainter>

#include "ui/scene/scene_picture.h"
#include "ui/views/overlay_painters.h"

namespace boresight::ui {
namespace {

constexpr double kShare = 0.42;  ///< of the canvas' shorter side
constexpr int kLeastSide = 120;
constexpr int kMostSide = 280;
constexpr int kRaster = 4;  ///< whole screen pixels at ratios of quarters
constexpr int kMargin = 8;
constexpr int kShyness = 40;  ///< how near the pointer may come

int onRaster(double length) { return kRaster * static_cast<int>(std::floor(length / kRaster)); }

}  // namespace

Viewpoint magnifiedView(const Viewpoint& view, const QPointF& pixel, double magnification,
                        int side) {
  Viewpoint made = view;
  const double middle = 0.5 * (side - 1);
  made.camera.width = made.camera.height = side;
  made.camera.fx *= magnification;
  made.camera.fy *= magnification;
  made.camera.cx = (view.camera.cx - pixel.x()) * magnification + middle;
  made.camera.cy = (view.camera.cy - pixel.y()) * magnification + middle;
  if (prepareCamera(made.camera) != Status::kOk) made.camera.valid_radius = 0.0;
  return made;
}

std::optional<Backdrop> magnifiedBackdrop(const std::optional<Backdrop>& backdrop,
                                          const QPointF& pixel, double magnification, int side) {
  if (!backdrop) return std::nullopt;
  const double scale = magnification * backdrop->where.width() / backdrop->gray.width();
  const QPointF corner = magnification * (backdrop->where.topLeft() - pixel - QPointF(0.5, 0.5)) +
                         QPointF(0.5 * side, 0.5 * side);
  // Painters lose their way on pictures a million pixels wide.
  const QRectF shown(-corner / scale, QSizeF(side, side) / scale);
  const QRect cut = shown.toAlignedRect().intersected(backdrop->gray.rect());
  if (cut.isEmpty()) return std::nullopt;
  return Backdrop{backdrop->gray.copy(cut),
                  QRectF(corner + scale * QPointF(cut.topLeft()), scale * QSizeF(cut.size()))};
}

SceneLoupe::SceneLoupe(QWidget* canvas, Over over) : QWidget(canvas), over_(std::move(over)) {
  setObjectName(QStringLiteral("sceneLoupe"));
  setAttribute(Qt::WA_TransparentForMouseEvents);
  setFocusPolicy(Qt::NoFocus);
  hide();
}

void SceneLoupe::setMagnification(double magnification) {
  const double next = std::clamp(magnification, kLeastMagnification, kMostMagnification);
  if (next == magnification_) return;
  magnification_ = next;
  if (isVisible()) order();
  Q_EMIT changed();
}

void SceneLoupe::setSwitchedOn(bool on) {
  if (on == on_) return;
  on_ = on;
  if (shot_.content) lookAt(shot_, pixel_);
  Q_EMIT changed();
}

void SceneLoupe::lookAt(const SceneShot& shot, const std::optional<QPointF>& pixel) {
  shot_ = shot;
  pixel_ = pixel;
  const bool shown = on_ && pixel_ && shot_.content && !shot_.content->empty();
  if (shown) {
    putAside();
    order();
  }
  setVisible(shown);
}

/// Into the upper corner that the pointer is not in.
void SceneLoupe::putAside() {
  const QSize canvas = parentWidget()->size();
  const double shorter = std::min(canvas.width(), canvas.height());
  const int side = onRaster(std::clamp(kShare * shorter, double{kLeastSide}, double{kMostSide}));
  const QRect right(onRaster(canvas.width() - side - kMargin), kMargin, side, side);
  const QRect left(kMargin, kMargin, side, side);
  const QRect& now = left_ ? left : right;
  if (now.adjusted(-kShyness, -kShyness, kShyness, kShyness).contains(pixel_->toPoint()))
    left_ = !left_;
  setGeometry(left_ ? left : right);
}

void SceneLoupe::order() {
  const Viewpoint view = magnifiedView(shot_.view, *pixel_, magnification_, width());
  const auto backdrop = magnifiedBackdrop(shot_.backdrop, *pixel_, magnification_, width());
  runner_.start(
      QStringLiteral("loupe"),
      [content = shot_.content, look = shot_.look, view, backdrop,
       ratio = devicePixelRatioF()](const std::stop_token&) {
        return drawScenePicture(*content, look, view, backdrop, ratio);
      },
      [this, view](const QImage& picture) {
        picture_ = picture;
        picture_view_ = view;
        update();
      });
}

void SceneLoupe::paintEvent(QPaintEvent*) {
  QPainter painter(this);
  painter.fillRect(rect(), shot_.look.background);
  if (!picture_.isNull()) {
    painter.drawImage(0, 0, picture_);
    over_(painter, picture_view_);
  }
  painter.setRenderHint(QPainter::Antialiasing, true);
  paintLoupeCross(painter, size());
  painter.setRenderHint(QPainter::Antialiasing, false);
  paintText(painter);
  painter.setPen(QPen(palette().color(QPalette::Highlight), 2.0));
  painter.setBrush(Qt::NoBrush);
  painter.drawRect(rect().adjusted(1, 1, -1, -1));
}

void SceneLoupe::paintText(QPainter& painter) const {
  const int high = painter.fontMetrics().height() + 4;
  const QRect line(0, height() - high, width(), high);
  painter.fillRect(line, QColor(0, 0, 0, 170));
  painter.setPen(QColor(255, 255, 255));
  painter.drawText(line, Qt::AlignCenter, tr("%1x").arg(magnification_, 0, 'g', 3));
}

}  // namespace boresight::ui
