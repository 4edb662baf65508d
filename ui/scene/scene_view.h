// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <memory>
#include <optional>
#include <vector>

#include <QPoint>
#include <QWidget>

#include "ui/run/task_runner.h"
#include "ui/scene/scene_aim.h"
#include "ui/scene/scene_canvas.h"
#include "ui/scene/scene_input.h"
#include "ui/state/view_state.h"

class QAction;
class QMenu;
class QSlider;

namespace boresight::ui {

namespace Ui {
class SceneView;
}

class AnnotationController;
class SceneAnnotator;
class SceneOverlay;
class StationSnapper;

/// The station with its cameras in space. It follows the view state; dragging orbits (the station's
/// z axis stays upright), the middle button or Shift pans, the wheel zooms, a click picks a
/// template or a point of the mesh. Looking through the camera it lies over the camera's image,
/// undistorted where the camera distorts, and dragging and the wheel move that picture.
class SceneView : public QWidget {
  Q_OBJECT

 public:
  explicit SceneView(ViewState& state, QWidget* parent = nullptr,
                     SceneBackend backend = sceneBackend());
  ~SceneView() override;

  /// Lets somebody annotate in it; both must outlive it.
  void setAnnotation(AnnotationController& annotation, StationSnapper& snapper);
  /// nullptr before.
  SceneAnnotator* annotator() const { return annotator_; }

  SceneBackend backend() const { return backend_; }
  QWidget* canvas() const { return canvas_->widget(); }
  const SceneContent& content() const { return *content_; }
  Viewpoint viewpoint() const;
  const OrbitCamera& orbitCamera() const { return navigation_.orbit(); }
  const SceneLook& look() const { return look_; }
  /// Where the image lies while looking through the camera.
  const ViewTransform& imageTransform() const { return navigation_.image(); }

  /// The image lies behind the mesh while looking through the camera.
  bool backdropReady() const { return throughCamera() && !backdrop_.isNull(); }

  /// Shows the whole scene again (through the camera: the whole image).
  void resetView();
  void lookFrom(StandardView view);
  bool throughCamera() const { return navigation_.throughCamera(); }
  void setThroughCamera(bool through);
  /// Whose camera is looked through: kEstimate is what the views show, nudged or not.
  void setThroughRole(PoseRole role);
  void setShown(const SceneShown& shown);
  void setMeshOpacity(double opacity);
  /// The view state as it is now, without waiting for the event loop.
  void refresh();

 protected:
  void showEvent(QShowEvent* event) override;
  void changeEvent(QEvent* event) override;

 private:
  void build();
  void buildBar();
  QMenu* showMenu();
  void connectInput(const SceneInput& input);
  void refreshSoon();
  void updateLook();
  void updateView();
  void updateNote();
  void orderBackdrop();
  Pose throughPose() const;
  void pick(const QPointF& at, Qt::KeyboardModifiers modifiers);
  void pickInScene(const QPointF& pixel);

  ViewState& state_;
  SceneBackend backend_;
  std::unique_ptr<SceneCanvas> canvas_;
  SceneOverlay* overlay_ = nullptr;
  std::vector<QAction*> show_;  ///< in the order of `kShowEntries`
  QSlider* opacity_ = nullptr;
  SceneAnnotator* annotator_ = nullptr;

  std::shared_ptr<const SceneContent> content_;
  SceneLook look_;
  SceneNavigation navigation_;
  QImage backdrop_;  ///< the case's image without lens distortion; null until it is there
  std::weak_ptr<const sessions::LoadedCase> backdrop_of_;
  TaskRunner runner_;
  PoseRole role_ = PoseRole::kEstimate;
  double free_opacity_ = 1.0;
  double through_opacity_ = 0.35;
  bool refresh_pending_ = false;
  const std::unique_ptr<Ui::SceneView> ui_;
};

}  // namespace boresight::ui
