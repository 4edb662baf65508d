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
/// After changes of its members, its owner calls update().
class SceneOverlay : public QWidget {
 public:
  explicit SceneOverlay(QWidget* canvas);

  std::shared_ptr<const SceneContent> content;
  SceneLook look;
  Viewpoint view;
  QString note;                               ///< at the top, e.g. that the view is undistorted
  std::optional<Eigen::Vector3d> hovered;     ///< the point under another view's pointer
  std::optional<Eigen::Vector3d> clicked;     ///< the point that was clicked last in this case
  std::function<void(QPainter&)> paint_over;  ///< drawn over the names, below the note

 protected:
  void paintEvent(QPaintEvent* event) override;

 private:
  void paintNames(QPainter& painter) const;
  void paintMarks(QPainter& painter) const;
  void paintLegend(QPainter& painter) const;
  void paintText(QPainter& painter, const QPointF& at, const QString& text,
                 const QColor& color) const;
};

}  // namespace boresight::ui
