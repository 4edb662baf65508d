// SPDX-License-Identifier: Apache-2.0
#include "ui/panels/pose_panel.h"

#include <QtWidgets>

#include "ui_pose_panel.h"

#include "sessions/session/named_poses.h"
#include "ui/models/number_text.h"
#include "ui/panels/nudge_box.h"
#include "ui/panels/paste_pose_dialog.h"
#include "ui/panels/widgets.h"

namespace boresight::ui {
namespace {

struct FormText {
  sessions::PoseForm form;
  const char* object;
  const char* name;
};
constexpr std::array<FormText, 3> kForms = {{
    {sessions::PoseForm::kRotationVector, "copyRotationVector", QT_TR_NOOP("Rotation vector")},
    {sessions::PoseForm::kQuaternion, "copyQuaternion", QT_TR_NOOP("Quaternion")},
    {sessions::PoseForm::kMatrix, "copyMatrix", QT_TR_NOOP("Matrix")},
}};

/// The rotation beside the translation in metres, row by row.
QString matrixRows(const Pose& pose) {
  const Eigen::Matrix3d rotation = pose.matrix();
  QStringList rows;
  for (int row = 0; row < 3; ++row) {
    QString text;
    for (int column = 0; column < 3; ++column)
      text += QString::number(rotation(row, column), 'f', 6).rightJustified(11);
    rows << text + QString::number(pose.translation_m[row], 'f', 7).rightJustified(14);
  }
  return rows.join(QLatin1Char('\n'));
}

constexpr int kFrame_px = 22;  // of the table, and room for a scroll bar

}  // namespace

PosePanel::PosePanel(ViewState& state, QWidget* parent)
    : QWidget(parent), state_(state), controller_(state), ui_(std::make_unique<Ui::PosePanel>()) {
  ui_->setupUi(this);
  buildTable();
  auto* box = new NudgeBox(controller_, state_, ui_->nudging);
  ui_->nudgingColumn->addWidget(box);
  connect(box, &NudgeBox::useAsSeedRequested, this, &PosePanel::useAsSeedRequested);
  connectAll();
  refresh();
}

/// Destroyed widgets report the focus that they lose to the controller.
PosePanel::~PosePanel() { delete ui_->scroll; }

void PosePanel::buildTable() {
  const QFont fixed = QFontDatabase::systemFont(QFontDatabase::FixedFont);
  ui_->matrix->setFont(fixed);
  ui_->namedPoses->setFont(fixed);
  ui_->poses->setFont(fixed);
  setUpTable(*ui_->poses, model_);
  ui_->poses->setFixedHeight(ui_->poses->verticalHeader()->defaultSectionSize() *
                                 (PoseTableModel::kRowCount + 1) +
                             kFrame_px);
}

void PosePanel::connectAll() {
  for (int i = 0; i < kPoseRoles; ++i)
    ui_->copiedRole->addItem(poseRoleName(static_cast<PoseRole>(i)));
  ui_->copiedRole->setCurrentIndex(static_cast<int>(PoseRole::kEstimate));
  connect(ui_->copiedRole, QOverload<int>::of(&QComboBox::currentIndexChanged), this,
          &PosePanel::showMatrix);
  for (const FormText& form : kForms)
    connect(findChild<QPushButton*>(QLatin1String(form.object)), &QPushButton::clicked, this,
            [this, form] {
              copyPose(static_cast<PoseRole>(ui_->copiedRole->currentIndex()), form.form);
            });
  connect(ui_->pastePose, &QPushButton::clicked, this, &PosePanel::pastePose);
  connect(ui_->poses, &QWidget::customContextMenuRequested, this, &PosePanel::showMenu);
  connect(&controller_, &NudgeController::gestureFinished, this, &PosePanel::gestureFinished);
  state_.onChange(ViewChange::kCase | ViewChange::kSnapshot | ViewChange::kCursor |
                      ViewChange::kNudgedPose | ViewChange::kAnnotatedPose,
                  this, &PosePanel::refresh);
}

void PosePanel::showMatrix() {
  const auto role = static_cast<PoseRole>(ui_->copiedRole->currentIndex());
  const std::optional<Pose>& pose = model_.pose(role);
  ui_->matrix->setText(
      pose ? matrixRows(*pose) + QStringLiteral("\n          0          0          0             1")
           : tr("There is no pose \"%1\".").arg(poseRoleName(role)));
  showNamedPoses(role);
}

void PosePanel::showNamedPoses(PoseRole role) {
  const ViewState::CasePtr& one = state_.currentCase();
  QStringList texts;
  if (one && model_.pose(role))
    for (const sessions::NamedPose& named : sessions::namedPoses(
             one->source.camera_reference, one->source.station_frame, *model_.pose(role)))
      texts << fromText(sessions::namedPoseTitle(named)) + QLatin1Char('\n') +
                   matrixRows(named.reference_from_station);
  ui_->namedPoses->setText(texts.join(QStringLiteral("\n\n")));
  ui_->namedPoses->setVisible(!texts.isEmpty());
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
  const QModelIndex cell = ui_->poses->indexAt(at);
  if (cell.isValid() && cell.column() > 0) {
    addCopyActions(menu, static_cast<PoseRole>(cell.column() - 1));
    menu.addAction(tr("Copy this value"), this,
                   [cell] { QGuiApplication::clipboard()->setText(cell.data().toString()); });
    menu.addSeparator();
  }
  menu.addAction(tr("Paste a pose ..."), this, &PosePanel::pastePose);
  menu.exec(ui_->poses->viewport()->mapToGlobal(at));
}

void PosePanel::setJudgement(const PoseJudgement& judgement) {
  ui_->comparison->setJudgement(judgement);
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
  Poses poses;
  for (int i = 0; i < kPoseRoles; ++i)
    poses[static_cast<std::size_t>(i)] = poseOf(state_, static_cast<PoseRole>(i));
  model_.setPoses(poses);
  for (int i = 0; i < kPoseRoles; ++i) {
    const bool optional = static_cast<PoseRole>(i) != PoseRole::kSeed &&
                          static_cast<PoseRole>(i) != PoseRole::kEstimate;
    ui_->poses->setColumnHidden(1 + i, optional && !poses[static_cast<std::size_t>(i)]);
  }
  ui_->poses->resizeColumnsToContents();
  showMatrix();
  ui_->comparison->setPoses(poses);
  ui_->comparison->setCovariance(shownCovariance(state_));
}

}  // namespace boresight::ui
