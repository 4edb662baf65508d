// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <functional>
#include <memory>

#include <QWidget>

#include "ui/scene/scene_canvas.h"

namespace boresight::ui {

/// Names and the legend, in plain Qt over whichever canvas draws the scene. It lets the mouse
/// through.
class SceneOverlay : public QWidget {
 public:
  explicit SceneOverlay(QWidget* canvas);

  void setContent(std::shared_ptr<const SceneContent> content, const SceneLook& look);
  void setView(const Viewpoint& view);
  /// A line at the top, e.g. that the view is undistorted.
  void setNote(const QString& note);
  /// The place that was pointed at last; none after another case.
  void setMark(const std::optional<Eigen::Vector3d>& at_m);
  /// Drawn over the scene's names, below notes.
  void setOver(std::function<void(QPainter&)> over);

 protected:
  void paintEvent(QPaintEvent* event) override;

 private:
  void paintNames(QPainter& painter) const;
  void paintMark(QPainter& painter) const;
  void paintLegend(QPainter& painter) const;
  void paintText(QPainter& painter, const QPointF& at, const QString& text,
                 const QColor& color) const;

  std::shared_ptr<const SceneContent> content_;
  SceneLook look_;
  Viewpoint view_;
  QString note_;
  std::optional<Eigen::Vector3d> mark_;
  std::function<void(QPainter&)> over_;
};

}  // namespace boresight::ui
