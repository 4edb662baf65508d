// SPDX-License-Identifier: Apache-2.0
#include "ui/panels/pose_panel.h"

#include <QtWidgets>

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

/// Numbers of one row of a matrix, each right-aligned in its column.
QString aligned(const QString& row) {
  QString line;
  for (const QString& number : row.split(QStringLiteral("  "))) line += number.rightJustified(11);
  return line;
}

/// Of a translation of many metres as of a rotation: six decimals.
QString matrixRows(const Pose& pose) {
  const Eigen::Matrix3d rotation = pose.matrix();
  QString text;
  for (int row = 0; row < 3; ++row) {
    text += QLatin1Char('\n');
    for (int column = 0; column < 3; ++column)
      text += QString::number(rotation(row, column), 'f', 6).rightJustified(10);
    text += QString::number(pose.translation_m[row], 'f', 6).rightJustified(13);
  }
  return text;
}

constexpr int kFrame_px = 22;  // of the table, and room for a scroll bar

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
  state_.onChange(ViewChange::kCase | ViewChange::kSnapshot | ViewChange::kCursor |
                      ViewChange::kNudgedPose | ViewChange::kAnnotatedPose,
                  this, &PosePanel::refresh);
  refresh();
}

/// Widgets that go tell the controller of the focus they lose.
PosePanel::~PosePanel() { delete page_; }

QWidget* PosePanel::buildTable() {
  table_ = named(new QTableView(this), "poses");
  table_->setModel(&model_);
  table_->setAlternatingRowColors(true);
  table_->setWordWrap(false);
  table_->setTabKeyNavigation(false);
  table_->setFont(QFontDatabase::systemFont(QFontDatabase::FixedFont));
  table_->setContextMenuPolicy(Qt::CustomContextMenu);
  table_->setHorizontalScrollMode(QAbstractItemView::ScrollPerPixel);
  QFont heads = font();
  heads.setFamily(heads.family());  // stated, or the heads would take the table's
  table_->verticalHeader()->setFont(heads);
  table_->horizontalHeader()->setFont(heads);
  // Its rows are too wide to stand side by side; one matrix is shown below.
  for (int row = PoseTableModel::kMatrixRow1; row <= PoseTableModel::kMatrixRow4; ++row)
    table_->setRowHidden(row, true);
  const int row = table_->fontMetrics().height() + 5;
  table_->verticalHeader()->setMinimumSectionSize(row);
  table_->verticalHeader()->setDefaultSectionSize(row);
  table_->setSizeAdjustPolicy(QAbstractScrollArea::AdjustToContents);
  table_->setVerticalScrollBarPolicy(Qt::ScrollBarAlwaysOff);
  table_->setFixedHeight(row * (PoseTableModel::kMatrixRow1 + 1) + kFrame_px);
  table_->setSizePolicy(QSizePolicy::Expanding, QSizePolicy::Fixed);
  connect(table_, &QWidget::customContextMenuRequested, this, &PosePanel::showMenu);
  return table_;
}

QWidget* PosePanel::buildCopyBar() {
  auto* bar = new QWidget(this);
  auto* column = new QVBoxLayout(bar);
  column->setContentsMargins(0, 0, 0, 0);
  auto* chooser = new QHBoxLayout;
  auto* layout = new QHBoxLayout;
  column->addLayout(chooser);
  matrix_ = named(new QLabel(bar), "matrix");
  matrix_->setFont(QFontDatabase::systemFont(QFontDatabase::FixedFont));
  matrix_->setTextInteractionFlags(Qt::TextSelectableByMouse | Qt::TextSelectableByKeyboard);
  matrix_->setToolTip(
      tr("camera_from_station as a 4x4 matrix, row by row; its last column is in metres"));
  column->addWidget(matrix_);
  named_ = named(new QLabel(bar), "namedPoses");
  named_->setFont(matrix_->font());
  named_->setTextInteractionFlags(matrix_->textInteractionFlags());
  named_->setToolTip(tr("The same pose in the frames that camera model and seed were given in"));
  column->addWidget(named_);
  column->addLayout(layout);
  layout->addWidget(new QLabel(tr("Copy as"), bar));
  chooser->addWidget(new QLabel(tr("Matrix of"), bar));
  copied_ =
      named(new QComboBox(bar), "copiedRole", tr("Which pose is shown as a matrix, and copied"));
  for (int i = 0; i < kPoseRoles; ++i) copied_->addItem(poseRoleName(static_cast<PoseRole>(i)));
  copied_->setCurrentIndex(static_cast<int>(PoseRole::kEstimate));
  chooser->addWidget(copied_);
  chooser->addStretch(1);
  connect(copied_, QOverload<int>::of(&QComboBox::currentIndexChanged), this,
          &PosePanel::showMatrix);
  for (const FormText& form : kForms) {
    auto* button = new QPushButton(tr(form.name), bar);
    button->setObjectName(QString::fromUtf8(form.object));
    button->setToolTip(tr("Copy the pose in this form, with its direction, order and units"));
    connect(button, &QPushButton::clicked, this,
            [this, form] { copyPose(static_cast<PoseRole>(copied_->currentIndex()), form.form); });
    layout->addWidget(button);
  }
  layout->addStretch(1);
  auto* paste = named(new QPushButton(tr("Paste ..."), bar), "pastePose");
  paste->setToolTip(tr("Nudge to a pose from the clipboard; order, direction and unit are asked"));
  connect(paste, &QPushButton::clicked, this, &PosePanel::pastePose);
  chooser->addWidget(paste);
  return bar;
}

void PosePanel::showMatrix() {
  const auto role = static_cast<PoseRole>(copied_->currentIndex());
  QStringList rows;
  for (int row = PoseTableModel::kMatrixRow1; row <= PoseTableModel::kMatrixRow4; ++row)
    rows << aligned(model_.index(row, copied_->currentIndex()).data().toString());
  matrix_->setText(model_.pose(role) ? rows.join(QLatin1Char('\n'))
                                     : tr("There is no pose \"%1\".").arg(poseRoleName(role)));
  showNamedPoses(role);
}

void PosePanel::showNamedPoses(PoseRole role) {
  const ViewState::CasePtr& one = state_.currentCase();
  QStringList texts;
  if (one && model_.pose(role))
    for (const sessions::NamedPose& named : sessions::namedPoses(
             one->source.camera_reference, one->source.station_frame, *model_.pose(role)))
      texts << fromText(sessions::namedPoseTitle(named)) + matrixRows(named.reference_from_station);
  named_->setText(texts.join(QStringLiteral("\n\n")));
  named_->setVisible(!texts.isEmpty());
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
  for (int i = 0; i < kPoseRoles; ++i) {
    const bool optional = static_cast<PoseRole>(i) != PoseRole::kSeed &&
                          static_cast<PoseRole>(i) != PoseRole::kEstimate;
    table_->setColumnHidden(i, optional && !poses[static_cast<std::size_t>(i)]);
  }
  table_->resizeColumnsToContents();
  showMatrix();
  comparison_->setPoses(poses);
  comparison_->setCovariance(shownCovariance(state_));
}

}  // namespace boresight::ui
