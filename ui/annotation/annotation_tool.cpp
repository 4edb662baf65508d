// SPDX-License-Identifier: Apache-2.0
#include "ui/annotation/annotation_tool.h"

#include <utility>

#include <QtWidgets>

#include "sessions/annotation/annotations_on_image.h"
#include "ui/annotation/station_snapper.h"
#include "ui/views/image_view.h"
#include "ui/views/view_transform.h"

namespace boresight::ui {
namespace {

/// How near one must point, on the screen: a mark's ring belongs to it.
constexpr double kPressReach = kMarkRadius_px + 3.0;
constexpr double kPressSlack = 3.0;    ///< on the screen
constexpr double kShortestLine = 6.0;  ///< on the screen
/// Those that change what a click does.
constexpr Qt::KeyboardModifiers kAimModifiers = Qt::ControlModifier | Qt::AltModifier;

constexpr double kSmallStep_px = 0.1;
constexpr double kLargeStep_px = 1.0;

}  // namespace

AnnotationTool::AnnotationTool(ImageView& view, AnnotationController& controller, ViewState& state,
                               StationSnapper& snapper, QObject* parent)
    : CanvasTool(view, parent), controller_(controller), state_(state), snapper_(snapper) {
  connect(&controller_, &AnnotationController::modeChanged, this, &AnnotationTool::showMode);
  connect(&controller_, &AnnotationController::annotationsChanged, this,
          [this] { view_.update(); });
  connect(&controller_, &AnnotationController::selectionChanged, this, [this] {
    if (!drag_) end_ = 0;
    view_.update();
  });
  state_.onChange(ViewChange::kCase, this, &AnnotationTool::clearAim);
  connect(&snapper_, &StationSnapper::meshChanged, this, &AnnotationTool::updateAim);
}

void AnnotationTool::setSnaps(bool snaps) {
  if (snaps == snaps_) return;
  snaps_ = snaps;
  updateAim();
  Q_EMIT snapsChanged();
}

std::optional<Pose> AnnotationTool::stationPose() const {
  if (controller_.answer().blind) return std::nullopt;
  const std::optional<Pose> solved = controller_.solvedPose();
  return solved && view_.layer(LayerId::kAnnotationEdges).style.visible ? solved
                                                                        : state_.knownPose();
}

void AnnotationTool::showMode() {
  cancelGesture();
  turn_ = 0;
  if (active()) {
    claim();
    updateAim();
  } else {
    release();
    clearAim();
  }
  view_.setCursor(active() || view_.toolActive() ? Qt::CrossCursor : Qt::ArrowCursor);
}

AimRules AnnotationTool::rules() const {
  return {.snaps = snaps_ && (modifiers_ & Qt::AltModifier) == 0,
          .line = drawsLines(),
          .radius_px = snapRadius_px(view_.transform().scale()),
          .turn = turn_};
}

void AnnotationTool::clearAim() {
  aim_ = {};
  pointer_.reset();
  focus_.reset();
  line_start_.reset();
  view_.update();
  Q_EMIT aimChanged();
}

void AnnotationTool::updateAim() {
  const ViewState::CasePtr& loaded_case = state_.currentCase();
  if (!active() || !loaded_case || !pointer_ || drag_) return;
  const Eigen::Vector2d pixel = vectorOf(*pointer_);
  const QPointF place = view_.transform().toWidget(*pointer_);
  aim_ = {};
  const std::optional<Pose> pose = stationPose();
  if ((modifiers_ & Qt::ControlModifier) != 0 && pose) {
    const AimRules how = rules();
    aim_ =
        aimAtStation(*loaded_case, *pose, pixel,
                     snapper_.near(loaded_case->source.camera, *pose, pixel, how.radius_px), how);
  } else if (const auto handle = line_start_ ? std::nullopt : handleUnder(place)) {
    aim_.text = tr("%1: drag to move").arg(QString::fromStdString(handle->id));
  } else {
    aim_ = aimAtImage(*loaded_case, pixel, rules());
    if (const auto* proposal = proposalUnder(place))
      aim_.text = tr("%1, %2: click places it, right click to place it later")
                      .arg(QString::fromStdString(proposal->landmark.name), aim_.text);
  }
  focus_ = pointer_;
  view_.update();
  Q_EMIT aimChanged();
}

/// The chosen pair waits for its place in the image.
bool AnnotationTool::lacksImageSide() const {
  if (drawsLines()) {
    const sessions::LinePair* line = controller_.selectedLine();
    return line && line->edge && !line->line;
  }
  const sessions::PointPair* point = controller_.selectedPoint();
  return point && point->point_in_station_m && !point->pixel;
}

double AnnotationTool::screenDistance(const Eigen::Vector2d& pixel, const QPointF& place) const {
  return distance_px(view_.transform().toWidget(pixel), place);
}

/// The nearest within reach. While a chosen pair waits for its place, a click is that place.
const sessions::Proposal* AnnotationTool::proposalUnder(const QPointF& place) const {
  if (drawsLines() || lacksImageSide()) return nullptr;
  if (!view_.layer(LayerId::kProposals).style.visible) return nullptr;
  const sessions::Proposal* found = nullptr;
  double nearest = kPressReach;
  for (const sessions::Proposal& proposal : controller_.answer().proposals) {
    const double distance = screenDistance(proposal.pixel, place);
    if (distance > nearest) continue;
    nearest = distance;
    found = &proposal;
  }
  return found;
}

/// The nearest point or end of a line within reach.
std::optional<AnnotationTool::Handle> AnnotationTool::handleUnder(const QPointF& place) const {
  std::optional<Handle> found;
  double nearest = kPressReach;
  const auto offer = [&](const std::string& id, int end, const Eigen::Vector2d& pixel) {
    const double distance = screenDistance(pixel, place);
    if (distance > nearest) return;
    nearest = distance;
    found = Handle{id, end, pixel, false};
  };
  for (const sessions::PointPair& point : controller_.annotations().points)
    if (point.pixel) offer(point.id, 0, *point.pixel);
  for (const sessions::LinePair& line : controller_.annotations().lines) {
    if (!line.line) continue;
    offer(line.id, 0, line.line->start);
    offer(line.id, 1, line.line->end);
  }
  return found;
}

/// A point without a place in the image that the pose predicts within reach, or "".
std::string AnnotationTool::stationOnlyUnder(const QPointF& place) const {
  const ViewState::CasePtr& loaded_case = state_.currentCase();
  const std::optional<Pose> pose = stationPose();
  if (!loaded_case || !pose || lacksImageSide()) return {};
  for (const sessions::PointPair& point : controller_.annotations().points) {
    if (point.pixel || !point.point_in_station_m) continue;
    const auto at =
        sessions::predictPlace(loaded_case->source.camera, *pose, *point.point_in_station_m);
    if (at.valid && screenDistance(at.pixel, place) <= kPressReach) return point.id;
  }
  return {};
}

bool AnnotationTool::eventFilter(QObject* watched, QEvent* event) {
  if (CanvasTool::eventFilter(watched, event)) return true;
  if (!active() || view_.toolActive() || !state_.currentCase()) return false;
  switch (event->type()) {
    case QEvent::MouseButtonPress:
    case QEvent::MouseButtonDblClick:
    case QEvent::MouseButtonRelease:
    case QEvent::MouseMove:
      return mouseEvent(event->type(), *static_cast<QMouseEvent*>(event));
    case QEvent::ContextMenu:  // the right button begins a proposal
      return true;
    case QEvent::ShortcutOverride:
      if (!isOwnKey(*static_cast<QKeyEvent*>(event))) return false;
      event->accept();
      return true;
    case QEvent::KeyPress:
    case QEvent::KeyRelease: {
      const auto& key = *static_cast<QKeyEvent*>(event);
      const Qt::KeyboardModifiers before = std::exchange(modifiers_, key.modifiers());
      if (((before ^ modifiers_) & kAimModifiers) != 0) updateAim();
      return event->type() == QEvent::KeyPress && keyPress(key);
    }
    case QEvent::Leave:
      if (!drag_ && !line_start_) clearAim();
      return false;
    default:
      return false;
  }
}

bool AnnotationTool::mouseEvent(QEvent::Type type, const QMouseEvent& event) {
  const QPointF place = pointerPlace(event, view_);
  if (type == QEvent::MouseMove) {
    if (press_ && (event.buttons() & Qt::LeftButton) == 0) loseButton();
    return move(place, event.modifiers());
  }
  if (type == QEvent::MouseButtonRelease) return event.button() == Qt::LeftButton && finishPress();
  return press(event, place);
}

bool AnnotationTool::press(const QMouseEvent& event, const QPointF& place) {
  modifiers_ = event.modifiers();
  if (event.button() == Qt::RightButton) return takeProposal(event, place);
  if (event.button() != Qt::LeftButton) return false;
  pointer_ = view_.transform().toPixel(place);
  if (!line_start_ && takeProposal(event, place)) return true;
  press_ = last_ = place;
  panning_ = false;
  if (line_start_ || (modifiers_ & Qt::ControlModifier) != 0) return true;
  if (const std::optional<Handle> handle = handleUnder(place)) {
    drag_ = handle;
    end_ = handle->end;
    controller_.select(handle->id);
  } else if (const std::string id = stationOnlyUnder(place); !id.empty()) {
    controller_.select(id);
    press_.reset();
  }
  return true;
}

/// A proposal is annotated where the operator clicks, or on what that snaps to; by another button
/// or with Ctrl it is begun.
bool AnnotationTool::takeProposal(const QMouseEvent& event, const QPointF& place) {
  const sessions::Proposal* proposal = proposalUnder(place);
  if (!proposal || (event.button() == Qt::LeftButton && handleUnder(place))) return false;
  const sessions::Proposal taken = *proposal;  // the controller forgets it
  const bool begins =
      event.button() != Qt::LeftButton || (event.modifiers() & Qt::ControlModifier) != 0;
  if (begins) {
    controller_.begin(taken.landmark);
  } else {
    const Eigen::Vector2d pixel = vectorOf(view_.transform().toPixel(place));
    controller_.confirm(taken, aimAtImage(*state_.currentCase(), pixel, rules()).pixel);
  }
  updateAim();
  return true;
}

bool AnnotationTool::move(const QPointF& place, Qt::KeyboardModifiers modifiers) {
  modifiers_ = modifiers;
  const QPointF delta = place - std::exchange(last_, place);
  pointer_ = view_.transform().toPixel(place);
  const bool beyond_slack = press_ && (place - *press_).manhattanLength() > kPressSlack;
  if (drag_) {
    if (beyond_slack || drag_->moved) dragTo(*pointer_);
    return true;
  }
  if (press_) {
    panning_ = panning_ || beyond_slack;
    if (!panning_) return true;
    ViewTransform transform = view_.transform();
    transform.pan(delta);
    view_.setTransform(transform);
    return true;
  }
  updateAim();
  return false;
}

/// The annotation keeps its distance from the pointer, so that taking hold of it moves nothing.
void AnnotationTool::dragTo(const QPointF& pixel) {
  Handle& handle = *drag_;
  const Eigen::Vector2d by = vectorOf(pixel - view_.transform().toPixel(*press_));
  aim_ = aimAtImage(*state_.currentCase(), handle.pixel + by, rules());
  if (!sessions::isInImage(state_.currentCase()->source.camera, aim_.pixel)) return;
  if (!controller_.dragInImage(handle.id, aim_.pixel, handle.end)) {
    drag_.reset();
    press_.reset();
    aim_ = {};
    return;
  }
  handle.moved = true;
  focus_ = pointOf(handle.pixel + by);
  view_.update();
  Q_EMIT aimChanged();
}

bool AnnotationTool::finishPress() {
  const std::optional<QPointF> pressed = std::exchange(press_, std::nullopt);
  if (const auto drag = std::exchange(drag_, std::nullopt)) {
    if (drag->moved) controller_.finishMove();
    updateAim();
    return true;
  }
  if (pressed && !std::exchange(panning_, false)) {
    pointer_ = view_.transform().toPixel(*pressed);
    updateAim();
    this->place();
  }
  return true;
}

void AnnotationTool::place() {
  turn_ = 0;
  if (aim_.side == AimSide::kImage) {
    placeImage();
  } else if (aim_.side == AimSide::kStation && drawsLines()) {
    controller_.placeEdgeOnStation(*aim_.edge);
  } else if (aim_.side == AimSide::kStation) {
    controller_.placeOnStation(*aim_.point_in_station_m);
  } else if ((modifiers_ & Qt::ControlModifier) != 0) {
    Q_EMIT controller_.told(drawsLines()
                                ? tr("No edge of the station is near the pointer; point at a drawn "
                                     "edge with Ctrl held.")
                                : tr("The station is not under the pointer; point at its drawn "
                                     "edges with Ctrl held, or pick in the scene."));
  }
  updateAim();
}

void AnnotationTool::placeImage() {
  if (!sessions::isInImage(state_.currentCase()->source.camera, aim_.pixel)) {
    Q_EMIT controller_.told(tr("This position is outside the image."));
    return;
  }
  if (!drawsLines()) {
    controller_.placeInImage(aim_.pixel);
  } else if (!line_start_) {
    if (!lacksImageSide()) controller_.select({});  // the line that is begun is another annotation
    line_start_ = aim_.pixel;
  } else if ((aim_.pixel - *line_start_).norm() * view_.transform().scale() < kShortestLine) {
    Q_EMIT controller_.told(tr("The two points of a line coincide; click farther along the edge."));
  } else {
    controller_.placeLineInImage({*std::exchange(line_start_, std::nullopt), aim_.pixel});
  }
}

void AnnotationTool::paint(QPainter& painter, const QRectF& taken) const {
  if (!active() || !pointer_) return;
  if (line_start_) {
    painter.setRenderHint(QPainter::Antialiasing, true);
    const QPointF from = view_.transform().toWidget(*line_start_);
    const QPointF to = view_.transform().toWidget(aim_.pixel);
    for (const QPen& pen : {QPen(QColor(0, 0, 0, 170), 3.2), QPen(QColor(255, 255, 255), 1.4)}) {
      painter.setPen(pen);
      if (aim_.side == AimSide::kImage) painter.drawLine(from, to);
      painter.drawEllipse(from, 4.0, 4.0);
    }
  }
  paintAim(painter, view_.transform(), aim_, *pointer_);
  QString text = aim_.text;
  if (aim_.side == AimSide::kStation) text = tr("station: %1").arg(text);
  if (aim_.found > 1) text += tr("  (%1 of %2, Tab)").arg(aim_.chosen + 1).arg(aim_.found);
  if (!snaps_ && aim_.side != AimSide::kNone) text += tr("  (snapping is off)");
  paintNote(painter, view_.rect(), taken, view_.transform().toWidget(*pointer_), text);
}

bool AnnotationTool::isOwnKey(const QKeyEvent& event) const {
  const int key = event.key();
  if ((event.modifiers() & (Qt::ControlModifier | Qt::AltModifier)) != 0) return key == Qt::Key_Alt;
  return !arrowOf(key).isNull() || key == Qt::Key_Delete || (key == Qt::Key_Tab && aim_.found > 1);
}

bool AnnotationTool::keyPress(const QKeyEvent& event) {
  if (!isOwnKey(event)) return false;
  switch (event.key()) {
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

/// Without a chosen annotation the arrows are the view's.
bool AnnotationTool::nudge(const QKeyEvent& event) {
  if (controller_.selected().empty()) return false;
  const bool large = (event.modifiers() & Qt::ShiftModifier) != 0;
  const QPointF by = (large ? kLargeStep_px : kSmallStep_px) * arrowOf(event.key());
  if (!controller_.nudge(vectorOf(by), end_)) return true;
  aim_ = {};
  if (const auto pixel = controller_.selectedPixel(end_)) focus_ = pointOf(*pixel);
  view_.update();
  Q_EMIT aimChanged();
  return true;
}

/// A line whose first point is clicked is a gesture, too.
void AnnotationTool::cancelGesture() {
  press_.reset();
  line_start_.reset();
  panning_ = false;
  if (std::exchange(drag_, std::nullopt)) controller_.cancelMove();
}

void AnnotationTool::escape() {
  turn_ = 0;
  if (drag_ || line_start_) {
    cancelGesture();
  } else if (!controller_.selected().empty()) {
    controller_.select({});
  } else {
    controller_.setMode(PlaceMode::kOff);
  }
  updateAim();
}

}  // namespace boresight::ui
