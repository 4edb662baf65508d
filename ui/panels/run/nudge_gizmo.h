// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <optional>

#include <QPointF>
#include <QString>

#include "core/geometry/pose.h"
#include "ui/views/canvas_tool.h"

class QAction;
class QKeyEvent;
class QPainter;

namespace boresight::ui {

class NudgeController;
class ViewState;

/// Moves the seed on the image in six degrees of freedom: a drag inside the ring moves it in the
/// image plane, on the ring it rolls, on the circle below the ring it tilts. A drag on the diamond
/// above the ring, or the wheel, changes its distance. Arrows move it by a pixel and Page Up and
/// Down by a hundredth of the distance; with Ctrl they turn it by a step. Shift: ten times as far,
/// Alt: a tenth. Enter uses the pose as seed, Escape drops it, then the tool. One drag is one step
/// of Undo. The distance from the seed is shown while it changes.
class NudgeGizmo : public CanvasTool {
  Q_OBJECT

 public:
  static constexpr double kRing = 96.0;    ///< of the ring, on the screen
  static constexpr double kHandle = 40.0;  ///< from the ring to each handle

  NudgeGizmo(ImageView& view, NudgeController& nudge, ViewState& state, QObject* parent);

  bool isActive() const { return active_; }
  void setActive(bool active);
  /// The tool for menus and strips; its key is N.
  QAction& action() { return *action_; }
  /// "From the seed: x +12.40, y -3.00, z 0.00 mm; tilt +1.20, 0.00 deg, roll -3.10 deg."
  QString offsetText() const;

  void cancelGesture() override;
  void leave() override { setActive(false); }
  void escape() override;
  bool eventFilter(QObject* watched, QEvent* event) override;

 private:
  enum class Part { kNone, kInside, kRing, kDistance, kTilt };

  /// The nudged pose, else the seed, else the annotated pose: a rejected pose is not a start. Empty
  /// where there is none of these: then nothing moves.
  std::optional<Pose> pose() const;
  Eigen::Vector3d middleInCamera_m() const;
  /// Of the station's middle, on the widget; empty where it is behind the camera.
  std::optional<QPointF> centre() const;
  Part partAt(const QPointF& place) const;
  void press(const QPointF& pixel);
  void dragTo(const QPointF& pixel);
  void finishDrag();
  void movePixels(const QPointF& by_px);
  void scaleDistance(double factor);
  void displace(const Eigen::Vector3d& turn_rad,
                const Eigen::Vector3d& move_m = Eigen::Vector3d::Zero());
  bool pressKey(const QKeyEvent& event);
  void paint(QPainter& painter) const;

  NudgeController& nudge_;
  ViewState& state_;
  QAction* action_;
  bool active_ = false;
  Part dragged_ = Part::kNone;
  QPointF last_;  ///< on the widget
};

}  // namespace boresight::ui
