// SPDX-License-Identifier: Apache-2.0
#include "ui/panels/run/nudge_box.h"

#include <utility>

#include <QtWidgets>

#include "core/base/math.h"
#include "sessions/text/units.h"
#include "ui/views/view_transform.h"
#include "ui/widgets/widgets.h"

namespace boresight::ui {
namespace {

using sessions::kMillimetres;

/// From the controller's units (rad, m) to the shown ones (deg, mm).
double shownUnit(int axis) { return axis < 3 ? 1.0 / kDegree_rad : kMillimetres; }

Eigen::Vector3d pivotInCamera_m(const Pose& camera_from_station, const NudgeFrame& frame) {
  if (frame.pivot == NudgePivot::kCameraCentre) return Eigen::Vector3d::Zero();
  return camera_from_station * frame.centre_in_station_m;
}

/// Turns both halves of an offset by a rotation: rotation vectors turn as vectors do.
Vector6d turned(const Eigen::Quaterniond& rotation, const Vector6d& offset) {
  Vector6d result;
  result.head<3>() = rotation * offset.head<3>();
  result.tail<3>() = rotation * offset.tail<3>();
  return result;
}

}  // namespace

Pose nudged(const Pose& camera_from_station, const Vector6d& offset, const NudgeFrame& frame) {
  const bool own = frame.axes == NudgeAxes::kStation;
  return displacedAboutPivot(camera_from_station,
                             own ? turned(camera_from_station.rotation, offset) : offset,
                             pivotInCamera_m(camera_from_station, frame));
}

Vector6d nudgeBetween(const Pose& camera_from_station_base, const Pose& camera_from_station,
                      const NudgeFrame& frame) {
  const Vector6d offset = offsetAboutPivot(camera_from_station_base, camera_from_station,
                                           pivotInCamera_m(camera_from_station_base, frame));
  const bool own = frame.axes == NudgeAxes::kStation;
  return own ? turned(camera_from_station_base.rotation.conjugate(), offset) : offset;
}

Eigen::Vector3d directionOf(int key) {
  const QPointF arrow = arrowOf(key);
  return {arrow.x(), arrow.y(),
          static_cast<double>((key == Qt::Key_PageUp) - (key == Qt::Key_PageDown))};
}

Eigen::Vector3d turnOf(const Eigen::Vector3d& direction) {
  return {direction.y(), -direction.x(), direction.z()};
}

NudgeController::NudgeController(ViewState& state) : state_(state) {
  pause_.setSingleShot(true);
  pause_.setInterval(kPause_ms);
  connect(&pause_, &QTimer::timeout, this, &NudgeController::finishGesture);
  connect(&state_, &ViewState::aboutToSetCase, this, &NudgeController::finishGesture);
  state_.onChange(ViewChange::kCase, this, &NudgeController::caseChanged);
  state_.onChange(ViewChange::kNudgedPose, this, &NudgeController::stateChanged);
  state_.onChange(ViewChange::kCursor | ViewChange::kAnnotatedPose, this,
                  &NudgeController::changed);
  caseChanged();
}

void NudgeController::caseChanged() {
  before_.reset();
  pause_.stop();
  base_.reset();
  if (state_.currentCase())
    frame_.centre_in_station_m = matchedBounds(state_.currentCase()->scene.view()).centre();
  Q_EMIT changed();
}

/// Undo or a pasted pose may have nudged.
void NudgeController::stateChanged() {
  if (!state_.nudgedPose())
    base_.reset();
  else if (!base_)
    base_ = estimate();
  Q_EMIT changed();
}

void NudgeController::setAxes(NudgeAxes axes) {
  finishGesture();
  frame_.axes = axes;
  Q_EMIT changed();
}

void NudgeController::setPivot(NudgePivot pivot) {
  finishGesture();
  frame_.pivot = pivot;
  Q_EMIT changed();
}

/// The pose that the views would show without nudging.
Pose NudgeController::estimate() const {
  for (const PoseRole role : {PoseRole::kEstimate, PoseRole::kSeed, PoseRole::kAnnotated})
    if (const auto pose = poseOf(state_, role)) return *pose;
  return Pose();
}

Vector6d NudgeController::offset() const {
  if (!state_.nudgedPose()) return Vector6d::Zero();
  return nudgeBetween(base(), *state_.nudgedPose(), frame_);
}

void NudgeController::moveTo(const Pose& camera_from_station) {
  if (!state_.currentCase() || !camera_from_station.isFinite()) return;
  if (!base_) base_ = estimate();
  if (!before_) {
    before_ = state_.shownPose();
    nudged_before_ = state_.nudgedPose();
  }
  pause_.start();
  state_.setNudgedPose(camera_from_station);
}

void NudgeController::setOffset(int axis, double value) {
  if (!state_.knownPose()) return;
  Vector6d next = offset();
  next[axis] = value;
  moveTo(nudged(base(), next, frame_));
}

void NudgeController::setPose(const Pose& camera_from_station) {
  finishGesture();
  moveTo(camera_from_station);
  finishGesture();
}

void NudgeController::backToEstimate() {
  if (!state_.nudgedPose()) return;
  finishGesture();
  base_ = estimate();
  setPose(estimate());
}

void NudgeController::drop() {
  if (!state_.nudgedPose()) return;
  finishGesture();
  const Pose before = *state_.nudgedPose();
  state_.setNudgedPose(std::nullopt);
  Q_EMIT gestureFinished(before, state_.shownPose());
}

void NudgeController::useAsSeed() {
  finishGesture();
  if (state_.nudgedPose()) Q_EMIT useAsSeedRequested(*state_.nudgedPose());
}

void NudgeController::finishGesture() {
  pause_.stop();
  if (!before_) return;
  const Pose before = *before_;
  before_.reset();
  const Pose after = state_.shownPose();
  if (!(before == after)) Q_EMIT gestureFinished(before, after);
}

void NudgeController::cancelGesture() {
  pause_.stop();
  if (std::exchange(before_, std::nullopt)) state_.setNudgedPose(nudged_before_);
}

bool NudgeController::eventFilter(QObject* watched, QEvent* event) {
  const QEvent::Type type = event->type();
  if (type == QEvent::FocusOut) finishGesture();
  const bool is_key =
      type == QEvent::KeyPress || type == QEvent::KeyRelease || type == QEvent::ShortcutOverride;
  if (!is_key || !state_.currentCase()) return QObject::eventFilter(watched, event);
  const auto& key = static_cast<const QKeyEvent&>(*event);
  const Eigen::Vector3d direction = directionOf(key.key());
  if (direction.isZero() || !state_.knownPose()) return QObject::eventFilter(watched, event);
  if (type == QEvent::ShortcutOverride) {
    event->accept();
    return false;
  }
  if (type == QEvent::KeyRelease) {
    if (!key.isAutoRepeat()) finishGesture();
    return true;
  }
  const Qt::KeyboardModifiers modifiers = key.modifiers();
  double factor = 1.0;
  if (modifiers.testFlag(Qt::ShiftModifier)) factor *= kCoarse;
  if (modifiers.testFlag(Qt::AltModifier)) factor *= kFine;
  Vector6d steps = Vector6d::Zero();
  if (modifiers.testFlag(Qt::ControlModifier))
    steps.head<3>() = factor * step_.rotation_rad * turnOf(direction);
  else
    steps.tail<3>() = factor * step_.translation_m * direction;
  moveTo(nudged(state_.shownPose(), steps, frame_));
  // A key that repeats holds the gesture open until it is let go.
  pause_.stop();
  return true;
}

NudgeBox::NudgeBox(NudgeController& controller, ViewState& state)
    : controller_(controller), state_(state) {
  ui_.setupUi(this);
  values_ = {ui_.turnX, ui_.turnY, ui_.turnZ, ui_.moveX, ui_.moveY, ui_.moveZ};
  for (int axis = 0; axis < 6; ++axis) {
    QDoubleSpinBox* box = values_[static_cast<std::size_t>(axis)];
    box->installEventFilter(this);
    connect(box, QOverload<double>::of(&QDoubleSpinBox::valueChanged), this,
            [this, axis](double value) { controller_.setOffset(axis, value / shownUnit(axis)); });
    connect(box, &QDoubleSpinBox::editingFinished, &controller_, &NudgeController::finishGesture);
  }
  connectSettings();
  ui_.nudgePad->installEventFilter(&controller_);
  ui_.nudgePad->installEventFilter(this);
  connect(&controller_, &NudgeController::changed, this, &NudgeBox::showOffset);
  state_.onChange(ViewChange::kCase, this, &NudgeBox::showOffset);
  showOffset();
}

void NudgeBox::connectSettings() {
  connect(ui_.axes, kIndexChanged, this,
          [this](int index) { controller_.setAxes(static_cast<NudgeAxes>(index)); });
  connect(ui_.pivot, kIndexChanged, this,
          [this](int index) { controller_.setPivot(static_cast<NudgePivot>(index)); });
  ui_.moveStep->setValue(kMillimetres * controller_.step().translation_m);
  ui_.turnStep->setValue(controller_.step().rotation_rad / kDegree_rad);
  for (QDoubleSpinBox* box : {ui_.moveStep, ui_.turnStep})
    connect(box, QOverload<double>::of(&QDoubleSpinBox::valueChanged), this, &NudgeBox::takeStep);
  connect(ui_.useAsSeed, &QPushButton::clicked, &controller_, &NudgeController::useAsSeed);
  connect(ui_.backToEstimate, &QPushButton::clicked, &controller_,
          &NudgeController::backToEstimate);
  connect(ui_.dropNudged, &QPushButton::clicked, &controller_, &NudgeController::drop);
}

void NudgeBox::takeStep() {
  controller_.setStep({ui_.moveStep->value() / kMillimetres, ui_.turnStep->value() * kDegree_rad});
  for (int axis = 0; axis < 6; ++axis)
    values_[static_cast<std::size_t>(axis)]->setSingleStep(axis < 3 ? ui_.turnStep->value()
                                                                    : ui_.moveStep->value());
}

void NudgeBox::showOffset() {
  const Vector6d offset = controller_.offset();
  const bool has_start = state_.knownPose().has_value();
  for (int axis = 0; axis < 6; ++axis) {
    QDoubleSpinBox* box = values_[static_cast<std::size_t>(axis)];
    const QSignalBlocker blocker(box);
    box->setValue(offset[axis] * shownUnit(axis));
    box->setEnabled(has_start);
  }
  const bool nudged = state_.nudgedPose().has_value();
  for (QPushButton* button : {ui_.useAsSeed, ui_.backToEstimate, ui_.dropNudged})
    button->setEnabled(nudged);
  ui_.nudgePad->setEnabled(has_start);
  ui_.nudgePad->setText(
      ui_.nudgePad->hasFocus()
          ? tr("<b>Keys nudge.</b> Arrows, Page Up, Page Down: move; with Ctrl: turn. Shift: "
               "coarse, Alt: fine.")
          : tr("Click here to nudge with the keys: arrows, Page Up, Page Down; Ctrl, "
               "Shift, Alt."));
}

bool NudgeBox::eventFilter(QObject* watched, QEvent* event) {
  const QEvent::Type type = event->type();
  if (watched == ui_.nudgePad) {
    if (type == QEvent::FocusIn || type == QEvent::FocusOut)
      QMetaObject::invokeMethod(this, &NudgeBox::showOffset, Qt::QueuedConnection);
  } else if (type == QEvent::MouseButtonRelease || type == QEvent::FocusOut) {
    // After the box itself: its last step still belongs to the gesture.
    QMetaObject::invokeMethod(&controller_, &NudgeController::finishGesture, Qt::QueuedConnection);
  }
  return QWidget::eventFilter(watched, event);
}

}  // namespace boresight::ui
