// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <optional>
#include <string>

#include <QEvent>
#include <QPointF>

#include "ui/annotation/annotation_aim.h"
#include "ui/annotation/annotation_controller.h"
#include "ui/views/canvas_tool.h"

class QKeyEvent;
class QMouseEvent;

namespace boresight::ui {

class StationSnapper;

/// Annotates with the pointer on the image. A click annotates an image position, Ctrl+click the
/// point of the station drawn there (by the edges of the annotated pose while these are visible,
/// else of the shown pose); in line mode two clicks annotate a line, Ctrl+click an edge. Before the
/// click it shows the target and its snap; Tab changes to another snap candidate, Alt held disables
/// snapping. A press on an annotation chooses it, and drags it; a drag elsewhere pans. Arrows move
/// the chosen annotation by 0.1 px, with Shift by 1 px; Delete removes it; Escape drops the
/// unfinished gesture, then the selection, then the mode.
class AnnotationTool : public CanvasTool {
  Q_OBJECT

 public:
  AnnotationTool(ImageView& view, AnnotationController& controller, ViewState& state,
                 StationSnapper& snapper, QObject* parent = nullptr);

  bool snaps() const { return snaps_; }
  void setSnaps(bool snaps);

  /// Target of a click now; side kNone when a click has no effect.
  const AnnotationAim& aim() const { return aim_; }
  /// Position of the pointer, or of the annotation that is moved by keys; px. Empty: none.
  const std::optional<QPointF>& focus() const { return focus_; }
  /// camera_from_station of the edges on which the station is picked; empty in a blind round.
  std::optional<Pose> stationPose() const;

  /// Texts are kept outside `taken` (widget).
  void paint(QPainter& painter, const QRectF& taken) const;
  void cancelGesture() override;
  void leave() override { controller_.setMode(PlaceMode::kOff); }
  void escape() override;
  bool eventFilter(QObject* watched, QEvent* event) override;

 Q_SIGNALS:
  void aimChanged();  ///< or the focus
  void snapsChanged();

 private:
  /// An image position that can be dragged.
  struct Handle {
    std::string id;
    int end = 0;  ///< of a line
    Eigen::Vector2d pixel = Eigen::Vector2d::Zero();
    bool moved = false;  ///< by the current drag
  };

  bool active() const { return controller_.mode() != PlaceMode::kOff; }
  bool drawsLines() const { return controller_.mode() == PlaceMode::kLine; }
  bool mouseEvent(QEvent::Type type, const QMouseEvent& event);
  bool press(const QMouseEvent& event, const QPointF& place);
  bool move(const QPointF& place, Qt::KeyboardModifiers modifiers);
  bool finishPress();
  void dragTo(const QPointF& pixel);
  /// Keys that shortcuts of the window must not take while the operator annotates; Tab where there
  /// is something else to take, otherwise it leads on to the next widget.
  bool isOwnKey(const QKeyEvent& event) const;
  bool keyPress(const QKeyEvent& event);
  bool nudge(const QKeyEvent& event);
  void showMode();

  bool lacksImageSide() const;
  double screenDistance(const Eigen::Vector2d& pixel, const QPointF& place) const;
  std::optional<Handle> handleUnder(const QPointF& place) const;
  const sessions::Proposal* proposalUnder(const QPointF& place) const;
  std::string stationOnlyUnder(const QPointF& place) const;
  bool takeProposal(const QMouseEvent& event, const QPointF& place);
  void place();
  void placeImage();
  void updateAim();
  void clearAim();
  AimRules rules() const;

  AnnotationController& controller_;
  ViewState& state_;
  StationSnapper& snapper_;
  bool snaps_ = true;
  AnnotationAim aim_;
  std::optional<QPointF> pointer_;  ///< px
  std::optional<QPointF> focus_;    ///< px
  Qt::KeyboardModifiers modifiers_;
  int turn_ = 0;
  std::optional<QPointF> press_;  ///< on the widget, of a click that may become a pan
  QPointF last_;
  bool panning_ = false;
  std::optional<Handle> drag_;
  std::optional<Eigen::Vector2d> line_start_;  ///< px, of an unfinished line
  int end_ = 0;                                ///< of the chosen line
};

}  // namespace boresight::ui
