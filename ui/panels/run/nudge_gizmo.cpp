// SPDX-License-Identifier: Apache-2.0
#include "ui/panels/run/nudge_gizmo.h"

#include <cmath>
#include <utility>

#include <QAction>
#include <QKeyEvent>
#include <QPainter>
#include <QWheelEvent>

#include "core/base/math.h"
#include "ui/models/text.h"
#include "ui/panels/run/nudge_box.h"
#include "ui/state/view_state.h"
#include "ui/style/icons.h"
#include "ui/style/tokens.h"
#include "ui/views/image_view.h"
#include "ui/views/line_painter.h"
#include "ui/views/overlay_painters.h"

namespace boresight::ui {
namespace {

constexpr double kReach = 9.0;
constexpr double kArrow = 22.0;
constexpr double kWheelFactor = 1.01;    ///< of the distance, per notch
constexpr double kHandleFactor = 1.002;  ///< per pixel that the handle is dragged
constexpr double kNotesLeft = 56.0;      ///< clear of the strip of tools
constexpr double kNotesTop = 44.0;       ///< below the canvas' title
constexpr LineToken kGizmoLine = {0xE69F00, 2.4, 0, 0, true, 0x000000, 2.0};

double angleOf(const QPointF& from, const QPointF& to) {
  return std::atan2(to.y() - from.y(), to.x() - from.x());
}

/// From the ring's middle to the handle of the distance; the one of tilts lies opposite.
QPointF handleOffset() { return {0.0, -(NudgeGizmo::kRing + NudgeGizmo::kHandle)}; }

/// "+1.20"; "0.00" without a sign.
QString signedText(double value) {
  const double rounded = std::round(100.0 * value) / 100.0 + 0.0;
  return QLatin1String(rounded > 0.0 ? "+" : "") + numberText(rounded, 2);
}

}  // namespace

NudgeGizmo::NudgeGizmo(ImageView& view, NudgeController& nudge, ViewState& state, QObject* parent)
    : CanvasTool(view, parent),
      nudge_(nudge),
      state_(state),
      action_(new QAction(overlayIcon(Icon::kMove), tr("Nudge seed"), this)) {
  action_->setObjectName(QStringLiteral("nudgeSeed"));
  action_->setCheckable(true);
  action_->setShortcut(Qt::Key_N);
  action_->setToolTip(tr("Move and turn the seed on the image (N)"));
  connect(action_, &QAction::toggled, this, &NudgeGizmo::setActive);
  view_.addOverlay(this, [this](QPainter& painter) { paint(painter); });
  connect(&view_, &ImageView::toolPressed, this, &NudgeGizmo::press);
  connect(&view_, &ImageView::toolMoved, this, &NudgeGizmo::dragTo);
  connect(&view_, &ImageView::toolReleased, this, &NudgeGizmo::finishDrag);
  state_.onChange(ViewChange::kCase | ViewChange::kNudgedPose | ViewChange::kAnnotatedPose, this,
                  [this] { view_.update(); });
}

void NudgeGizmo::setActive(bool active) {
  if (active == active_) return;
  active_ = active;
  if (active) {
    claim();
  } else {
    release();
    nudge_.finishGesture();
  }
  dragged_ = Part::kNone;
  view_.setToolActive(active);
  action_->setChecked(active);
}

std::optional<Pose> NudgeGizmo::pose() const {
  if (state_.nudgedPose()) return state_.nudgedPose();
  const auto& loaded_case = state_.currentCase();
  if (loaded_case && loaded_case->source.has_seed)
    return loaded_case->source.camera_from_station_seed;
  return state_.annotatedPose();
}

std::optional<QPointF> NudgeGizmo::centre() const {
  const auto& loaded_case = state_.currentCase();
  const std::optional<Pose> shown = pose();
  Eigen::Vector2d pixel;
  if (!loaded_case || !shown ||
      !project(loaded_case->source.camera, *shown * nudge_.frame().centre_in_station_m, pixel))
    return std::nullopt;
  return view_.transform().toWidget(pointOf(pixel));
}

NudgeGizmo::Part NudgeGizmo::partAt(const QPointF& place) const {
  const auto middle = centre();
  if (!middle) return Part::kNone;
  if (distance_px(place, *middle + handleOffset()) <= kReach + 4.0) return Part::kDistance;
  if (distance_px(place, *middle - handleOffset()) <= kReach + 4.0) return Part::kTilt;
  const double away = distance_px(place, *middle);
  if (std::abs(away - kRing) <= kReach) return Part::kRing;
  return away < kRing ? Part::kInside : Part::kNone;
}

void NudgeGizmo::press(const QPointF& pixel) {
  if (!active_) return;
  last_ = view_.transform().toWidget(pixel);
  dragged_ = partAt(last_);
}

void NudgeGizmo::dragTo(const QPointF& pixel) {
  if (!active_) return;
  const QPointF place = view_.transform().toWidget(pixel);
  const QPointF before = std::exchange(last_, place);
  const auto middle = centre();
  if (!middle) return;
  switch (dragged_) {
    case Part::kNone: {  // as without the tool
      ViewTransform transform = view_.transform();
      transform.pan(place - before);
      view_.setTransform(transform);
      break;
    }
    case Part::kInside:
      movePixels((place - before) / view_.transform().scale());
      break;
    case Part::kRing:
      displace({0.0, 0.0,
                std::remainder(angleOf(*middle, place) - angleOf(*middle, before),
                               2.0 * std::acos(-1.0))});
      break;
    case Part::kTilt: {  // the near side of a ball as large as the ring follows the pointer
      const QPointF angles = (place - before) / kRing;
      displace({angles.y(), -angles.x(), 0.0});
      break;
    }
    case Part::kDistance:
      scaleDistance(std::pow(kHandleFactor, before.y() - place.y()));
      break;
  }
}

void NudgeGizmo::cancelGesture() {
  if (std::exchange(dragged_, Part::kNone) != Part::kNone) nudge_.cancelGesture();
}

void NudgeGizmo::escape() {
  if (dragged_ != Part::kNone)
    cancelGesture();
  else
    state_.nudgedPose() ? nudge_.drop() : leave();
}

void NudgeGizmo::finishDrag() {
  if (active_ && dragged_ != Part::kNone) nudge_.finishGesture();
  dragged_ = Part::kNone;
}

/// Moves the station parallel to the image. The dragged point, at the depth of its middle, follows
/// the pointer.
void NudgeGizmo::movePixels(const QPointF& by_px) {
  const Camera& camera = state_.currentCase()->source.camera;
  const double depth_m = middleInCamera_m().z();
  displace(Eigen::Vector3d::Zero(),
           {by_px.x() * depth_m / camera.fx, by_px.y() * depth_m / camera.fy, 0.0});
}

/// Along the ray to the station's middle, whose place in the image stays.
void NudgeGizmo::scaleDistance(double factor) {
  displace(Eigen::Vector3d::Zero(), (factor - 1.0) * middleInCamera_m());
}

Eigen::Vector3d NudgeGizmo::middleInCamera_m() const {
  return pose().value_or(Pose()) * nudge_.frame().centre_in_station_m;
}

/// Turns about the station's middle, then moves, along the camera's axes.
void NudgeGizmo::displace(const Eigen::Vector3d& turn_rad, const Eigen::Vector3d& move_m) {
  const std::optional<Pose> from = pose();
  if (!from) return;
  Vector6d displacement;
  displacement << turn_rad, move_m;
  nudge_.moveTo(
      nudged(*from, displacement, {.centre_in_station_m = nudge_.frame().centre_in_station_m}));
}

bool NudgeGizmo::pressKey(const QKeyEvent& event) {
  const double factor = (event.modifiers() & Qt::ShiftModifier) != 0 ? NudgeController::kCoarse
                        : (event.modifiers() & Qt::AltModifier) != 0 ? NudgeController::kFine
                                                                     : 1.0;
  const Eigen::Vector3d way = factor * directionOf(event.key());
  if (!way.isZero()) {
    if ((event.modifiers() & Qt::ControlModifier) != 0)
      displace(nudge_.step().rotation_rad * turnOf(way));
    else if (way.z() != 0.0)
      scaleDistance(std::pow(kWheelFactor, way.z()));
    else
      movePixels({way.x(), way.y()});
    return true;
  }
  switch (event.key()) {
    case Qt::Key_Return:
    case Qt::Key_Enter:
      nudge_.useAsSeed();
      setActive(false);
      return true;
    default:
      return false;
  }
}

bool NudgeGizmo::eventFilter(QObject* watched, QEvent* event) {
  if (CanvasTool::eventFilter(watched, event)) return true;
  if (!active_ || !state_.currentCase()) return false;
  switch (event->type()) {
    case QEvent::Wheel: {
      const auto& wheel = *static_cast<QWheelEvent*>(event);
      if (partAt(wheel.position()) == Part::kNone) return false;
      scaleDistance(std::pow(kWheelFactor, -wheel.angleDelta().y() / 120.0));
      return true;
    }
    case QEvent::ShortcutOverride: {
      const int key = static_cast<QKeyEvent*>(event)->key();
      const bool own = !directionOf(key).isZero() || key == Qt::Key_Return;
      if (own) event->accept();
      return own;
    }
    case QEvent::KeyPress:
      return pressKey(*static_cast<QKeyEvent*>(event));
    default:
      return false;
  }
}

QString NudgeGizmo::offsetText() const {
  const auto& loaded_case = state_.currentCase();
  if (!loaded_case || !pose()) return {};
  if (!loaded_case->source.has_seed) return tr("The case has no seed yet.");
  const NudgeFrame frame = {.centre_in_station_m = nudge_.frame().centre_in_station_m};
  const Vector6d offset =
      nudgeBetween(loaded_case->source.camera_from_station_seed, *pose(), frame);
  const auto millimetres = [&](int axis) { return signedText(1e3 * offset[axis]); };
  const auto degrees = [&](int axis) { return signedText(offset[axis] / kDegree_rad); };
  return tr("From the seed: x %1, y %2, z %3 mm; tilt %4, %5 deg, roll %6 deg.")
      .arg(millimetres(3), millimetres(4), millimetres(5), degrees(0), degrees(1), degrees(2));
}

void NudgeGizmo::paint(QPainter& painter) const {
  if (active_ && state_.currentCase() && !pose())
    paintNote(painter, {kNotesLeft, kNotesTop},
              tr("No seed to move: annotate the case, or paste a pose."));
  const auto middle = active_ ? centre() : std::nullopt;
  if (!middle) return;
  painter.setRenderHint(QPainter::Antialiasing, true);
  painter.setBrush(Qt::NoBrush);
  const QPointF distance = *middle + handleOffset();
  const QPointF tilt = *middle - handleOffset();
  for (const QPen& pen : {haloPen(kGizmoLine), linePen(kGizmoLine)}) {
    painter.setPen(pen);
    painter.drawEllipse(*middle, kRing, kRing);
    for (const QPointF& way :
         {QPointF(1.0, 0.0), QPointF(-1.0, 0.0), QPointF(0.0, 1.0), QPointF(0.0, -1.0)}) {
      const QPointF across(-way.y(), way.x());
      const QPointF tip = *middle + kArrow * way;
      painter.drawLine(*middle + 6.0 * way, tip);
      painter.drawLine(tip, tip - 6.0 * way + 4.0 * across);
      painter.drawLine(tip, tip - 6.0 * way - 4.0 * across);
    }
    painter.drawLine(*middle - QPointF(0.0, kRing), distance + QPointF(0.0, 7.0));
    painter.drawPolygon(diamond(distance, 7.0));
    painter.drawLine(*middle + QPointF(0.0, kRing), tilt - QPointF(0.0, 7.0));
    painter.drawEllipse(tilt, 7.0, 7.0);
  }
  double top = kNotesTop;
  for (const QString& text :
       {offsetText(), tr("Drag: move. Ring: roll. Circle: tilt. Diamond or wheel: distance."),
        tr("Arrows, Page Up, Page Down: move; with Ctrl: turn. Enter: use as seed. Esc: drop.")}) {
    const QSizeF size = noteSize(painter, text);
    paintNote(painter, {0.5 * (view_.width() - size.width()), top}, text);
    top += size.height() + 2.0;
  }
  painter.setRenderHint(QPainter::Antialiasing, false);
}

}  // namespace boresight::ui
