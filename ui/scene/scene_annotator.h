// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <functional>
#include <memory>
#include <optional>
#include <vector>

#include <QImage>
#include <QPointF>
#include <QWidget>

#include "ui/run/task_runner.h"
#include "ui/scene/scene_overlay.h"

class QKeyEvent;
class QMouseEvent;
class QPainter;

namespace boresight::ui {

class StationSnapper;

/// The view of a square of `side` canvas pixels that shows the surroundings of a pixel magnified,
/// with the pixel's centre in its middle.
Viewpoint magnifiedView(const Viewpoint& view, const QPointF& pixel, double magnification,
                        int side);

/// All data that the scene draws, in one value.
struct SceneShot {
  std::shared_ptr<const SceneContent> content;
  SceneLook look;
  Viewpoint view;
  std::optional<Backdrop> backdrop;
};

/// The scene around the pointer, rendered at the loupe's resolution, under a cross, in a corner
/// away from the pointer. The core draws it on a worker thread: exact, and the same with and
/// without OpenGL.
class SceneLoupe : public QWidget {
  Q_OBJECT

 public:
  static constexpr double kLeastMagnification = 4.0;
  static constexpr double kMostMagnification = 16.0;
  static constexpr double kStep = 1.4142135623730951;  ///< of magnifications

  /// Draws over the picture, with the loupe's view.
  using Over = std::function<void(QPainter&, const Viewpoint&)>;

  SceneLoupe(QWidget* canvas, Over over);

  double magnification() const { return magnification_; }
  void setMagnification(double magnification);

  /// Shows a pixel of the canvas under the cross; empty: the loupe hides.
  void lookAt(const SceneShot& shot, const std::optional<QPointF>& pixel);
  /// Whether the newest position is drawn.
  bool ready() const { return !runner_.isBusy(); }

 protected:
  void paintEvent(QPaintEvent* event) override;

 private:
  void order();

  Over over_;
  SceneShot shot_;
  double magnification_ = 8.0;
  bool left_ = false;  ///< in the left corner
  std::optional<QPointF> pixel_;
  QImage picture_;
  Viewpoint picture_view_;
  QString problem_;  ///< why there is no picture
  TaskRunner runner_;
  TaskKind drawing_;
};

/// Annotating in the scene. While the operator places annotations, a click sets the station side:
/// the corner, edge, circle centre or named point shown next to the pointer. With Alt held it sets
/// a point of the surface; Tab changes to another snap candidate. In line mode it is the
/// highlighted edge. Otherwise a click on an annotation selects it.
class SceneAnnotator : public QObject {
  Q_OBJECT

 public:
  /// The canvas owns it.
  SceneAnnotator(QWidget& canvas, AnnotationController& annotation, StationSnapper& snapper);

  bool places() const;
  /// Sets the data that the scene shows.
  void setShot(const SceneShot& shot);
  /// Returns whether the click was used for an annotation. `at`: the canvas' coordinates.
  bool click(const QPointF& at, Qt::KeyboardModifiers modifiers);
  /// Target of a click at a pixel of the canvas; empty off the station and until its corners and
  /// edges are found.
  std::optional<SceneAim> aimAt(const QPointF& pixel) const;
  /// Target of a click now; empty when a click has no effect.
  const std::optional<SceneAim>& aim() const { return aim_; }
  SceneLoupe& loupe() const { return *loupe_; }
  /// Cameras of the rig that are solved with this one, at their solved poses.
  std::vector<Frustum> rigFrusta(const Eigen::Vector3d& centre_m) const;
  /// The target of a click, in words and figures.
  QString place() const;
  /// The next step for the operator, or empty.
  QString nextStep() const;
  void paint(QPainter& painter, const QRectF& area) const;

 Q_SIGNALS:
  void changed();  ///< the painted content

 protected:
  bool eventFilter(QObject* watched, QEvent* event) override;

 private:
  void showMode();
  void takeFocus();
  void showAnnotations();
  void hover(const QMouseEvent& event);
  void leave();
  bool takesKey(const QKeyEvent& event) const;
  bool pressKey(const QKeyEvent& event);
  void updateAim();
  bool completesPoint() const;
  void placeAim();
  const sessions::MeshSnapper* mesh() const;

  QWidget& canvas_;
  AnnotationController& annotation_;
  StationSnapper& snapper_;
  SceneLoupe* loupe_;
  SceneShot shot_;
  std::vector<SceneAnnotation> annotations_;
  std::optional<QPointF> pointer_;  ///< pixel of the canvas
  Qt::KeyboardModifiers modifiers_;
  int turn_ = 0;
  QPointF turned_at_;  ///< pixel
  std::optional<SceneAim> aim_;
};

}  // namespace boresight::ui
