// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <functional>
#include <memory>
#include <optional>
#include <utility>

#include <Eigen/Core>
#include <QTimer>
#include <QWidget>

#include "sessions/trace/picture_data.h"
#include "sessions/trace/surface_point.h"
#include "ui/run/task_runner.h"
#include "ui/state/view_state.h"
#include "ui/views/layer.h"

class QAction;
class QSplitter;
class QToolBar;

namespace boresight::ui {

class CanvasChips;
class DisplayImage;
class ImageView;
class LayerLegend;
class MeasureTool;

/// The image of the current case with the layers of the current iteration; over it the tools, the
/// legend and the shown iteration. Follows the view state; lines of poses and the agreement are
/// computed by the task runner when their layer is first shown.
class ImagePanel : public QWidget {
  Q_OBJECT

 public:
  ImagePanel(ViewState& state, TaskRunner& tasks, QWidget* parent = nullptr);

  ImageView& view() { return *view_; }
  DisplayImage& display() { return *display_; }
  LayerLegend& legend() { return *legend_; }
  MeasureTool& measure() { return *measure_; }
  /// The strip of tools on the image; other classes add their tools.
  QToolBar& tools();
  /// Sets the title over the image: the shown case and run.
  void setTitle(const QString& text);
  /// Sets a second canvas to the right of the image, hidden until showBeside(); the panel becomes
  /// its owner.
  void setBeside(QWidget* canvas);
  void showBeside(bool shown);
  void setStyle(LayerId id, const LayerStyle& style);
  void showLayer(LayerId id, bool visible);
  const LayerStyle& style(LayerId id) const;
  /// Sets the edges of the nudged pose; nullptr removes them.
  void setNudgedRender(std::shared_ptr<const sessions::RenderTrace> render, int level);
  /// Sets the text shown without an image; empty: a list of files that can be dropped here.
  void setHint(const QString& hint);
  /// The point of the station (metres) that is seen at a pixel of a camera; empty outside it.
  using SurfaceAt = std::function<std::optional<Eigen::Vector3d>(const Camera&, const Pose&,
                                                                 const Eigen::Vector2d&)>;
  /// Replaces the search of all faces for the point under the pointer.
  void setSurfaceAt(SurfaceAt surface_at) { surface_at_ = std::move(surface_at); }
  /// Marks a point of the station in the image; empty: none.
  void showStationPlace(const std::optional<Eigen::Vector3d>& point_in_station_m);
  /// Actions of the strip of tools.
  QAction& blink() { return *blink_; }
  QAction& swipe() { return *swipe_; }
  QAction& coreView() { return *core_view_; }

 Q_SIGNALS:
  /// Something of the image cannot be read or drawn; one sentence.
  void failed(const QString& message);
  void stylesChanged();
  /// For the status bar: pixel, gray value, and the station point where the shown pose covers it.
  void placeText(const QString& text);
  /// The point of the station under the pointer, or empty.
  void stationPlaceHovered(const std::optional<Eigen::Vector3d>& point_in_station_m);
  void allLayersRequested();
  /// A template was clicked.
  void templateClicked();

 private:
  void buildTools();
  void showCase();
  void showIteration();
  void askForPoseLines();
  void showPoseLook();
  void showTemplates();
  void bringLayerOfStage();
  std::optional<Eigen::Vector3d> surfacePoint(const QPointF& pixel) const;
  void showPlace(const QPointF& pixel);
  void showContextMenu(const QPointF& pixel, const QPoint& global);
  void askForRenders();
  void askForRender(LayerId id, const Pose& camera_from_station);
  void forget(LayerId id);
  void showAlternative();
  void askForAgreement();
  void showImage();

  /// The iteration and pose of the pose's lines.
  struct PoseLines {
    std::shared_ptr<const sessions::IterationTrace> iteration;
    bool corrected = false;  ///< the pose after the iteration

    bool operator==(const PoseLines&) const = default;
  };

  ViewState& state_;
  TaskRunner& tasks_;
  TaskKind drawing_pose_;
  TaskKind comparing_;
  std::array<TaskKind, kLayerCount> drawing_;  ///< of each layer
  ImageView* view_;
  QSplitter* canvases_;
  DisplayImage* display_;
  CanvasChips* chips_;
  LayerLegend* legend_ = nullptr;
  MeasureTool* measure_ = nullptr;
  QAction* side_by_side_ = nullptr;
  QAction* blink_ = nullptr;
  QAction* swipe_ = nullptr;
  QAction* core_view_ = nullptr;
  QTimer blink_timer_;
  SurfaceAt surface_at_;
  ViewState::CasePtr shown_case_;
  std::array<bool, kLayerCount> asked_{};  ///< lines of this case that were requested
  PoseLines pose_lines_;
  std::optional<LayerId> stage_layer_;  ///< shown for the stage, hidden before
  std::shared_ptr<const sessions::IterationTrace> agreement_of_;
};

}  // namespace boresight::ui
