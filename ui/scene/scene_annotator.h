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

/// The view of a square of `side` canvas pixels in which the surroundings of a pixel appear
/// magnified: the pixel's centre comes to lie in the square's middle.
Viewpoint magnifiedView(const Viewpoint& view, const QPointF& pixel, double magnification,
                        int side);
/// The same for the camera's image behind the scene, cut to what the square shows of it.
std::optional<Backdrop> magnifiedBackdrop(const std::optional<Backdrop>& backdrop,
                                          const QPointF& pixel, double magnification, int side);

/// What the scene draws, in one value.
struct SceneShot {
  std::shared_ptr<const SceneContent> content;
  SceneLook look;
  Viewpoint view;
  std::optional<Backdrop> backdrop;
};

/// The scene around the pointer, rendered again as large as it is shown, in a corner away from the
/// pointer, under a cross. The core draws it, off the UI's thread: as exact as the geometry, and
/// alike with and without OpenGL.
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

  /// Puts a pixel of the canvas under the cross; nothing: the loupe hides.
  void lookAt(const SceneShot& shot, const std::optional<QPointF>& pixel);
  const std::optional<QPointF>& place() const { return pixel_; }
  /// Nothing of the newest place is still being drawn.
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
  TaskRunner runner_;
};

/// Annotating in the scene. While the operator places annotations, a click gives the station's
/// side: the corner, edge, circle centre or named point that is shown next to the pointer before,
/// or with Alt held the surface itself; Tab goes on to another thing to snap to. In line mode it is
/// the edge that is lit. Otherwise a click on an annotation chooses it.
class SceneAnnotator : public QObject {
  Q_OBJECT

 public:
  /// Belongs to the canvas.
  SceneAnnotator(QWidget& canvas, AnnotationController& annotation, StationSnapper& snapper);

  bool places() const;
  /// What the scene shows now.
  void setShot(const SceneShot& shot);
  /// True when the click was for an annotation. `at`: the canvas' coordinates.
  bool click(const QPointF& at, Qt::KeyboardModifiers modifiers);
  /// What a click at a pixel of the canvas would snap to; nothing off the station and until its
  /// corners and edges are found.
  std::optional<SceneAim> aimAt(const QPointF& pixel) const;
  /// Where a click would go; nothing where it would do nothing.
  const std::optional<SceneAim>& aim() const { return aim_; }
  const std::vector<SceneAnnotation>& annotations() const { return annotations_; }
  SceneLoupe& loupe() const { return *loupe_; }
  /// Cameras of the rig that are solved with this one, as the solved poses put them.
  std::vector<Frustum> rigFrusta(const Eigen::Vector3d& centre_m) const;
  /// The place that a click would annotate, in words and figures.
  QString place() const;
  /// What is to be done next, or empty.
  QString nextStep() const;
  void paint(QPainter& painter, const QRectF& area) const;

 Q_SIGNALS:
  void changed();  ///< what it paints

 protected:
  bool eventFilter(QObject* watched, QEvent* event) override;

 private:
  void showMode();
  void showAnnotations();
  void hover(const QMouseEvent& event);
  void leave();
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
