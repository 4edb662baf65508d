// SPDX-License-Identifier: Apache-2.0
#include "ui/panels/run/pose_panel.h"

#include <QtWidgets>

#include "core/base/math.h"
#include "sessions/session/named_poses.h"
#include "ui/models/text.h"
#include "ui/widgets/widgets.h"

namespace boresight::ui {

using sessions::PoseForm;

PastePoseDialog::PastePoseDialog(const QString& text, QWidget* parent) : QDialog(parent) {
  ui_.setupUi(this);
  ui_.text->setPlainText(text);
  ui_.text->setFont(QFontDatabase::systemFont(QFontDatabase::FixedFont));
  ui_.verdict->setMinimumHeight(3 * ui_.verdict->fontMetrics().lineSpacing());
  take_ = ui_.buttons->addButton(tr("Nudge to this pose"), QDialogButtonBox::AcceptRole);
  for (QComboBox* box : {ui_.direction, ui_.matrixOrder, ui_.quaternionOrder, ui_.unit})
    connect(box, kIndexChanged, this, &PastePoseDialog::parse);
  connect(ui_.text, &QPlainTextEdit::textChanged, this, &PastePoseDialog::guess);
  guess();
  resize(560, 420);
}

void PastePoseDialog::guess() {
  const sessions::PoseReading guess = sessions::guessReading(ui_.text->toPlainText().toStdString());
  const auto choose = [](QComboBox* box, bool second) {
    const QSignalBlocker blocker(box);
    box->setCurrentIndex(second ? 1 : 0);
  };
  choose(ui_.direction, guess.station_from_camera);
  choose(ui_.matrixOrder, guess.column_major);
  choose(ui_.quaternionOrder, guess.xyzw);
  choose(ui_.unit, guess.millimetres);
  parse();
}

void PastePoseDialog::parse() {
  const auto second = [](const QComboBox* box) { return box->currentIndex() == 1; };
  parsed_ = sessions::parsePose(ui_.text->toPlainText().toStdString(),
                                {.station_from_camera = second(ui_.direction),
                                 .column_major = second(ui_.matrixOrder),
                                 .xyzw = second(ui_.quaternionOrder),
                                 .millimetres = second(ui_.unit)});
  ui_.matrixOrder->setEnabled(parsed_.form == PoseForm::kMatrix);
  ui_.quaternionOrder->setEnabled(parsed_.form == PoseForm::kQuaternion);
  take_->setEnabled(parsed_.valid);
  if (!parsed_.valid) {
    ui_.verdict->setText(QString(QChar(0x26A0)) + QLatin1Char(' ') +
                         QString::fromStdString(parsed_.problem));
    return;
  }
  const Eigen::Vector3d mm = 1e3 * parsed_.camera_from_station.translation_m;
  QString text =
      tr("The station's origin lies %1, %2, %3 mm right of, below and ahead of the "
         "camera, turned by %4 deg.")
          .arg(mm.x(), 0, 'f', 2)
          .arg(mm.y(), 0, 'f', 2)
          .arg(mm.z(), 0, 'f', 2)
          .arg(rotationLog(parsed_.camera_from_station.rotation).norm() / kDegree_rad, 0, 'f', 2);
  if (mm.z() <= 0.0) text += tr(" It is behind the camera.");
  if (parsed_.rotation_deviation > 1e-6)
    text += tr(" The matrix was %1 off a rotation and was projected to the nearest one.")
                .arg(parsed_.rotation_deviation, 0, 'g', 2);
  ui_.verdict->setText(text);
}

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

/// Rotation and translation in metres, row by row.
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

constexpr const char* kTranslationHelp =
    QT_TR_NOOP("The station's origin in the camera frame (x right, y down, z forward), mm");
constexpr const char* kRotationHelp = QT_TR_NOOP(
    "Rotation vector of camera_from_station in camera axes, deg: its direction is the axis, its "
    "length the angle");
constexpr const char* kQuaternionHelp =
    QT_TR_NOOP("Unit quaternion of camera_from_station, in the order w x y z, with w >= 0");

struct Figure {
  const char* name;
  const char* help;
};
constexpr Figure kFigures[] = {
    {QT_TR_NOOP("x, mm"), kTranslationHelp},    {QT_TR_NOOP("y, mm"), kTranslationHelp},
    {QT_TR_NOOP("z, mm"), kTranslationHelp},    {QT_TR_NOOP("turn x, deg"), kRotationHelp},
    {QT_TR_NOOP("turn y, deg"), kRotationHelp}, {QT_TR_NOOP("turn z, deg"), kRotationHelp},
    {QT_TR_NOOP("quat. w"), kQuaternionHelp},   {QT_TR_NOOP("quat. x"), kQuaternionHelp},
    {QT_TR_NOOP("quat. y"), kQuaternionHelp},   {QT_TR_NOOP("quat. z"), kQuaternionHelp},
};

/// The figures of a pose, in the order of `kFigures`; zeros have no sign.
QStringList figuresOf(const Pose& pose) {
  QStringList texts;
  const auto add = [&texts](double value, int decimals) {
    const QString text = QString::number(value, 'f', decimals);
    texts << (text.toDouble() == 0.0 ? QString::number(0.0, 'f', decimals) : text);
  };
  const Eigen::Vector3d turn_deg = rotationLog(pose.rotation) / kDegree_rad;
  const Eigen::Quaterniond q = sessions::shownQuaternion(pose.rotation);
  for (const double metres : pose.translation_m) add(1e3 * metres, 4);
  for (const double degrees : turn_deg) add(degrees, 5);
  for (const double part : {q.w(), q.x(), q.y(), q.z()}) add(part, 8);
  return texts;
}

constexpr int kFrame_px = 22;  // of the table, and room for a scroll bar

}  // namespace

PosePanel::PosePanel(ViewState& state) : state_(state), controller_(state) {
  ui_.setupUi(this);
  buildTable();
  ui_.nudgingColumn->addWidget(new NudgeBox(controller_, state_));
  connectAll();
  refresh();
}

/// Destroyed widgets report the focus that they lose to the controller.
PosePanel::~PosePanel() { delete ui_.scroll; }

void PosePanel::buildTable() {
  for (QWidget* each : std::initializer_list<QWidget*>{ui_.matrix, ui_.namedPoses, ui_.poses})
    each->setFont(QFontDatabase::systemFont(QFontDatabase::FixedFont));
  styleTable(*ui_.poses);
  QStringList titles = {QString()};
  for (int i = 0; i < kPoseRoles; ++i) titles << poseRoleName(static_cast<PoseRole>(i));
  ui_.poses->setColumnCount(static_cast<int>(titles.size()));
  ui_.poses->setHorizontalHeaderLabels(titles);
  for (const Figure& figure : kFigures) {
    const int row = ui_.poses->rowCount();
    addRow(*ui_.poses, {tr(figure.name), {}, {}, {}, {}, {}});
    for (int column = 0; column < titles.size(); ++column)
      ui_.poses->item(row, column)->setToolTip(tr(figure.help));
  }
  ui_.poses->setFixedHeight(
      ui_.poses->verticalHeader()->defaultSectionSize() * (ui_.poses->rowCount() + 1) + kFrame_px);
}

void PosePanel::connectAll() {
  offerRoles(*ui_.copiedRole, PoseRole::kEstimate);
  connect(ui_.copiedRole, kIndexChanged, this, &PosePanel::showMatrix);
  for (const FormText& form : kForms)
    connect(findChild<QPushButton*>(QLatin1String(form.object)), &QPushButton::clicked, this,
            [this, form] {
              copyPose(static_cast<PoseRole>(ui_.copiedRole->currentIndex()), form.form);
            });
  connect(ui_.pastePose, &QPushButton::clicked, this, &PosePanel::pastePose);
  connect(ui_.poses, &QWidget::customContextMenuRequested, this, &PosePanel::showMenu);
  state_.onChange(ViewChange::kCase | ViewChange::kSnapshot | ViewChange::kCursor |
                      ViewChange::kNudgedPose | ViewChange::kAnnotatedPose,
                  this, &PosePanel::refresh);
}

void PosePanel::showMatrix() {
  const auto role = static_cast<PoseRole>(ui_.copiedRole->currentIndex());
  const std::optional<Pose>& shown = pose(role);
  ui_.matrix->setText(shown
                          ? matrixRows(*shown) +
                                QStringLiteral("\n          0          0          0             1")
                          : tr("There is no pose \"%1\".").arg(poseRoleName(role)));
  const ViewState::CasePtr& loaded_case = state_.currentCase();
  QStringList texts;
  if (loaded_case && shown)
    for (const sessions::NamedPose& named : sessions::namedPoses(loaded_case->source, *shown))
      texts << fromText(sessions::namedPoseTitle(named)) + QLatin1Char('\n') +
                   matrixRows(named.reference_from_station);
  ui_.namedPoses->setText(texts.join(QStringLiteral("\n\n")));
  ui_.namedPoses->setVisible(!texts.isEmpty());
}

void PosePanel::showMenu(const QPoint& at) {
  QMenu menu(this);
  const QModelIndex cell = ui_.poses->indexAt(at);
  if (cell.isValid() && cell.column() > 0) {
    const auto role = static_cast<PoseRole>(cell.column() - 1);
    for (const FormText& form : kForms)
      menu.addAction(tr("Copy %1 as %2").arg(poseRoleName(role), tr(form.name).toLower()), this,
                     [this, role, form] { copyPose(role, form.form); })
          ->setEnabled(pose(role).has_value());
    menu.addAction(tr("Copy this value"), this,
                   [cell] { QGuiApplication::clipboard()->setText(cell.data().toString()); });
    menu.addSeparator();
  }
  menu.addAction(tr("Paste a pose ..."), this, &PosePanel::pastePose);
  menu.exec(ui_.poses->viewport()->mapToGlobal(at));
}

void PosePanel::setJudgement(const PoseJudgement& judgement) {
  ui_.comparison->setJudgement(judgement);
}

void PosePanel::copyPose(PoseRole role, sessions::PoseForm form) {
  if (!pose(role)) return;
  QGuiApplication::clipboard()->setText(fromText(sessions::poseText(*pose(role), form)));
}

void PosePanel::pastePose() {
  if (!state_.currentCase()) return;
  const CaseOpening seen = state_.opening();
  PastePoseDialog dialog(QGuiApplication::clipboard()->text(), this);
  if (dialog.exec() != QDialog::Accepted || !dialog.parsed().valid) return;
  if (seen == state_.opening())
    controller_.setPose(dialog.parsed().camera_from_station);
  else
    Q_EMIT failed(leftText(seen));
}

void PosePanel::refresh() {
  for (int i = 0; i < kPoseRoles; ++i) {
    const auto role = static_cast<PoseRole>(i);
    std::optional<Pose>& shown = poses_[static_cast<std::size_t>(i)];
    shown = poseOf(state_, role);
    const QStringList figures = shown ? figuresOf(*shown) : QStringList();
    for (int row = 0; row < ui_.poses->rowCount(); ++row)
      ui_.poses->item(row, 1 + i)->setText(shown ? figures[row] : QString(QChar(0x2013)));
    const bool optional = role != PoseRole::kSeed && role != PoseRole::kEstimate;
    ui_.poses->setColumnHidden(1 + i, optional && !shown);
  }
  ui_.poses->resizeColumnsToContents();
  showMatrix();
  ui_.comparison->setPoses(poses_);
  ui_.comparison->setCovariance(shownCovariance(state_));
}

}  // namespace boresight::ui
