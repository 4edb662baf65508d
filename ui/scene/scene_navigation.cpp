// SPDX-License-Identifier: Apache-2.0
#include "ui/scene/scene_navigation.h"

#include <cmath>
#include <utility>

#include <QtWidgets>

#include "ui/views/view_transform.h"

namespace boresight::ui {
namespace {

constexpr double kZoomPerNotch = 1.2;
constexpr double kKeyTurn_px = 24.0;
constexpr double kKeyRoll_rad = 0.2617993877991494;  ///< 15 deg
constexpr double kDragRoll_rad = 0.01;               ///< per pixel

}  // namespace

SceneNavigation::SceneNavigation(QWidget& canvas) : QObject(&canvas), canvas_(canvas) {
  canvas_.installEventFilter(this);
}

void SceneNavigation::setThroughCamera(bool through) {
  if (through == through_) return;
  through_ = through;
  image_fitted_ = true;
  Q_EMIT throughCameraChanged();
}

/// Another image of the same station leaves the view as it is.
void SceneNavigation::setContent(std::shared_ptr<const SceneContent> content) {
  const auto before = std::exchange(content_, std::move(content));
  if (content_->one == before->one) return;
  const bool same_station = !before->empty() && !content_->empty() &&
                            before->bounds.minimum_m == content_->bounds.minimum_m &&
                            before->bounds.maximum_m == content_->bounds.maximum_m;
  image_fitted_ = true;
  if (same_station) return;
  orbit_ = OrbitCamera();
  frame();
}

void SceneNavigation::setStationAlone(bool alone) {
  if (std::exchange(station_alone_, alone) == alone) return;
  if (framed_ && !content_->empty()) frame();
  Q_EMIT changed();
}

void SceneNavigation::reset() {
  image_fitted_ = true;
  if (!through_) frame();
  Q_EMIT changed();
}

void SceneNavigation::lookFrom(StandardView view) {
  setThroughCamera(false);
  orbit_.lookFrom(view);
  Q_EMIT changed();
}

void SceneNavigation::frame() {
  framed_ = true;
  BoundingBox all = content_->bounds;
  for (const Frustum& frustum : content_->frusta) {
    if (station_alone_) break;
    all.minimum_m = all.minimum_m.cwiseMin(frustum.apex_m);
    all.maximum_m = all.maximum_m.cwiseMax(frustum.apex_m);
  }
  orbit_.frame(all);
}

void SceneNavigation::fitImage() {
  if (!through_ || !image_fitted_ || content_->empty()) return;
  const Camera& camera = content_->one->source.camera;
  image_.fit(QSizeF(camera.width, camera.height), canvas_.size());
}

void SceneNavigation::drag(const QPointF& moved, const QMouseEvent& event) {
  framed_ = framed_ && through_;
  const bool pans =
      (event.buttons() & Qt::MiddleButton) != 0 || event.modifiers().testFlag(Qt::ShiftModifier);
  if (through_) {
    turn(moved);
  } else if (event.modifiers().testFlag(Qt::ControlModifier)) {
    roll(kDragRoll_rad * moved.x());
    return;
  } else if ((event.buttons() & Qt::RightButton) != 0) {
    orbit_.dolly(std::pow(2.0, moved.y() / 100.0));
  } else if (pans) {
    orbit_.pan(moved, canvas_.height());
  } else if ((event.buttons() & Qt::LeftButton) != 0) {
    turn(moved);
  }
  Q_EMIT changed();
}

/// As dragging with the left button does.
void SceneNavigation::turn(const QPointF& by) {
  if (through_) {
    image_.pan(by);
    image_fitted_ = false;
  } else {
    framed_ = false;
    orbit_.orbit(by, canvas_.height());
  }
}

void SceneNavigation::roll(double angle_rad) {
  if (through_) return;
  orbit_.roll(angle_rad);
  Q_EMIT changed();
}

void SceneNavigation::zoom(const QPointF& at, double notches) {
  if (through_) {
    image_.zoomAt(at, image_.scale() * std::pow(kZoomPerNotch, notches));
    image_fitted_ = false;
  } else {
    framed_ = false;
    orbit_.dolly(std::pow(kZoomPerNotch, -notches));
  }
  Q_EMIT changed();
}

Viewpoint SceneNavigation::viewpoint(const Pose& through_pose) const {
  if (!through_ || content_->empty()) return orbit_.viewpoint(canvas_.size());
  return ui::throughCamera(content_->one->source.camera, through_pose, image_, canvas_.size());
}

bool SceneNavigation::eventFilter(QObject* watched, QEvent* event) {
  switch (event->type()) {
    case QEvent::Resize:  // after the canvas itself has its new size
      QMetaObject::invokeMethod(this, &SceneNavigation::changed, Qt::QueuedConnection);
      return false;
    case QEvent::MouseButtonPress:
      press(*static_cast<QMouseEvent*>(event));
      return true;
    case QEvent::MouseMove:
      move(*static_cast<QMouseEvent*>(event));
      return true;
    case QEvent::MouseButtonRelease:
      release(*static_cast<QMouseEvent*>(event));
      return true;
    case QEvent::Leave:
      Q_EMIT left();
      return false;
    case QEvent::MouseButtonDblClick:
      reset();
      return true;
    case QEvent::Wheel: {
      const auto* wheel = static_cast<QWheelEvent*>(event);
      zoom(wheel->position(), wheel->angleDelta().y() / 120.0);
      return true;
    }
    case QEvent::ShortcutOverride:
      if (actOf(*static_cast<QKeyEvent*>(event))) event->accept();
      return false;
    case QEvent::KeyPress: {
      const auto act = actOf(*static_cast<QKeyEvent*>(event));
      if (act) act();
      return act != nullptr;
    }
    default:
      return QObject::eventFilter(watched, event);
  }
}

void SceneNavigation::press(const QMouseEvent& event) {
  canvas_.setFocus(Qt::MouseFocusReason);
  press_ = last_ = pointerPlace(event, canvas_);
  pressed_ = true;
  dragging_ = false;
}

void SceneNavigation::move(const QMouseEvent& event) {
  if (event.buttons() == Qt::NoButton) Q_EMIT hovered(pointerPlace(event, canvas_));
  if (!pressed_ || event.buttons() == Qt::NoButton) return;
  const QPointF at = pointerPlace(event, canvas_);
  if (!dragging_ && (at - press_).manhattanLength() < QApplication::startDragDistance()) return;
  dragging_ = true;
  drag(at - std::exchange(last_, at), event);
}

/// A double click's second release is no click.
void SceneNavigation::release(const QMouseEvent& event) {
  const bool click = pressed_ && !dragging_ && event.button() == Qt::LeftButton;
  pressed_ = dragging_ = false;
  if (click) Q_EMIT clicked(pointerPlace(event, canvas_), event.modifiers());
}

std::function<void()> SceneNavigation::actOf(const QKeyEvent& event) {
  if ((event.modifiers() & ~Qt::KeypadModifier) != 0) return nullptr;
  for (const StandardKey& standard : kStandardKeys)
    if (standard.key == event.key()) return [this, view = standard.view] { lookFrom(view); };
  const auto zoomed = [this](double notches) {
    return [this, notches] { zoom({0.5 * canvas_.width(), 0.5 * canvas_.height()}, notches); };
  };
  if (const QPointF arrow = arrowOf(event.key()); !arrow.isNull())
    return [this, arrow] {
      turn(kKeyTurn_px * arrow);
      Q_EMIT changed();
    };
  switch (event.key()) {
    case Qt::Key_Home:
      return [this] { reset(); };
    case Qt::Key_V:
      return [this] { setThroughCamera(!through_); };
    case Qt::Key_Plus:
      return zoomed(1.0);
    case Qt::Key_Minus:
      return zoomed(-1.0);
    case Qt::Key_Comma:
      return [this] { roll(-kKeyRoll_rad); };
    case Qt::Key_Period:
      return [this] { roll(kKeyRoll_rad); };
    default:
      return nullptr;
  }
}

}  // namespace boresight::ui
