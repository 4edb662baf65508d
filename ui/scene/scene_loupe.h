// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <functional>
#include <memory>
#include <optional>

#include <QImage>
#include <QWidget>

#include "ui/run/task_runner.h"
#include "ui/scene/scene_canvas.h"

namespace boresight::ui {

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

/// The scene around the pointer, rendered anew as large as it is shown, in a corner away from the
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
  bool isSwitchedOn() const { return on_; }
  void setSwitchedOn(bool on);

  /// Puts a pixel of the canvas under the cross; nothing: the loupe hides.
  void lookAt(const SceneShot& shot, const std::optional<QPointF>& pixel);
  const std::optional<QPointF>& place() const { return pixel_; }
  /// Nothing of the newest place is still being drawn.
  bool ready() const { return !runner_.isBusy(); }

 Q_SIGNALS:
  void changed();  ///< its magnification, or whether it is on

 protected:
  void paintEvent(QPaintEvent* event) override;

 private:
  void putAside();
  void order();
  void paintText(QPainter& painter) const;

  Over over_;
  SceneShot shot_;
  double magnification_ = 8.0;
  bool on_ = true;
  bool left_ = false;  ///< in the left corner
  std::optional<QPointF> pixel_;
  QImage picture_;
  Viewpoint picture_view_;
  TaskRunner runner_;
};

}  // namespace boresight::ui
