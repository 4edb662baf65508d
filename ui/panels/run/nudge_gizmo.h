// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <optional>

#include <QObject>
#include <QPointF>

#include "core/geometry/pose.h"

class QAction;
class QKeyEvent;
class QPainter;

namespace boresight::ui {

class ImageView;
class NudgeController;
class ViewState;

/// Moves the seed on the image: a drag inside the ring moves it in the image plane, a drag on the
/// ring rolls it about the view axis, one on the handle above the ring and the wheel change its
/// distance. Arrows move it by a pixel, with Shift by ten, with Alt by a tenth. Enter uses the pose
/// as seed, Escape drops it, then the tool. One drag is one step of Undo.
class NudgeGizmo : public QObject {
  Q_OBJECT

 public:
  static constexpr double kRing = 96.0;    ///< of the ring, on the screen
  static constexpr double kHandle = 40.0;  ///< from the ring to the handle of the distance

  NudgeGizmo(ImageView& view, NudgeController& nudge, ViewState& state, QObject* parent = nullptr);

  bool isActive() const { return active_; }
  void setActive(bool active);
  /// The tool for menus and strips; its key is N.
  QAction& action() { return *action_; }

  bool eventFilter(QObject* watched, QEvent* event) override;

 Q_SIGNALS:
  void useAsSeedRequested(const boresight::Pose& camera_from_station);

 private:
  enum class Part { kNone, kInside, kRing, kHandle };

  /// The nudged pose, else the seed: a rejected pose is not a start.
  Pose pose() const;
  /// Of the station's middle, on the widget; nothing where it is behind the camera.
  std::optional<QPointF> centre() const;
  Part partAt(const QPointF& place) const;
  void press(const QPointF& pixel);
  void dragTo(const QPointF& pixel);
  void release();
  void movePixels(const QPointF& by_px);
  void scaleDistance(double factor);
  bool pressKey(const QKeyEvent& event);
  void apply(const Vector6d& displacement);
  void paint(QPainter& painter) const;

  ImageView& view_;
  NudgeController& nudge_;
  ViewState& state_;
  QAction* action_;
  bool active_ = false;
  Part dragged_ = Part::kNone;
  QPointF last_;  ///< on the widget
};

}  // namespace boresight::ui
