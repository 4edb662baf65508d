// SPDX-License-Identifier: Apache-2.0
// Painting over the scene: annotations, names and the legend.
#pragma once

#include <functional>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include <QWidget>

#include "sessions/annotation/mesh_snap.h"
#include "ui/annotation/annotation_content.h"
#include "ui/scene/scene_aim.h"
#include "ui/scene/scene_canvas.h"

class QPainter;

namespace boresight::ui {

class AnnotationController;

/// The station side of an annotation.
struct SceneAnnotation {
  std::string id;
  Eigen::Vector3d at_m = Eigen::Vector3d::Zero();  ///< for an edge, its middle
  std::optional<sessions::ModelEdge> edge;
  AnnotationState state;
  bool locked = false;
  bool proposed = false;  ///< a named point without annotation in this image
};

/// Annotations that have a station side, after the proposals; the chosen one is last.
std::vector<SceneAnnotation> sceneAnnotations(const AnnotationController& controller);

/// Draws annotations and the aim over the scene. Hidden ones are drawn faintly.
class SceneAnnotationPainter {
 public:
  /// `mesh` may be nullptr: no annotation is hidden.
  SceneAnnotationPainter(QPainter& painter, const Viewpoint& view,
                         const sessions::MeshSnapper* mesh);

  void paintMarks(const std::vector<SceneAnnotation>& annotations) const;
  /// `pointer`: pixel of the canvas.
  void paintAim(const SceneAim& aim, const QPointF& pointer) const;

 private:
  bool seen(const Eigen::Vector3d& at_m) const;
  std::optional<QPointF> place(const Eigen::Vector3d& at_m) const;
  void paintPoint(const SceneAnnotation& annotation) const;
  void paintEdge(const sessions::ModelEdge& edge, const QColor& color, double width_px,
                 bool dashed) const;
  void paintCircle(const sessions::MeshCircle& circle) const;

  QPainter& painter_;
  const Viewpoint& view_;
  const sessions::MeshSnapper* mesh_;
};

/// Draws text with a rim, so that it is legible on any background.
void paintOutlined(QPainter& painter, const QPointF& at, const QFont& font, const QString& text,
                   const QColor& color, const QColor& rim);

/// Id of the nearest visible annotation at a pixel of the canvas; empty without one. Proposals are
/// not included.
std::string pickAnnotation(const std::vector<SceneAnnotation>& annotations, const Viewpoint& view,
                           const sessions::MeshSnapper& mesh, const QPointF& pixel);

/// Names and the legend, in plain Qt over whichever canvas draws the scene. It ignores the mouse.
class SceneOverlay : public QWidget {
 public:
  explicit SceneOverlay(QWidget* canvas);

  void setContent(std::shared_ptr<const SceneContent> content, const SceneLook& look);
  void setView(const Viewpoint& view);
  /// Sets a line at the top, e.g. that the view is undistorted.
  void setNote(const QString& note);
  /// Sets the point under another view's pointer; empty: none.
  void setHovered(const std::optional<Eigen::Vector3d>& at_m);
  /// Sets the point that was clicked last; empty after a change of the case.
  void setAnnotation(const std::optional<Eigen::Vector3d>& at_m);
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
  std::optional<Eigen::Vector3d> annotation_;
  std::optional<Eigen::Vector3d> hovered_;
  std::function<void(QPainter&)> over_;
};

}  // namespace boresight::ui
