// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <Eigen/Core>
#include <array>
#include <optional>

#include <QObject>
#include <QTimer>
#include <QWidget>

#include "ui_nudge_box.h"

#include "core/geometry/pose.h"
#include "ui/state/view_state.h"

namespace boresight::ui {

/// The frame whose axes nudges refer to.
enum class NudgeAxes { kCamera, kStation };
/// The fixed point of rotations.
enum class NudgePivot { kStationCentre, kCameraCentre };

/// Reference of nudges; `centre_in_station_m` is the centre of the matched parts.
struct NudgeFrame {
  NudgeAxes axes = NudgeAxes::kCamera;
  NudgePivot pivot = NudgePivot::kStationCentre;
  Eigen::Vector3d centre_in_station_m = Eigen::Vector3d::Zero();
};

/// A pose displaced by (rotation vector rad, translation m): the station as seen from the camera is
/// turned about the pivot, then moved, along the camera's axes or its own. The station's axes and
/// the pivot are those of the given pose.
Pose nudged(const Pose& camera_from_station, const Vector6d& offset, const NudgeFrame& frame);

/// The offset for `nudged` from the first pose to the second.
Vector6d nudgeBetween(const Pose& camera_from_station_base, const Pose& camera_from_station,
                      const NudgeFrame& frame);

/// The direction in which a key moves, along the camera's x (right), y (down) and z (away); zero
/// for keys that do not nudge.
Eigen::Vector3d directionOf(int key);
/// The rotation axis of a direction key pressed with Ctrl: the near side of the station moves in
/// that direction.
Eigen::Vector3d turnOf(const Eigen::Vector3d& direction);

/// Sizes of one step.
struct NudgeStep {
  double translation_m = 1e-3;
  double rotation_rad = 0.0034906585039886592;  ///< 0.2 deg
};

/// Moves the nudged pose of the view state, by keys and by values, and reports the end of each
/// gesture: one gesture is one step of Undo.
///
/// Keys, on whatever widget the controller is installed: the arrows move along x and y, Page Up and
/// Page Down along z (up is away); with Ctrl they turn about y, x and z. Shift makes steps ten
/// times coarser, Alt ten times finer.
class NudgeController : public QObject {
  Q_OBJECT

 public:
  static constexpr double kCoarse = 10.0;
  static constexpr double kFine = 0.1;
  /// A gesture without an explicit end is over after this time.
  static constexpr int kPause_ms = 600;

  explicit NudgeController(ViewState& state);

  const NudgeFrame& frame() const { return frame_; }
  void setAxes(NudgeAxes axes);
  void setPivot(NudgePivot pivot);
  const NudgeStep& step() const { return step_; }
  void setStep(const NudgeStep& step) { step_ = step; }

  /// From the pose at which nudging began to the nudged pose (rotation rad, translation m); zero
  /// while nothing is nudged.
  Vector6d offset() const;

  /// Sets one value of the offset from the base; the others stay. Without a pose that the views
  /// know nothing is nudged.
  void setOffset(int axis, double value);
  /// Part of the gesture under way.
  void moveTo(const Pose& camera_from_station);
  /// Sets a pasted pose, as a whole gesture.
  void setPose(const Pose& camera_from_station);
  /// Returns to the pose that was nudged, as a whole gesture.
  void backToEstimate();
  /// Removes the nudged pose, as a whole gesture.
  void drop();
  /// Requests the nudged pose, if any, as the seed.
  void useAsSeed();

  /// Ends the gesture under way, if any.
  void finishGesture();
  /// Restores the pose before the gesture under way, if any.
  void cancelGesture();

  /// Consumes the keys that nudge.
  bool eventFilter(QObject* watched, QEvent* event) override;

 Q_SIGNALS:
  /// The base, the offset or the frame has changed.
  void changed();
  /// A gesture has ended: from the first key press or value to the release.
  void gestureFinished(const boresight::Pose& before, const boresight::Pose& after);
  void useAsSeedRequested(const boresight::Pose& camera_from_station);

 private:
  Pose estimate() const;
  Pose base() const { return base_.value_or(estimate()); }
  void caseChanged();
  void stateChanged();

  ViewState& state_;
  NudgeFrame frame_;
  NudgeStep step_;
  std::optional<Pose> base_;           ///< while something is nudged
  std::optional<Pose> before_;         ///< shown before the gesture under way
  std::optional<Pose> nudged_before_;  ///< nudged before it
  QTimer pause_;
};

/// The controls of nudging: six values, their axes and pivot, the size of a step, and a field that
/// takes the keys while it has the focus.
class NudgeBox : public QWidget {
  Q_OBJECT

 public:
  NudgeBox(NudgeController& controller, ViewState& state);

 protected:
  bool eventFilter(QObject* watched, QEvent* event) override;

 private:
  void connectSettings();
  void takeStep();
  void showOffset();

  NudgeController& controller_;
  ViewState& state_;
  std::array<QDoubleSpinBox*, 6> values_{};  ///< rotation in deg, then translation in mm
  Ui::NudgeBox ui_;
};

}  // namespace boresight::ui
