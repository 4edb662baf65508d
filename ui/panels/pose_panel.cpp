// SPDX-License-Identifier: Apache-2.0
#include "ui/panels/pose_panel.h"

#include <QClipboard>
#include <QComboBox>
#include <QFontDatabase>
#include <QGroupBox>
#include <QGuiApplication>
#include <QHBoxLayout>
#include <QHeaderView>
#include <QLabel>
#include <QMenu>
#include <QPushButton>
#include <QScrollArea>
#include <QTableView>
#include <QVBoxLayout>

#include "ui/panels/nudge_box.h"
#include "ui/panels/paste_pose_dialog.h"

namespace boresight::ui {
namespace {

struct FormText {
  sessions::PoseForm form;
  const char* object;
  const char* name;
};
constexpr std::array<FormText, 3> kForms = {{
    {sessions::PoseForm::kRotationVector, "copyRotationVector",
     QT_TRANSLATE_NOOP("boresight::ui::PosePanel", "Rotation vector")},
    {sessions::PoseForm::kQuaternion, "copyQuaternion",
     QT_TRANSLATE_NOOP("boresight::ui::PosePanel", "Quaternion")},
    {sessions::PoseForm::kMatrix, "copyMatrix",
     QT_TRANSLATE_NOOP("boresight::ui::PosePanel", "Matrix")},
}};

}  // namespace

PosePanel::PosePanel(ViewState& state, QWidget* parent)
    : QWidget(parent), state_(state), controller_(state) {
  auto* outer = new QVBoxLayout(this);
  outer->setContentsMargins(0, 0, 0, 0);
  auto* scroll = new QScrollArea(this);
  scroll->setWidgetResizable(true);
  scroll->setFrameShape(QFrame::NoFrame);
  outer->addWidget(scroll);
  page_ = scroll;
  auto* page = new QWidget(scroll);
  auto* layout = new QVBoxLayout(page);
  layout->setContentsMargins(6, 6, 6, 6);

  auto* direction = new QLabel(tr("camera_from_station: p_camera = R p_station + t"), page);
  direction->setToolTip(
      tr("Every pose here maps points of the station into the camera frame (x "
         "right, y down, z forward)."));
  layout->addWidget(direction);
  layout->addWidget(buildTable());
  layout->addWidget(buildCopyBar());
  auto* nudging = new QGroupBox(tr("Nudge"), page);
  auto* nudging_layout = new QVBoxLayout(nudging);
  auto* box = new NudgeBox(controller_, state_, nudging);
  nudging_layout->addWidget(box);
  layout->addWidget(nudging);
  comparison_ = new PoseComparison(page);
  layout->addWidget(comparison_);
  layout->addStretch(1);
  scroll->setWidget(page);

  connect(box, &NudgeBox::useAsSeedRequested, this, &PosePanel::useAsSeedRequested);
  connect(&controller_, &NudgeController::gestureFinished, this, &PosePanel::gestureFinished);
  for (auto signal : {&ViewState::caseChanged, &ViewState::snapshotChanged,
                      &ViewState::cursorChanged, &ViewState::nudgedPoseChanged})
    connect(&state_, signal, this, &PosePanel::refresh);
  refresh();
}

/// Widgets that go tell the controller of the focus they lose.
PosePanel::~PosePanel() { delete page_; }

QWidget* PosePanel::buildTable() {
  table_ = new QTableView(this);
  table_->setObjectName(QStringLiteral("poses"));
  table_->setModel(&model_);
  table_->setAlternatingRowColors(true);
  table_->setWordWrap(false);
  table_->setTabKeyNavigation(false);
  table_->setFont(QFontDatabase::systemFont(QFontDatabase::FixedFont));
  table_->setContextMenuPolicy(Qt::CustomContextMenu);
  table_->setHorizontalScrollMode(QAbstractItemView::ScrollPerPixel);
  table_->verticalHeader()->setFont(font());
  table_->horizontalHeader()->setFont(font());
  const int row = table_->fontMetrics().height() + 5;
  table_->verticalHeader()->setMinimumSectionSize(row);
  table_->verticalHeader()->setDefaultSectionSize(row);
  table_->setMinimumHeight(row * 9);
  table_->setSizePolicy(QSizePolicy::Expanding, QSizePolicy::Preferred);
  connect(table_, &QWidget::customContextMenuRequested, this, &PosePanel::showMenu);
  return table_;
}

QWidget* PosePanel::buildCopyBar() {
  auto* bar = new QWidget(this);
  auto* layout = new QHBoxLayout(bar);
  layout->setContentsMargins(0, 0, 0, 0);
  layout->addWidget(new QLabel(tr("Copy"), bar));
  copied_ = new QComboBox(bar);
  copied_->setObjectName(QStringLiteral("copiedRole"));
  copied_->setToolTip(tr("Which pose is copied"));
  for (int i = 0; i < kPoseRoles; ++i) copied_->addItem(poseRoleName(static_cast<PoseRole>(i)));
  copied_->setCurrentIndex(static_cast<int>(PoseRole::kEstimate));
  layout->addWidget(copied_);
  for (const FormText& form : kForms) {
    auto* button = new QPushButton(tr(form.name), bar);
    button->setObjectName(QString::fromUtf8(form.object));
    button->setToolTip(tr("Copy the pose in this form, with its direction, order and units"));
    connect(button, &QPushButton::clicked, this,
            [this, form] { copyPose(static_cast<PoseRole>(copied_->currentIndex()), form.form); });
    layout->addWidget(button);
  }
  layout->addStretch(1);
  auto* paste = new QPushButton(tr("Paste ..."), bar);
  paste->setObjectName(QStringLiteral("pastePose"));
  paste->setToolTip(tr("Nudge to a pose from the clipboard; order, direction and unit are asked"));
  connect(paste, &QPushButton::clicked, this, &PosePanel::pastePose);
  layout->addWidget(paste);
  return bar;
}

void PosePanel::addCopyActions(QMenu& menu, PoseRole role) {
  for (const FormText& form : kForms) {
    QAction* action =
        menu.addAction(tr("Copy %1 as %2").arg(poseRoleName(role), tr(form.name).toLower()), this,
                       [this, role, form] { copyPose(role, form.form); });
    action->setEnabled(model_.pose(role).has_value());
  }
}

void PosePanel::showMenu(const QPoint& at) {
  QMenu menu(this);
  const QModelIndex cell = table_->indexAt(at);
  if (cell.isValid()) {
    addCopyActions(menu, static_cast<PoseRole>(cell.column()));
    menu.addAction(tr("Copy this value"), this,
                   [cell] { QGuiApplication::clipboard()->setText(cell.data().toString()); });
    menu.addSeparator();
  }
  menu.addAction(tr("Paste a pose ..."), this, &PosePanel::pastePose);
  menu.exec(table_->viewport()->mapToGlobal(at));
}

void PosePanel::setJudgement(const PoseJudgement& judgement) {
  comparison_->setJudgement(judgement);
}

void PosePanel::copyPose(PoseRole role, sessions::PoseForm form) {
  const std::optional<Pose>& pose = model_.pose(role);
  if (!pose) return;
  QGuiApplication::clipboard()->setText(QString::fromStdString(sessions::poseText(*pose, form)));
}

void PosePanel::pastePose() {
  if (!state_.currentCase()) return;
  PastePoseDialog dialog(QGuiApplication::clipboard()->text(), this);
  if (dialog.exec() == QDialog::Accepted && dialog.parsed().valid)
    controller_.setPose(dialog.parsed().camera_from_station);
}

void PosePanel::refresh() {
  std::array<std::optional<Pose>, kPoseRoles> poses;
  for (int i = 0; i < kPoseRoles; ++i)
    poses[static_cast<std::size_t>(i)] = poseOf(state_, static_cast<PoseRole>(i));
  model_.setPoses(poses);
  table_->resizeColumnsToContents();
  comparison_->setPoses(poses);
  comparison_->setCovariance(shownCovariance(state_));
}

}  // namespace boresight::ui
