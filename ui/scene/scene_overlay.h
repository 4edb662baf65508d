// SPDX-License-Identifier: Apache-2.0
// What is painted over the scene: annotations of an annotation, names and the legend.
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
  Eigen::Vector3d at_m = Eigen::Vector3d::Zero();  ///< of an edge its middle
  std::optional<sessions::ModelEdge> edge;
  AnnotationState state;
  bool locked = false;
  bool proposed = false;  ///< a named point without annotation in this image
};

/// Annotations that have a place on the station, the chosen one last, after the proposals.
std::vector<SceneAnnotation> sceneAnnotations(const AnnotationController& controller);

/// What is annotated and aimed at, drawn over the scene. What a face hides is drawn faintly.
class SceneAnnotationPainter {
 public:
  /// `mesh` may be nullptr: nothing hides anything.
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

/// Text with a rim, so that it is legible over everything.
void paintOutlined(QPainter& painter, const QPointF& at, const QFont& font, const QString& text,
                   const QColor& color, const QColor& rim);

/// Id of the annotation under a pixel of the canvas that no face hides, the nearest; empty without
/// one. Proposals are no annotations.
std::string pickAnnotation(const std::vector<SceneAnnotation>& annotations, const Viewpoint& view,
                           const sessions::MeshSnapper& mesh, const QPointF& pixel);

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
  /// A place that another view points at.
  void setHovered(const std::optional<Eigen::Vector3d>& at_m);
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
