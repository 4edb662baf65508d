// SPDX-License-Identifier: Apache-2.0
#include "ui/views/image_view.h"

#include <algorithm>
#include <cmath>
#include <utility>

#include <QtWidgets>

#include "ui/style/tokens.h"
#include "ui/views/line_painter.h"
#include "ui/views/overlay_painters.h"
#include "ui/views/view_transform.h"

namespace boresight::ui {
namespace {

constexpr double kZoomStep = 1.25;
constexpr double kPickRadius = 8.0;
constexpr double kClickSlack = 3.0;
constexpr double kSwipeReach = 6.0;
constexpr double kFaded = 0.25;
constexpr double kCursorSize = 12.0;
constexpr int kToolMargin = 56;  ///< of texts next to the tool strip
constexpr int kMostBands = 16;
constexpr double kWorkAtOnce = 40e3;    ///< length of lines on the screen, about 1.5 us a pixel
constexpr double kWorkOfABit = 2e-3;    ///< making its picture, in the same unit
constexpr double kWorkOfAPixel = 5e-3;  ///< of a picture on the screen
constexpr double kWorkOfAMark = 30.0;

}  // namespace

ImageView::ImageView(QWidget* parent)
    : QWidget(parent), layers_(kLayerCount), pixmaps_(kLayerCount) {
  for (int i = 0; i < kLayerCount; ++i) {
    Layer& layer = layers_[static_cast<std::size_t>(i)];
    layer.id = static_cast<LayerId>(i);
    layer.style = layerInfo(layer.id).style;
  }
  setMouseTracking(true);
  setFocusPolicy(Qt::StrongFocus);
  setAutoFillBackground(false);
  setAttribute(Qt::WA_OpaquePaintEvent);
  setMinimumSize(160, 120);
}

void ImageView::setImage(const QImage& gray) {
  const QSize before = image_.size();
  image_ = GrayPyramid(gray.isNull() ? QImage() : gray.convertToFormat(QImage::Format_Grayscale8));
  values_ = image_.isNull() ? QImage() : image_.full();
  if (image_.size() != before) fit();
  redraw();
}

void ImageView::setLayer(Layer layer) {
  const LayerId id = layer.id;
  layers_[static_cast<std::size_t>(id)] = std::move(layer);
  layerChanged(id);
}

void ImageView::layerChanged(LayerId id) {
  pixmaps_[static_cast<std::size_t>(id)].clear();
  redraw();
  Q_EMIT layersChanged();
}

void ImageView::setStyle(LayerId id, const LayerStyle& style) {
  const auto index = static_cast<std::size_t>(id);
  if (layers_[index].style.color != style.color) pixmaps_[index].clear();
  layers_[index].style = style;
  redraw();
  Q_EMIT layersChanged();
}

void ImageView::setTransform(const ViewTransform& transform) {
  if (transform == transform_) return;
  transform_ = transform;
  fitted_ = false;
  changed();
}

void ImageView::fit() {
  fitted_ = true;
  transform_.fit(image_.size(), size());
  changed();
}

void ImageView::showOneToOne() { zoomTo(middle(), 1.0 / devicePixelRatioF()); }

void ImageView::centreOn(const QPointF& pixel, double least_scale) {
  fitted_ = false;
  if (transform_.scale() < least_scale) transform_.zoomAt(middle(), least_scale);
  transform_.centreOn(pixel, size());
  changed();
}

void ImageView::setSwipe(std::optional<double> share) {
  swipe_ = share;
  redraw();
}

void ImageView::setLayersHidden(bool hidden) {
  layers_hidden_ = hidden;
  redraw();
}

void ImageView::setHint(const QString& hint) {
  hint_ = hint;
  redraw();
}

void ImageView::setToolActive(bool active, double radius_px) {
  tool_active_ = active;
  tool_radius_px_ = radius_px;
  setCursor(active ? Qt::CrossCursor : Qt::ArrowCursor);
  update();
}

void ImageView::setTool(CanvasTool* tool) {
  const QPointer<CanvasTool> before = std::exchange(tool_, tool);
  if (before && tool && before != tool) before->leave();
  if (tool) setFocus();
}

void ImageView::cancelGesture() {
  tool_pressed_ = dragging_ = swiping_ = false;
  if (tool_) tool_->cancelGesture();
}

void ImageView::setToolPreviews(std::vector<ToolPreview> previews) {
  tool_previews_ = std::move(previews);
  update();
}

void ImageView::setLinkedCursor(const std::optional<QPointF>& pixel) {
  if (pixel == linked_cursor_) return;
  linked_cursor_ = pixel;
  update();
}

void ImageView::changed() {
  redraw();
  Q_EMIT transformChanged();
}

std::optional<ImageView::Pick> ImageView::pickAt(const QPointF& widget) const {
  std::optional<Pick> found;
  double nearest = kPickRadius;
  if (layers_hidden_) return found;
  for (const Layer& layer : layers_) {
    if (!layer.style.visible) continue;
    for (const Mark& mark : layer.marks) {
      if (mark.item < 0) continue;
      const double distance = distanceTo(transform_, mark, widget);
      if (distance > nearest || (found && distance == nearest)) continue;
      nearest = distance;
      found = Pick{layer.id, mark.item};
    }
  }
  return found;
}

/// Of the image, within a part of the widget.
QRect ImageView::visiblePixels(const QRectF& area) const {
  const QPointF first = drawn().toPixel(area.topLeft());
  const QPointF last = drawn().toPixel(area.bottomRight());
  const QRect seen(
      QPoint(static_cast<int>(std::floor(first.x())), static_cast<int>(std::floor(first.y()))),
      QPoint(static_cast<int>(std::ceil(last.x())), static_cast<int>(std::ceil(last.y()))));
  return seen.intersected(QRect(QPoint(0, 0), image_.size()));
}

/// Image and layers are kept as drawn: what follows the pointer lies above them and moves often.
void ImageView::paintEvent(QPaintEvent*) {
  updateGround();
  QPainter painter(this);
  paintGround(painter);
  if (image_.isNull()) return;
  painter.setRenderHint(QPainter::Antialiasing, true);
  if (swipe_) paintSwipe(painter);
  paintTool(painter);
  if (linked_cursor_) paintLinkedCursor(painter);
  painter.setRenderHint(QPainter::Antialiasing, false);
  for (const auto& [owner, overlay] : overlays_)
    if (owner) overlay(painter);
}

QRgb ImageView::canvasColor() const {
  const bool dark = palette().color(QPalette::Window).lightnessF() < 0.5;
  return (dark ? kDarkTheme : kLightTheme).canvas;
}

QSize ImageView::deviceSize() const { return (QSizeF(size()) * devicePixelRatioF()).toSize(); }

/// Little work is done at once; of much work one step, as an event of its own does the next.
void ImageView::updateGround() {
  const Ground& newest = drawing_ ? drawing_->ground : ground_;
  if (newest.picture.size() != deviceSize() || newest.canvas != canvasColor()) {
    drawing_.reset();
    outdated_ = true;
  }
  if (!outdated_) return;
  if (!drawing_) beginDrawing();
  const bool nothing_to_show = ground_.picture.isNull();
  do {
    draw();
  } while (drawing_ && (nothing_to_show || drawing_->bands == 1));
  // Asked for while painting, it would be painted in the same event.
  if (outdated_) QTimer::singleShot(0, this, QOverload<>::of(&QWidget::update));
}

void ImageView::beginDrawing() {
  drawing_ = Drawing();
  Ground& ground = drawing_->ground;
  ground.transform = transform_;
  ground.canvas = canvasColor();
  ground.picture = QPixmap(deviceSize());
  ground.picture.setDevicePixelRatio(devicePixelRatioF());
  ground.picture.fill(QColor(ground.canvas));
  drawing_->bands = std::min(kMostBands, 1 + static_cast<int>(workToDraw() / kWorkAtOnce));
}

/// One step.
void ImageView::draw() {
  if (prepareBits()) return;
  const double band_height =
      std::ceil(deviceSize().height() / static_cast<double>(drawing_->bands)) / devicePixelRatioF();
  drawBand(QRectF(0.0, drawing_->next * band_height, width(), band_height));
  if (++drawing_->next < drawing_->bands) return;
  ground_ = std::move(drawing_->ground);
  outdated_ = drawing_->superseded;
  drawing_.reset();
}

/// Makes the picture of one bit image that has none at this scale; false when all have theirs.
bool ImageView::prepareBits() {
  if (layers_hidden_) return false;
  for (std::size_t i = 0; i < layers_.size(); ++i) {
    const Layer& layer = layers_[i];
    std::vector<BitPixmaps>& pixmaps = pixmaps_[i];
    if (!layer.isShown()) continue;
    for (std::size_t j = 0; j < layer.bits.size(); ++j) {
      const LayerBits& bits = layer.bits[j];
      const bool made = j < pixmaps.size();
      if (made && pixmaps[j].has(bitsPerPixel(bits.level))) continue;
      if (!made)
        pixmaps.emplace_back(bits.bits, bits.color.isValid() ? bits.color : layer.style.color);
      int step = 0;
      (void)pixmaps[j].at(bitsPerPixel(bits.level), step);
      return true;
    }
  }
  return false;
}

/// Bits of this level that a pixel of the screen covers along an axis.
double ImageView::bitsPerPixel(int level) const {
  return 1.0 / (drawn().scale() * devicePixelRatioF() * (1 << level));
}

/// As a length of lines on the screen.
double ImageView::workToDraw() const {
  if (layers_hidden_ || image_.isNull()) return 0.0;
  const QRectF seen = QRectF(visiblePixels(rect()));
  const double pixels =
      std::pow(drawn().scale() * devicePixelRatioF(), 2.0) * seen.width() * seen.height();
  const Eigen::AlignedBox2d box(Eigen::Vector2d(seen.left(), seen.top()),
                                Eigen::Vector2d(seen.right(), seen.bottom()));
  double work = kWorkOfAPixel * pixels;  // of the image itself
  for (std::size_t i = 0; i < layers_.size(); ++i) {
    const Layer& layer = layers_[i];
    if (!layer.isShown()) continue;
    for (std::size_t j = 0; j < layer.bits.size(); ++j) {
      const LayerBits& bits = layer.bits[j];
      const std::vector<BitPixmaps>& made = pixmaps_[i];
      if (j >= made.size() || !made[j].has(bitsPerPixel(bits.level)))
        work += kWorkOfABit * bits.bits.width * bits.bits.height;
    }
    work += kWorkOfAPixel * pixels * static_cast<double>(layer.bits.size()) +
            kWorkOfAMark * static_cast<double>(layer.marks.size());
    if (layer.lines) work += drawn().scale() * sessions::lengthWithin(*layer.lines, box);
  }
  return work;
}

void ImageView::drawBand(const QRectF& band) {
  QPainter painter(&drawing_->ground.picture);
  painter.setFont(font());
  if (image_.isNull()) {
    painter.setPen(QColor(kOverlayText));
    painter.drawText(rect().adjusted(kToolMargin, 0, -kToolMargin, 0),
                     Qt::AlignCenter | Qt::TextWordWrap, hint_);
    return;
  }
  painter.setClipRect(band);
  paintImage(painter);
  if (!layers_hidden_) {
    painter.save();
    if (swipe_)
      painter.setClipRect(QRectF(0.0, 0.0, *swipe_ * width(), height()), Qt::IntersectClip);
    for (std::size_t i = 0; i < layers_.size(); ++i) paintLayer(painter, i);
    painter.restore();
  }
  if (drawn().scale() >= kGridScale) paintGrid(painter, band);
  if (drawn().scale() >= kValueScale) paintValues(painter, band);
}

/// While another ground is drawn, the former one lies where its pixels are now.
void ImageView::paintGround(QPainter& painter) const {
  if (!outdated_) return painter.drawPixmap(0, 0, ground_.picture);
  painter.fillRect(rect(), QColor(canvasColor()));
  const double scale = transform_.scale() / ground_.transform.scale();
  const QPointF place = transform_.toWidget(ground_.transform.toPixel(QPointF(0.0, 0.0)));
  const QSizeF size = QSizeF(ground_.picture.size()) / ground_.picture.devicePixelRatio();
  painter.drawPixmap(QRectF(place, scale * size), ground_.picture, QRectF(ground_.picture.rect()));
}

/// Image or layers are no longer as drawn. A ground that is being drawn is finished: dragging does
/// not put it off again and again.
void ImageView::redraw() {
  if (drawing_) drawing_->superseded = true;
  outdated_ = true;
  update();
}

void ImageView::paintSwipe(QPainter& painter) const {
  const double x = *swipe_ * width();
  const QPointF handle(x, 0.5 * height());
  for (const QPen& pen : {QPen(QColor(0, 0, 0, 160), 4.0), QPen(Qt::white, 2.0)}) {
    painter.setPen(pen);
    painter.drawLine(QPointF(x, 0.0), QPointF(x, height()));
    painter.setBrush(QColor(kDarkTheme.overlay));
    painter.drawRoundedRect(QRectF(handle - QPointF(6.0, 16.0), handle + QPointF(6.0, 16.0)),
                            kRadius, kRadius);
  }
  painter.setBrush(Qt::NoBrush);
}

void ImageView::paintLinkedCursor(QPainter& painter) const {
  const QPointF at = transform_.toWidget(*linked_cursor_);
  for (const QPen& pen : {QPen(QColor(0, 0, 0, 160), 3.5), QPen(QColor(255, 255, 255), 1.5)}) {
    painter.setPen(pen);
    paintTicks(painter, at, 0.3 * kCursorSize, kCursorSize);
  }
}

/// Truth would hide a pose that coincides with it.
LineToken ImageView::lineOf(const Layer& layer) const {
  LineToken line = layer.shownLine();
  const Layer& truth = this->layer(LayerId::kTruthEdges);
  if (layer.id == LayerId::kIterationEdges && truth.style.visible && !truth.empty())
    line.width_px *= kPoseUnderTruthFactor;
  return line;
}

void ImageView::paintTool(QPainter& painter) const {
  for (const ToolPreview& preview : tool_previews_) paintPreview(painter, transform_, preview);
  if (!tool_active_ || tool_radius_px_ <= 0.0 || !underMouse()) return;
  const double radius = tool_radius_px_ * transform_.scale();
  for (const QPen& pen : {QPen(QColor(0, 0, 0, 160), 3.0), QPen(QColor(255, 255, 255), 1.2)}) {
    painter.setPen(pen);
    painter.drawEllipse(last_, radius, radius);
  }
}

void ImageView::paintImage(QPainter& painter) const {
  int step = 0;
  const double device_scale = drawn().scale() * devicePixelRatioF();
  const QImage& picture = image_.at(1.0 / device_scale, step);
  const double factor = static_cast<double>(1 << step);
  painter.setRenderHint(QPainter::SmoothPixmapTransform, device_scale < 1.0);
  // A pixel of the picture covers `factor` pixels of the image, the last one perhaps fewer.
  const QRectF covered(-0.5, -0.5, picture.width() * factor, picture.height() * factor);
  painter.drawImage(drawn().toWidget(covered), picture);
}

void ImageView::paintLayer(QPainter& painter, std::size_t index) {
  const Layer& layer = layers_[index];
  if (!layer.isShown()) return;
  painter.setOpacity(layer.faded ? kFaded * layer.style.opacity : layer.style.opacity);
  paintBits(painter, index);
  painter.setRenderHint(QPainter::Antialiasing, true);
  if (layer.lines)
    paintLines(painter, drawn(), *layer.lines, lineOf(layer), painter.clipBoundingRect());
  for (const Mark& mark : layer.marks)
    if (reaches(drawn(), mark, painter.clipBoundingRect()))
      paintMark(painter, drawn(), mark, layer.style.color);
  painter.setRenderHint(QPainter::Antialiasing, false);
  painter.setOpacity(1.0);
}

void ImageView::paintBits(QPainter& painter, std::size_t index) {
  const Layer& layer = layers_[index];
  painter.setRenderHint(QPainter::SmoothPixmapTransform, false);
  for (std::size_t i = 0; i < layer.bits.size(); ++i) {
    const int level = layer.bits[i].level;
    int step = 0;
    const QImage& picture = pixmaps_[index][i].at(bitsPerPixel(level), step);
    const double factor = static_cast<double>(1 << level) * static_cast<double>(1 << step);
    const QRectF covered(-0.5, -0.5, picture.width() * factor, picture.height() * factor);
    painter.drawImage(drawn().toWidget(covered), picture);
  }
}

void ImageView::paintGrid(QPainter& painter, const QRectF& band) const {
  const QRect seen = visiblePixels(band);
  painter.setPen(QColor(128, 128, 128, 70));
  for (int x = seen.left(); x <= seen.right() + 1; ++x) {
    const double at = drawn().toWidget(QPointF(x - 0.5, 0.0)).x();
    painter.drawLine(QPointF(at, 0.0), QPointF(at, height()));
  }
  for (int y = seen.top(); y <= seen.bottom() + 1; ++y) {
    const double at = drawn().toWidget(QPointF(0.0, y - 0.5)).y();
    painter.drawLine(QPointF(0.0, at), QPointF(width(), at));
  }
}

void ImageView::paintValues(QPainter& painter, const QRectF& band) const {
  if (values_.isNull()) return;
  const QRect seen = visiblePixels(band);
  QFont small = font();
  small.setPixelSize(static_cast<int>(std::clamp(0.36 * drawn().scale(), 9.0, 22.0)));
  painter.setFont(small);
  for (int y = seen.top(); y <= seen.bottom(); ++y) {
    for (int x = seen.left(); x <= seen.right(); ++x) {
      const int gray = values_.constScanLine(y)[x];
      const int shown = image_.full().constScanLine(y)[x];  // perhaps stretched
      painter.setPen(shown < 128 ? QColor(255, 255, 255, 190) : QColor(0, 0, 0, 190));
      painter.drawText(drawn().toWidget(QRectF(x - 0.5, y - 0.5, 1.0, 1.0)), Qt::AlignCenter,
                       QString::number(gray));
    }
  }
}

void ImageView::resizeEvent(QResizeEvent*) {
  if (fitted_) fit();
}

void ImageView::zoomTo(const QPointF& widget, double scale) {
  fitted_ = false;
  transform_.zoomAt(widget, scale);
  changed();
}

void ImageView::panBy(const QPointF& delta) {
  fitted_ = false;
  transform_.pan(delta);
  changed();
}

void ImageView::wheelEvent(QWheelEvent* event) {
  const double notches = event->angleDelta().y() / 120.0;
  if (notches == 0.0 || image_.isNull()) return;
  zoomTo(event->position(), transform_.scale() * std::pow(kZoomStep, notches));
  event->accept();
}

void ImageView::mousePressEvent(QMouseEvent* event) {
  press_ = last_ = pointerPlace(*event, *this);
  dragging_ = false;
  swiping_ = event->button() == Qt::LeftButton && isOnSwipe(press_);
  if (swiping_) return;
  if (tool_active_ && event->button() == Qt::LeftButton && !image_.isNull()) {
    tool_pressed_ = true;
    Q_EMIT toolPressed(transform_.toPixel(last_));
  }
}

void ImageView::mouseMoveEvent(QMouseEvent* event) {
  const QPointF place = pointerPlace(*event, *this);
  const QPointF delta = place - last_;
  last_ = place;
  if ((event->buttons() & Qt::LeftButton) == 0) {  // the release went elsewhere
    swiping_ = false;
    if (std::exchange(tool_pressed_, false) && tool_) tool_->loseButton();
  }
  if (swiping_) {
    setSwipe(std::clamp(place.x() / width(), 0.0, 1.0));
    return;
  }
  if (tool_pressed_) {
    Q_EMIT toolMoved(transform_.toPixel(place));
  } else if ((event->buttons() & (Qt::LeftButton | Qt::MiddleButton)) != 0) {
    if ((place - press_).manhattanLength() > kClickSlack) dragging_ = true;
    if (dragging_) panBy(delta);
  }
  if (tool_active_) update();
  if (!image_.isNull()) Q_EMIT cursorMoved(transform_.toPixel(place));
}

void ImageView::mouseReleaseEvent(QMouseEvent* event) {
  const QPointF place = pointerPlace(*event, *this);
  if (std::exchange(swiping_, false)) return;
  if (std::exchange(tool_pressed_, false)) {
    Q_EMIT toolReleased(transform_.toPixel(place));
    return;
  }
  if (std::exchange(dragging_, false) || image_.isNull()) return;
  if (const auto pick = event->button() == Qt::LeftButton ? pickAt(place) : std::nullopt)
    Q_EMIT itemClicked(pick->layer, pick->item);
  Q_EMIT clicked(transform_.toPixel(place), event->button(), event->modifiers());
}

bool ImageView::isOnSwipe(const QPointF& place) const {
  return swipe_ && !image_.isNull() && std::abs(place.x() - *swipe_ * width()) <= kSwipeReach;
}

void ImageView::mouseDoubleClickEvent(QMouseEvent* event) {
  if (tool_active_ || isOnSwipe(pointerPlace(*event, *this))) {
    mousePressEvent(event);
  } else if (event->button() == Qt::LeftButton) {
    fit();
  }
}

void ImageView::keyPressEvent(QKeyEvent* event) {
  const double step = 0.1 * std::min(width(), height());
  switch (event->key()) {
    case Qt::Key_H:
      return setLayersHidden(true);
    case Qt::Key_1:
      return showOneToOne();
    case Qt::Key_0:
      return fit();
    case Qt::Key_Plus:
    case Qt::Key_Equal:
      return zoomTo(middle(), transform_.scale() * kZoomStep);
    case Qt::Key_Minus:
      return zoomTo(middle(), transform_.scale() * (1.0 / kZoomStep));
    default:
      if (const QPointF arrow = arrowOf(event->key()); !arrow.isNull()) return panBy(-step * arrow);
      QWidget::keyPressEvent(event);
  }
}

void ImageView::keyReleaseEvent(QKeyEvent* event) {
  if (event->key() == Qt::Key_H && !event->isAutoRepeat()) return setLayersHidden(false);
  QWidget::keyReleaseEvent(event);
}

void ImageView::focusOutEvent(QFocusEvent* event) {
  setLayersHidden(false);  // the release of a held key goes elsewhere
  QWidget::focusOutEvent(event);
}

void ImageView::contextMenuEvent(QContextMenuEvent* event) {
  if (image_.isNull()) return event->ignore();
  // The event has whole coordinates; the press before it was at the pointer's tip.
  const bool pressed = event->reason() == QContextMenuEvent::Mouse &&
                       (press_ - event->pos()).manhattanLength() < 2.0;
  Q_EMIT contextMenuRequested(transform_.toPixel(pressed ? press_ : event->pos()),
                              event->globalPos());
}

void ImageView::leaveEvent(QEvent*) {
  Q_EMIT cursorLeft();
  if (tool_active_) update();
}

}  // namespace boresight::ui
