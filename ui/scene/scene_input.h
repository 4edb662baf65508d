// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <functional>
#include <vector>

#include <QPointF>
#include <QSizeF>
#include <QWidget>

#include "ui/scene/scene_content.h"
#include "ui/scene/viewpoint.h"

class QAction;
class QBoxLayout;
class QComboBox;
class QKeyEvent;
class QMenu;
class QMouseEvent;
class QSlider;

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

/// The scene's buttons: what is shown, from where, and how opaque the mesh is. It only tells what
/// was asked for.
class SceneBar : public QWidget {
  Q_OBJECT

 public:
  explicit SceneBar(const SceneShown& shown, QWidget* parent = nullptr);

  /// What they show, without telling anybody.
  void setShown(const SceneShown& shown);
  void setThroughCamera(bool through);
  void setThroughRole(PoseRole role);
  void setMeshOpacity(double opacity);

 Q_SIGNALS:
  void resetAsked();
  void lookFromAsked(StandardView view);
  void throughCameraAsked(bool through);
  void throughRoleAsked(PoseRole role);
  void shownAsked(const SceneShown& shown);
  void meshOpacityAsked(double opacity);

 private:
  QMenu& addMenu(const QString& text, const QString& tip);
  void addReset();
  void addViews();
  void addShow();
  void addOpacity(QMenu& menu);
  void addThroughCamera();

  SceneShown shown_;
  QBoxLayout* row_;
  std::vector<QAction*> show_;
  QAction* through_ = nullptr;
  QComboBox* through_role_ = nullptr;
  QSlider* opacity_ = nullptr;
};

}  // namespace boresight::ui
