// SPDX-License-Identifier: Apache-2.0
#include "ui/panels/nudge_box.h"

#include <QtWidgets>

#include "ui_nudge_box.h"

#include "core/base/math.h"

namespace boresight::ui {
namespace {

constexpr double kMillimetres = 1e3;

/// From what the controller counts in (rad, m) to what people read (deg, mm).
double shownUnit(int axis) { return axis < 3 ? 1.0 / kDegree_rad : kMillimetres; }

}  // namespace

NudgeBox::NudgeBox(NudgeController& controller, ViewState& state, QWidget* parent)
    : QWidget(parent),
      controller_(controller),
      state_(state),
      ui_(std::make_unique<Ui::NudgeBox>()) {
  ui_->setupUi(this);
  values_ = {ui_->turnX, ui_->turnY, ui_->turnZ, ui_->moveX, ui_->moveY, ui_->moveZ};
  connectValues();
  connectSettings();
  ui_->nudgePad->installEventFilter(&controller_);
  ui_->nudgePad->installEventFilter(this);
  connect(&controller_, &NudgeController::changed, this, &NudgeBox::showOffset);
  state_.onChange(ViewChange::kCase, this, &NudgeBox::showOffset);
  showOffset();
}

NudgeBox::~NudgeBox() = default;

void NudgeBox::connectValues() {
  for (int axis = 0; axis < 6; ++axis) {
    QDoubleSpinBox* box = values_[static_cast<std::size_t>(axis)];
    box->installEventFilter(this);
    connect(box, QOverload<double>::of(&QDoubleSpinBox::valueChanged), this,
            [this, axis](double value) { controller_.setOffset(axis, value / shownUnit(axis)); });
    connect(box, &QDoubleSpinBox::editingFinished, &controller_, &NudgeController::finishGesture);
  }
}

void NudgeBox::connectSettings() {
  connect(ui_->axes, QOverload<int>::of(&QComboBox::currentIndexChanged), this,
          [this](int index) { controller_.setAxes(static_cast<NudgeAxes>(index)); });
  connect(ui_->pivot, QOverload<int>::of(&QComboBox::currentIndexChanged), this,
          [this](int index) { controller_.setPivot(static_cast<NudgePivot>(index)); });
  ui_->moveStep->setValue(kMillimetres * controller_.step().translation_m);
  ui_->turnStep->setValue(controller_.step().rotation_rad / kDegree_rad);
  for (QDoubleSpinBox* box : {ui_->moveStep, ui_->turnStep})
    connect(box, QOverload<double>::of(&QDoubleSpinBox::valueChanged), this, &NudgeBox::takeStep);
  connect(ui_->useAsSeed, &QPushButton::clicked, this, [this] {
    controller_.finishGesture();
    if (state_.nudgedPose()) Q_EMIT useAsSeedRequested(*state_.nudgedPose());
  });
  connect(ui_->backToEstimate, &QPushButton::clicked, &controller_,
          &NudgeController::backToEstimate);
  connect(ui_->dropNudged, &QPushButton::clicked, &controller_, &NudgeController::drop);
}

void NudgeBox::takeStep() {
  controller_.setStep(
      {ui_->moveStep->value() / kMillimetres, ui_->turnStep->value() * kDegree_rad});
  for (int axis = 0; axis < 6; ++axis)
    values_[static_cast<std::size_t>(axis)]->setSingleStep(axis < 3 ? ui_->turnStep->value()
                                                                    : ui_->moveStep->value());
}

void NudgeBox::showOffset() {
  const Vector6d offset = controller_.offset();
  for (int axis = 0; axis < 6; ++axis) {
    QDoubleSpinBox* box = values_[static_cast<std::size_t>(axis)];
    const QSignalBlocker blocker(box);
    box->setValue(offset[axis] * shownUnit(axis));
    box->setEnabled(state_.currentCase() != nullptr);
  }
  const bool nudged = state_.nudgedPose().has_value();
  for (QPushButton* button : {ui_->useAsSeed, ui_->backToEstimate, ui_->dropNudged})
    button->setEnabled(nudged);
  ui_->nudgePad->setEnabled(state_.currentCase() != nullptr);
  ui_->nudgePad->setText(
      ui_->nudgePad->hasFocus()
          ? tr("<b>Keys nudge now.</b> Arrows, Page Up and Page Down move; with Ctrl they "
               "turn. Shift: coarse, Alt: fine.")
          : tr("Click here to nudge with the keys: arrows, Page Up, Page Down; Ctrl, "
               "Shift, Alt."));
}

bool NudgeBox::eventFilter(QObject* watched, QEvent* event) {
  const QEvent::Type type = event->type();
  if (watched == ui_->nudgePad) {
    if (type == QEvent::FocusIn || type == QEvent::FocusOut)
      QMetaObject::invokeMethod(
          this, [this] { showOffset(); }, Qt::QueuedConnection);
  } else if (type == QEvent::MouseButtonRelease || type == QEvent::FocusOut) {
    // After the box itself: its last step still belongs to the gesture.
    QMetaObject::invokeMethod(
        this, [this] { controller_.finishGesture(); }, Qt::QueuedConnection);
  } else if (type == QEvent::Wheel && !static_cast<QWidget*>(watched)->hasFocus()) {
    event->ignore();  // scrolling past must not move the pose
    return true;
  }
  return QWidget::eventFilter(watched, event);
}

}  // namespace boresight::ui
