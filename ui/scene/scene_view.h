// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <memory>
#include <vector>

#include <QWidget>

#include "ui_scene_view.h"

#include "ui/run/task_runner.h"
#include "ui/scene/scene_aim.h"
#include "ui/scene/scene_canvas.h"
#include "ui/scene/scene_navigation.h"
#include "ui/state/view_state.h"

class QMenu;
class QSlider;

namespace boresight::ui {

class AnnotationController;
class SceneAnnotator;
class SceneOverlay;
class StationSnapper;

/// The station with its cameras in space. It follows the view state; dragging orbits (the station's
/// z axis stays upright), the middle button or Shift pans, the wheel zooms, a click picks a
/// template or a point of the mesh. When looking through the camera, the scene lies over the
/// camera's image, undistorted if the camera distorts, and dragging and the wheel move that
/// picture.
class SceneView : public QWidget {
  Q_OBJECT

 public:
  explicit SceneView(ViewState& state, QWidget* parent = nullptr,
                     SceneBackend backend = sceneBackend());

  /// Enables annotating in the scene; both must outlive it.
  void setAnnotation(AnnotationController& annotation, StationSnapper& snapper);
  /// nullptr before setAnnotation().
  SceneAnnotator* annotator() const { return annotator_; }

  SceneBackend backend() const { return backend_; }
  QWidget* canvas() const { return canvas_->widget(); }
  const SceneContent& content() const { return *content_; }
  SceneNavigation& navigation() { return *navigation_; }
  Viewpoint viewpoint() const { return navigation_->viewpoint(throughPose()); }
  /// Whether the image is drawn behind the mesh while looking through the camera.
  bool backdropReady() const { return navigation_->throughCamera() && !backdrop_.isNull(); }

  void setMeshOpacity(double opacity);
  /// Shows the current view state at once, without waiting for the event loop.
  void refresh();
  /// Marks a point of the station in the scene; empty: none.
  void showStationPlace(const std::optional<Eigen::Vector3d>& point_in_station_m);

 Q_SIGNALS:
  void failed(const QString& message);
  /// The point of the station under the pointer, or empty.
  void stationPlaceHovered(const std::optional<Eigen::Vector3d>& point_in_station_m);

 protected:
  void showEvent(QShowEvent* event) override;
  void changeEvent(QEvent* event) override;

 private:
  void build();
  void buildBar();
  QMenu* showMenu();
  void showThroughCamera();
  void refreshSoon();
  void updateLook();
  void updateView();
  void updateNote();
  void orderBackdrop();
  Pose throughPose() const;
  void pick(const QPointF& at, Qt::KeyboardModifiers modifiers);
  void pickInScene(const QPointF& pixel);
  void hover(const QPointF& at);
  /// The point of the station (metres) at a pixel of the canvas; empty outside it.
  std::optional<Eigen::Vector3d> surfaceAt(const QPointF& pixel) const;

  ViewState& state_;
  SceneBackend backend_;
  std::unique_ptr<SceneCanvas> canvas_;
  SceneNavigation* navigation_ = nullptr;
  SceneOverlay* overlay_ = nullptr;
  QSlider* opacity_ = nullptr;
  SceneAnnotator* annotator_ = nullptr;
  const StationSnapper* snapper_ = nullptr;

  std::shared_ptr<const SceneContent> content_;
  SceneLook look_;
  QImage backdrop_;  ///< the case's image without lens distortion; null until it is computed
  std::weak_ptr<const sessions::LoadedCase> backdrop_of_;
  TaskRunner runner_;
  TaskKind undistorting_;
  PoseRole role_ = PoseRole::kEstimate;  ///< of the pose when looking through the camera
  double free_opacity_ = 1.0;
  double through_opacity_ = 0.35;
  bool refresh_pending_ = false;
  Ui::SceneView ui_;
};

}  // namespace boresight::ui
