// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <functional>
#include <memory>

#include <QPointF>
#include <QWidget>

#include "ui/scene/scene_content.h"
#include "ui/scene/viewpoint.h"

class QKeyEvent;
class QMouseEvent;

namespace boresight::ui {

/// A fixed direction with its key and its name, to be translated in the context "SceneView".
struct StandardKey {
  int key;
  StandardView view;
  const char* name;
};

inline constexpr std::array<StandardKey, 7> kStandardKeys = {{
    {Qt::Key_1, StandardView::kTop, QT_TRANSLATE_NOOP("SceneView", "Top (along -z)")},
    {Qt::Key_2, StandardView::kFront, QT_TRANSLATE_NOOP("SceneView", "Front (along +y)")},
    {Qt::Key_3, StandardView::kRight, QT_TRANSLATE_NOOP("SceneView", "Right (along -x)")},
    {Qt::Key_4, StandardView::kBack, QT_TRANSLATE_NOOP("SceneView", "Back (along -y)")},
    {Qt::Key_5, StandardView::kLeft, QT_TRANSLATE_NOOP("SceneView", "Left (along +x)")},
    {Qt::Key_6, StandardView::kBottom, QT_TRANSLATE_NOOP("SceneView", "Bottom (along +z)")},
    {Qt::Key_7, StandardView::kOblique, QT_TRANSLATE_NOOP("SceneView", "Oblique")},
}};

/// The viewpoint of the scene, moved by mouse, wheel and keys on the canvas: around the station, or
/// through the case's camera, whose image then moves on the canvas. Positions are in the canvas'
/// coordinates, its top-left corner (0, 0).
class SceneNavigation : public QObject {
  Q_OBJECT

 public:
  /// The canvas owns it.
  explicit SceneNavigation(QWidget& canvas);

  const OrbitCamera& orbit() const { return orbit_; }
  /// Where the image lies while looking through the camera.
  const ViewTransform& image() const { return image_; }
  bool throughCamera() const { return through_; }
  /// Shows the whole image at first.
  void setThroughCamera(bool through);
  /// Sets the content; another station is shown whole, from the default direction.
  void setContent(std::shared_ptr<const SceneContent> content);
  /// Whether "the whole scene" is the station alone, or includes the cameras. A view that is not
  /// yet moved follows.
  void setStationAlone(bool alone);
  /// Shows the whole scene again (through the camera: the whole image).
  void reset();
  void lookFrom(StandardView view);
  /// Fits the image to the canvas until the operator moves it.
  void fitImage();
  /// `through_pose`: pose of the camera for views through it.
  Viewpoint viewpoint(const Pose& through_pose) const;

 Q_SIGNALS:
  /// The viewpoint or the size of the canvas has changed.
  void changed();
  void throughCameraChanged();
  void clicked(const QPointF& at, Qt::KeyboardModifiers modifiers);
  /// The pointer moves without a button.
  void hovered(const QPointF& at);
  void left();

 protected:
  bool eventFilter(QObject* watched, QEvent* event) override;

 private:
  void press(const QMouseEvent& event);
  void move(const QMouseEvent& event);
  void release(const QMouseEvent& event);
  /// Action of a key; nullptr: none.
  std::function<void()> actOf(const QKeyEvent& event);
  void drag(const QPointF& moved, const QMouseEvent& event);
  void turn(const QPointF& by);
  void roll(double angle_rad);
  void zoom(const QPointF& at, double notches);
  void frame();

  QWidget& canvas_;
  std::shared_ptr<const SceneContent> content_ = std::make_shared<const SceneContent>();
  OrbitCamera orbit_;
  ViewTransform image_;
  bool image_fitted_ = true;  ///< follows the canvas' size
  bool through_ = false;
  bool station_alone_ = false;
  bool framed_ = true;  ///< not turned or moved since the whole scene was shown
  QPointF press_;
  QPointF last_;
  bool pressed_ = false;
  bool dragging_ = false;
};

}  // namespace boresight::ui
