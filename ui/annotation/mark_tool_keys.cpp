// SPDX-License-Identifier: Apache-2.0
// The keys of the tool that marks on the image.
#include <utility>

#include <QKeyEvent>

#include "ui/annotation/mark_tool.h"
#include "ui/views/image_view.h"
#include "ui/views/pixel_point.h"

namespace boresight::ui {
namespace {

constexpr double kSmallStep_px = 0.1;
constexpr double kLargeStep_px = 1.0;

Eigen::Vector2d directionOf(int key) {
  switch (key) {
    case Qt::Key_Left:
      return {-1.0, 0.0};
    case Qt::Key_Right:
      return {1.0, 0.0};
    case Qt::Key_Up:
      return {0.0, -1.0};
    case Qt::Key_Down:
      return {0.0, 1.0};
    default:
      return Eigen::Vector2d::Zero();
  }
}

bool isArrow(int key) { return !directionOf(key).isZero(); }

}  // namespace

bool MarkTool::isOwnKey(const QKeyEvent& event) {
  const int key = event.key();
  if ((event.modifiers() & (Qt::ControlModifier | Qt::AltModifier)) != 0) return key == Qt::Key_Alt;
  return isArrow(key) || key == Qt::Key_Delete || key == Qt::Key_Escape || key == Qt::Key_Tab;
}

bool MarkTool::keyPress(const QKeyEvent& event) {
  if (!isOwnKey(event)) return false;
  switch (event.key()) {
    case Qt::Key_Escape:
      escape();
      return true;
    case Qt::Key_Tab:
      ++turn_;
      updateAim();
      return true;
    case Qt::Key_Delete:
      if (!controller_.selected().empty()) controller_.remove(controller_.selected());
      return true;
    case Qt::Key_Alt:
      return true;  // not for the menu bar
    default:
      return nudge(event);
  }
}

/// Without a chosen mark the arrows are the view's.
bool MarkTool::nudge(const QKeyEvent& event) {
  if (controller_.selected().empty()) return false;
  const bool large = (event.modifiers() & Qt::ShiftModifier) != 0;
  const Eigen::Vector2d by = (large ? kLargeStep_px : kSmallStep_px) * directionOf(event.key());
  if (!controller_.nudge(by, end_)) return true;
  const sessions::PointPair* point = controller_.selectedPoint();
  const sessions::LinePair* line = controller_.selectedLine();
  aim_ = {};
  if (point && point->pixel) focus_ = pointOf(*point->pixel);
  if (line && line->line) focus_ = pointOf(end_ == 0 ? line->line->start : line->line->end);
  view_.update();
  Q_EMIT aimChanged();
  return true;
}

void MarkTool::escape() {
  turn_ = 0;
  if (const std::optional<Drag> drag = std::exchange(drag_, std::nullopt)) {
    press_.reset();
    if (drag->moved) {
      controller_.dragInImage(drag->handle.id, drag->handle.pixel, drag->handle.end);
      controller_.finishMove();
    }
  } else if (line_start_) {
    line_start_.reset();
  } else if (!controller_.selected().empty()) {
    controller_.select({});
  } else {
    controller_.setMode(PlaceMode::kOff);
  }
  updateAim();
}

}  // namespace boresight::ui
