// SPDX-License-Identifier: Apache-2.0
#include "ui/scene/scene_input.h"

#include <cmath>

#include <QtWidgets>

#include "ui/views/view_transform.h"

namespace boresight::ui {
namespace {

constexpr double kZoomPerNotch = 1.2;
constexpr double kKeyTurn_px = 24.0;

}  // namespace

void SceneNavigation::setThroughCamera(bool through) {
  through_ = through;
  image_fitted_ = true;
}

void SceneNavigation::setStationAlone(bool alone, const SceneContent& content) {
  if (alone == station_alone_) return;
  station_alone_ = alone;
  if (framed_ && !content.empty()) frame(content);
}

void SceneNavigation::startOver(const SceneContent& content) {
  orbit_ = OrbitCamera();
  frame(content);
}

void SceneNavigation::reset(const SceneContent& content) {
  image_fitted_ = true;
  if (!through_) frame(content);
}

void SceneNavigation::frame(const SceneContent& content) {
  framed_ = true;
  BoundingBox all = content.bounds;
  for (const Frustum& frustum : content.frusta) {
    if (station_alone_) break;
    all.minimum_m = all.minimum_m.cwiseMin(frustum.apex_m);
    all.maximum_m = all.maximum_m.cwiseMax(frustum.apex_m);
  }
  orbit_.frame(all);
}

void SceneNavigation::fitImage(const SceneContent& content, const QSizeF& canvas) {
  if (!through_ || !image_fitted_ || content.empty()) return;
  const Camera& camera = content.one->source.camera;
  image_.fit(QSizeF(camera.width, camera.height), canvas);
}

void SceneNavigation::drag(const QPointF& moved, Qt::MouseButtons buttons,
                           Qt::KeyboardModifiers modifiers, double canvas_height) {
  framed_ = framed_ && through_;
  const bool pans = (buttons & Qt::MiddleButton) != 0 || modifiers.testFlag(Qt::ShiftModifier);
  if (through_) {
    turn(moved, canvas_height);
  } else if ((buttons & Qt::RightButton) != 0) {
    orbit_.dolly(std::pow(2.0, moved.y() / 100.0));
  } else if (pans) {
    orbit_.pan(moved, canvas_height);
  } else if ((buttons & Qt::LeftButton) != 0) {
    turn(moved, canvas_height);
  }
}

void SceneNavigation::turn(const QPointF& by, double canvas_height) {
  if (through_) {
    image_.pan(by);
    image_fitted_ = false;
  } else {
    framed_ = false;
    orbit_.orbit(by, canvas_height);
  }
}

void SceneNavigation::zoom(const QPointF& at, double notches) {
  if (through_) {
    image_.zoomAt(at, image_.scale() * std::pow(kZoomPerNotch, notches));
    image_fitted_ = false;
  } else {
    framed_ = false;
    orbit_.dolly(std::pow(kZoomPerNotch, -notches));
  }
}

Viewpoint SceneNavigation::viewpoint(const SceneContent& content, const Pose& through_pose,
                                     const QSizeF& canvas) const {
  if (!through_ || content.empty()) return orbit_.viewpoint(canvas);
  return ui::throughCamera(content.one->source.camera, through_pose, image_, canvas);
}

SceneInput::SceneInput(QWidget& canvas) : QObject(&canvas), canvas_(canvas) {
  canvas_.installEventFilter(this);
}

bool SceneInput::eventFilter(QObject* watched, QEvent* event) {
  switch (event->type()) {
    case QEvent::Resize:
      Q_EMIT resized();
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
    case QEvent::MouseButtonDblClick:
      Q_EMIT resetAsked();
      return true;
    case QEvent::Wheel: {
      const auto* wheel = static_cast<QWheelEvent*>(event);
      Q_EMIT zoomed(wheel->position(), wheel->angleDelta().y() / 120.0);
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

void SceneInput::press(const QMouseEvent& event) {
  canvas_.setFocus(Qt::MouseFocusReason);
  press_ = last_ = pointerPlace(event, canvas_);
  pressed_ = true;
  dragging_ = false;
}

void SceneInput::move(const QMouseEvent& event) {
  if (!pressed_ || event.buttons() == Qt::NoButton) return;
  const QPointF at = pointerPlace(event, canvas_);
  if (!dragging_ && (at - press_).manhattanLength() < QApplication::startDragDistance()) return;
  dragging_ = true;
  const QPointF moved = at - last_;
  last_ = at;
  Q_EMIT dragged(moved, event.buttons(), event.modifiers());
}

/// A double click's second release is no click.
void SceneInput::release(const QMouseEvent& event) {
  const bool click = pressed_ && !dragging_ && event.button() == Qt::LeftButton;
  pressed_ = dragging_ = false;
  if (click) Q_EMIT clicked(pointerPlace(event, canvas_), event.modifiers());
}

std::function<void()> SceneInput::actOf(const QKeyEvent& event) {
  if ((event.modifiers() & ~Qt::KeypadModifier) != 0) return nullptr;
  for (const StandardKey& standard : kStandardKeys)
    if (standard.key == event.key())
      return [this, view = standard.view] { Q_EMIT lookFromAsked(view); };
  const auto zoom = [this](double notches) {
    return [this, notches] {
      Q_EMIT zoomed({0.5 * canvas_.width(), 0.5 * canvas_.height()}, notches);
    };
  };
  const auto turn = [this](double right, double down) {
    return [this, by = kKeyTurn_px * QPointF(right, down)] { Q_EMIT turned(by); };
  };
  switch (event.key()) {
    case Qt::Key_Home:
      return [this] { Q_EMIT resetAsked(); };
    case Qt::Key_V:
      return [this] { Q_EMIT throughCameraToggled(); };
    case Qt::Key_Plus:
      return zoom(1.0);
    case Qt::Key_Minus:
      return zoom(-1.0);
    case Qt::Key_Left:
      return turn(-1.0, 0.0);
    case Qt::Key_Right:
      return turn(1.0, 0.0);
    case Qt::Key_Up:
      return turn(0.0, -1.0);
    case Qt::Key_Down:
      return turn(0.0, 1.0);
    default:
      return nullptr;
  }
}

}  // namespace boresight::ui
