// SPDX-License-Identifier: Apache-2.0
#include "ui/scene/scene_navigation.h"

#include <cmath>

namespace boresight::ui {
namespace {

constexpr double kZoomPerNotch = 1.2;

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

}  // namespace boresight::ui
