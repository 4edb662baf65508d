// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <memory>
#include <optional>

#include <QPoint>
#include <QWidget>

#include "ui/run/task_runner.h"
#include "ui/state/view_state.h"
#include "ui/vtk/scene_backend.h"
#include "ui/vtk/scene_canvas.h"
#include "ui/vtk/scene_picker.h"

class QAction;
class QBoxLayout;
class QComboBox;
class QLabel;
class QMenu;
class QSlider;

namespace boresight::ui {

class SceneOverlay;

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

  SceneBackend backend() const { return backend_; }
  QWidget* canvas() const { return canvas_->widget(); }
  const SceneContent& content() const { return *content_; }
  Viewpoint viewpoint() const;
  const OrbitCamera& orbitCamera() const { return orbit_; }
  const SceneLook& look() const { return look_; }
  /// Where the image lies while looking through the camera.
  const ViewTransform& imageTransform() const { return image_; }

  /// The image lies behind the mesh while looking through the camera.
  bool backdropReady() const { return through_ && !backdrop_.isNull(); }

  /// Shows the whole scene again (through the camera: the whole image).
  void resetView();
  void lookFrom(StandardView view);
  bool throughCamera() const { return through_; }
  void setThroughCamera(bool through);
  /// Whose camera is looked through: kEstimate is what the views show, nudged or not.
  void setThroughRole(PoseRole role);
  void setShown(const SceneShown& shown);
  void setMeshOpacity(double opacity);
  /// The view state as it is now, without waiting for the event loop.
  void refresh();

 Q_SIGNALS:
  /// A click on the mesh: the place in the station frame, and its vertex when it snapped to one.
  void meshPointPicked(const Eigen::Vector3d& point_in_station_m, int vertex);
  void throughCameraChanged(bool through);

 protected:
  bool eventFilter(QObject* watched, QEvent* event) override;
  void showEvent(QShowEvent* event) override;
  void changeEvent(QEvent* event) override;

 private:
  void build();
  QWidget* buildBar();
  void addOpacity(QMenu& menu);
  void addShowActions(QWidget* bar, QBoxLayout& layout);
  void refreshSoon();
  void updateLook();
  void updateView();
  void updateNote();
  void frameScene();
  void fitImage();
  void orderBackdrop();
  void takeBackdrop(const std::shared_ptr<const sessions::LoadedCase>& one, const QImage& gray);
  Pose throughPose() const;
  void press(const QPointF& at, Qt::MouseButton button);
  void drag(const QPointF& at, Qt::MouseButtons buttons, Qt::KeyboardModifiers modifiers);
  void release(const QPointF& at, Qt::MouseButton button);
  void zoom(const QPointF& at, double notches);
  void pick(const QPointF& at);
  bool takesKey(int key, Qt::KeyboardModifiers modifiers) const;
  bool pressKey(int key, Qt::KeyboardModifiers modifiers);

  ViewState& state_;
  SceneBackend backend_;
  std::unique_ptr<SceneCanvas> canvas_;
  SceneOverlay* overlay_ = nullptr;
  QLabel* readout_ = nullptr;
  QAction* through_action_ = nullptr;
  QComboBox* through_role_ = nullptr;
  QSlider* opacity_ = nullptr;

  std::shared_ptr<const SceneContent> content_;
  SceneLook look_;
  OrbitCamera orbit_;
  ViewTransform image_;
  bool image_fitted_ = true;  ///< follows the canvas' size
  bool through_ = false;
  PoseRole role_ = PoseRole::kEstimate;
  double free_opacity_ = 1.0;
  double through_opacity_ = 0.35;
  QImage backdrop_;
  std::weak_ptr<const sessions::LoadedCase> backdrop_of_;
  bool refresh_pending_ = false;
  QPointF press_;
  QPointF last_;
  bool dragging_ = false;
  TaskRunner runner_;
};

}  // namespace boresight::ui
