// SPDX-License-Identifier: Apache-2.0
#include "ui/panels/nudge_box.h"

#include <QtWidgets>

#include "core/base/math.h"
#include "ui/panels/widgets.h"

namespace boresight::ui {
namespace {

constexpr double kMillimetres = 1e3;

/// From what the controller counts in (rad, m) to what people read (deg, mm).
double shownUnit(int axis) { return axis < 3 ? 1.0 / kDegree_rad : kMillimetres; }

QDoubleSpinBox* spinBox(QWidget* parent, double least, double most, int decimals, double step,
                        const QString& suffix) {
  auto* box = new QDoubleSpinBox(parent);
  box->setRange(least, most);
  box->setDecimals(decimals);
  box->setSingleStep(step);
  box->setSuffix(suffix);
  box->setAlignment(Qt::AlignRight);
  box->setKeyboardTracking(false);  // half-typed numbers move nothing
  return box;
}

}  // namespace

NudgeBox::NudgeBox(NudgeController& controller, ViewState& state, QWidget* parent)
    : QWidget(parent), controller_(controller), state_(state) {
  auto* layout = new QVBoxLayout(this);
  layout->setContentsMargins(0, 0, 0, 0);
  auto* grid = new QGridLayout;
  addValues(*grid);
  addFrame(*grid);
  addSteps(*grid);
  layout->addLayout(grid);

  pad_ = named(new QLabel(this), "nudgePad");
  pad_->setFocusPolicy(Qt::StrongFocus);
  pad_->setFrameShape(QFrame::StyledPanel);
  pad_->setWordWrap(true);
  pad_->setMargin(6);
  pad_->setAccessibleName(tr("Field that takes the keys for nudging"));
  pad_->installEventFilter(&controller_);
  pad_->installEventFilter(this);
  layout->addWidget(pad_);
  layout->addWidget(buildButtons());
  connect(&controller_, &NudgeController::changed, this, &NudgeBox::showOffset);
  state_.onChange(ViewChange::kCase, this, &NudgeBox::showOffset);
  showOffset();
}

void NudgeBox::addValues(QGridLayout& grid) {
  const std::array<QString, 6> names = {tr("turn x"), tr("turn y"), tr("turn z"),
                                        tr("move x"), tr("move y"), tr("move z")};
  constexpr std::array<const char*, 6> kNames = {"turnX", "turnY", "turnZ",
                                                 "moveX", "moveY", "moveZ"};
  for (int axis = 0; axis < 6; ++axis) {
    const auto i = static_cast<std::size_t>(axis);
    values_[i] = axis < 3 ? spinBox(this, -180.0, 180.0, 4, 0.2, tr(" deg"))
                          : spinBox(this, -1e6, 1e6, 4, 1.0, tr(" mm"));
    values_[i]->setObjectName(QString::fromUtf8(kNames[i]));
    values_[i]->setAccessibleName(names[i]);
    values_[i]->setToolTip(
        axis < 3 ? tr("Component of the rotation vector from where nudging began, deg")
                 : tr("How far the pivot has moved from where nudging began, mm"));
    values_[i]->installEventFilter(this);
    connect(values_[i], QOverload<double>::of(&QDoubleSpinBox::valueChanged), this,
            [this, axis](double value) { controller_.setOffset(axis, value / shownUnit(axis)); });
    connect(values_[i], &QDoubleSpinBox::editingFinished, &controller_,
            &NudgeController::finishGesture);
    const int column = axis < 3 ? 2 : 0;  // moves on the left, turns on the right
    grid.addWidget(new QLabel(names[i], this), axis % 3, column);
    grid.addWidget(values_[i], axis % 3, column + 1);
  }
}

void NudgeBox::addFrame(QGridLayout& grid) {
  axes_ = named(new QComboBox(this), "axes");
  axes_->addItems({tr("camera axes"), tr("station axes")});
  axes_->setToolTip(
      tr("Along and about whose axes values and keys are meant. Camera: x right, y "
         "down, z forward."));
  connect(axes_, QOverload<int>::of(&QComboBox::currentIndexChanged), this,
          [this](int index) { controller_.setAxes(static_cast<NudgeAxes>(index)); });
  pivot_ = named(new QComboBox(this), "pivot");
  pivot_->addItems({tr("about the station's centre"), tr("about the camera")});
  pivot_->setToolTip(tr("What stays where it is when the pose is turned"));
  connect(pivot_, QOverload<int>::of(&QComboBox::currentIndexChanged), this,
          [this](int index) { controller_.setPivot(static_cast<NudgePivot>(index)); });
  grid.addWidget(axes_, 3, 0, 1, 2);
  grid.addWidget(pivot_, 3, 2, 1, 2);
}

void NudgeBox::addSteps(QGridLayout& grid) {
  const NudgeStep& step = controller_.step();
  translation_step_ = spinBox(this, 1e-4, 1000.0, 4, 0.1, tr(" mm"));
  translation_step_->setObjectName(QStringLiteral("moveStep"));
  translation_step_->setValue(kMillimetres * step.translation_m);
  rotation_step_ = spinBox(this, 1e-4, 45.0, 4, 0.1, tr(" deg"));
  rotation_step_->setObjectName(QStringLiteral("turnStep"));
  rotation_step_->setValue(step.rotation_rad / kDegree_rad);
  for (QDoubleSpinBox* box : {translation_step_, rotation_step_}) {
    box->setToolTip(
        tr("One press of a key or of an arrow; with Shift ten times as much, with Alt "
           "a tenth"));
    connect(box, QOverload<double>::of(&QDoubleSpinBox::valueChanged), this, &NudgeBox::takeStep);
  }
  grid.addWidget(new QLabel(tr("step"), this), 4, 0);
  grid.addWidget(translation_step_, 4, 1);
  grid.addWidget(new QLabel(tr("step"), this), 4, 2);
  grid.addWidget(rotation_step_, 4, 3);
  grid.setColumnStretch(1, 1);
  grid.setColumnStretch(3, 1);
}

QWidget* NudgeBox::buildButtons() {
  auto* buttons = new QWidget(this);
  auto* layout = new QHBoxLayout(buttons);
  layout->setContentsMargins(0, 0, 0, 0);
  const auto add = [&](const QString& text, const char* name, const QString& help) {
    auto* button = new QPushButton(text, buttons);
    button->setObjectName(QString::fromUtf8(name));
    button->setToolTip(help);
    layout->addWidget(button);
    return button;
  };
  use_ = add(tr("Use as seed"), "useAsSeed", tr("The next run begins from the nudged pose"));
  back_ = add(tr("Back to the estimate"), "backToEstimate",
              tr("Move the nudged pose to the iteration that is shown (without one, to the seed)"));
  drop_ = add(tr("Drop"), "dropNudged", tr("Forget the nudged pose and show the run again"));
  connect(use_, &QPushButton::clicked, this, [this] {
    controller_.finishGesture();
    if (state_.nudgedPose()) Q_EMIT useAsSeedRequested(*state_.nudgedPose());
  });
  connect(back_, &QPushButton::clicked, &controller_, &NudgeController::backToEstimate);
  connect(drop_, &QPushButton::clicked, &controller_, &NudgeController::drop);
  return buttons;
}

void NudgeBox::takeStep() {
  controller_.setStep(
      {translation_step_->value() / kMillimetres, rotation_step_->value() * kDegree_rad});
  for (int axis = 0; axis < 6; ++axis)
    values_[static_cast<std::size_t>(axis)]->setSingleStep(axis < 3 ? rotation_step_->value()
                                                                    : translation_step_->value());
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
  for (QPushButton* button : {use_, back_, drop_}) button->setEnabled(nudged);
  pad_->setEnabled(state_.currentCase() != nullptr);
  pad_->setText(
      pad_->hasFocus()
          ? tr("<b>Keys nudge now.</b> Arrows, Page Up and Page Down move; with Ctrl they "
               "turn. Shift: coarse, Alt: fine.")
          : tr("Click here to nudge with the keys: arrows, Page Up, Page Down; Ctrl, "
               "Shift, Alt."));
}

bool NudgeBox::eventFilter(QObject* watched, QEvent* event) {
  const QEvent::Type type = event->type();
  if (watched == pad_) {
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
