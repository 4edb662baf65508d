// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <functional>

#include <QPointF>
#include <QSizeF>
#include <QWidget>

#include "ui/scene/scene_content.h"
#include "ui/scene/viewpoint.h"

class QKeyEvent;
class QMouseEvent;

namespace boresight::ui {

/// From where the scene is looked at, and what dragging, the wheel and keys do to that: around the
/// station, or through the case's camera, whose image then moves on the canvas.
class SceneNavigation {
 public:
  const OrbitCamera& orbit() const { return orbit_; }
  /// Where the image lies while looking through the camera.
  const ViewTransform& image() const { return image_; }
  bool throughCamera() const { return through_; }
  /// Shows the whole image at first.
  void setThroughCamera(bool through);

  /// What "the whole scene" is: the station alone, or with the cameras. A view that nobody has
  /// changed follows.
  void setStationAlone(bool alone, const SceneContent& content);
  /// Another station: the whole of it, from the side that is looked from at first.
  void startOver(const SceneContent& content);
  /// The whole scene again (through the camera: the whole image).
  void reset(const SceneContent& content);
  void lookFrom(StandardView view) { orbit_.lookFrom(view); }
  void showWholeImage() { image_fitted_ = true; }
  /// As long as nobody has moved the image, it fills the canvas whatever the canvas' size.
  void fitImage(const SceneContent& content, const QSizeF& canvas);

  void drag(const QPointF& moved, Qt::MouseButtons buttons, Qt::KeyboardModifiers modifiers,
            double canvas_height);
  /// As dragging with the left button does.
  void turn(const QPointF& by, double canvas_height);
  void zoom(const QPointF& at, double notches);

  /// `through_pose`: of the camera that is looked through.
  Viewpoint viewpoint(const SceneContent& content, const Pose& through_pose,
                      const QSizeF& canvas) const;

 private:
  void frame(const SceneContent& content);

  OrbitCamera orbit_;
  ViewTransform image_;
  bool image_fitted_ = true;  ///< follows the canvas' size
  bool through_ = false;
  bool station_alone_ = false;
  bool framed_ = true;  ///< nobody has turned or moved since the whole scene was shown
};

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

/// The mouse and the keys on the scene's canvas, as what they ask for. Places are in the canvas'
/// coordinates, its top-left corner (0, 0).
class SceneInput : public QObject {
  Q_OBJECT

 public:
  /// Belongs to the canvas.
  explicit SceneInput(QWidget& canvas);

 Q_SIGNALS:
  void resized();
  void clicked(const QPointF& at, Qt::KeyboardModifiers modifiers);
  void dragged(const QPointF& moved, Qt::MouseButtons buttons, Qt::KeyboardModifiers modifiers);
  void turned(const QPointF& by);
  void zoomed(const QPointF& at, double notches);
  void resetAsked();
  void lookFromAsked(StandardView view);
  void throughCameraToggled();

 protected:
  bool eventFilter(QObject* watched, QEvent* event) override;

 private:
  void press(const QMouseEvent& event);
  void move(const QMouseEvent& event);
  void release(const QMouseEvent& event);
  /// What a key does; nullptr: nothing.
  std::function<void()> actOf(const QKeyEvent& event);

  QWidget& canvas_;
  QPointF press_;
  QPointF last_;
  bool pressed_ = false;
  bool dragging_ = false;
};

}  // namespace boresight::ui
