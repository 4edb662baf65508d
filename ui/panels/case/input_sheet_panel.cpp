// SPDX-License-Identifier: Apache-2.0
#include "ui/panels/case/input_sheet_panel.h"

#include <cmath>

#include <QtWidgets>

#include "sessions/io/files/errors.h"
#include "ui/models/rows_model.h"
#include "ui/widgets/widgets.h"

namespace boresight::ui {
namespace {

constexpr double kPercent = 100.0;

}  // namespace

InputSigmasDialog::InputSigmasDialog(const sessions::SessionCase& one, QWidget* parent)
    : QDialog(parent), former_(one), former_calibration_(one.calibration_sigma) {
  ui_.setupUi(this);
  const auto show = [](QDoubleSpinBox* box, double value, double maximum) {
    box->setMaximum(maximum);
    box->setValue(value);
    return box->value();
  };
  ui_.meshStated->setChecked(former_.mesh_scale_stated);
  ui_.cameraStated->setChecked(former_.stated != sessions::StatedCalibration());
  for (QWidget* field :
       std::initializer_list<QWidget*>{ui_.cameraStated, ui_.focal, ui_.principalPoint}) {
    if (!former_.calibration_derived) break;
    field->setEnabled(false);
    field->setToolTip(tr("The camera's covariance counts in place of these"));
  }
  shown_mesh_scale_ =
      show(ui_.meshScale, kPercent * former_.mesh_scale, kPercent * sessions::kMaxScaleSigma);
  shown_focal_ = show(ui_.focal, kPercent * former_.calibration.focal_relative,
                      kPercent * sessions::kMaxFocalSigma);
  shown_centre_px_ = show(ui_.principalPoint, former_.calibration.principal_point_px,
                          sessions::kMaxPrincipalPointSigma_px);
}

std::optional<double> InputSigmasDialog::meshScaleSigma() const {
  if (!ui_.meshStated->isChecked()) return std::nullopt;
  const double shown = ui_.meshScale->value();
  return shown == shown_mesh_scale_ ? former_.mesh_scale : shown / kPercent;
}

/// A member whose box is unchanged keeps its exact value. It also stays assumed, unless neither
/// member was stated: checking the group then states both.
std::optional<sessions::StatedCalibration> InputSigmasDialog::calibrationSigma() const {
  if (former_.calibration_derived) return former_calibration_;
  if (!ui_.cameraStated->isChecked()) return std::nullopt;
  sessions::StatedCalibration stated = former_calibration_.value_or(sessions::StatedCalibration{
      former_.calibration.focal_relative, former_.calibration.principal_point_px});
  const double focal = ui_.focal->value();
  const double centre_px = ui_.principalPoint->value();
  if (focal != shown_focal_) stated.focal_relative = focal / kPercent;
  if (centre_px != shown_centre_px_) stated.principal_point_px = centre_px;
  return stated;
}

JudgementDialog::JudgementDialog(const sessions::SessionCase& one, QWidget* parent)
    : QDialog(parent),
      former_end_effector_(one.camera_from_end_effector.value_or(Pose())),
      former_requirement_(one.requirement.value_or(sessions::Requirement())),
      former_symmetries_(one.symmetries) {
  ui_.setupUi(this);
  const Eigen::Vector3d place_mm = 1e3 * former_end_effector_.translation_m;
  ui_.endEffectorStated->setChecked(one.camera_from_end_effector.has_value());
  ui_.endEffectorX->setValue(place_mm.x());
  ui_.endEffectorY->setValue(place_mm.y());
  ui_.endEffectorZ->setValue(place_mm.z());
  const sessions::Requirement& former = former_requirement_;
  ui_.requirementStated->setChecked(former.normal_mm || former.lateral_mm || former.rotation_deg);
  ui_.normal->setValue(former.normal_mm.value_or(0.4));
  ui_.lateral->setValue(former.lateral_mm.value_or(0.4));
  ui_.rotation->setValue(former.rotation_deg.value_or(0.25));
  ui_.symmetries->setText(fromText(sessions::symmetriesText(former_symmetries_)));
  connect(ui_.symmetries, &QLineEdit::textChanged, this, &JudgementDialog::readSymmetries);
  readSymmetries();
}

void JudgementDialog::readSymmetries() {
  const std::string text = ui_.symmetries->text().toStdString();
  QString problem;
  try {
    symmetries_ = text == sessions::symmetriesText(former_symmetries_)
                      ? former_symmetries_
                      : sessions::symmetriesIn(text);
  } catch (const sessions::InputError& error) {
    problem = fromText(error.field() + ": " + error.reason());
  }
  ui_.problem->setText(problem);
  ui_.buttons->button(QDialogButtonBox::Ok)->setEnabled(problem.isEmpty());
}

std::optional<Pose> JudgementDialog::cameraFromEndEffector() const {
  if (!ui_.endEffectorStated->isChecked()) return std::nullopt;
  Pose stated = former_end_effector_;
  const QDoubleSpinBox* boxes[] = {ui_.endEffectorX, ui_.endEffectorY, ui_.endEffectorZ};
  for (int axis = 0; axis < 3; ++axis) {
    // What is only shown rounded stays as it was.
    const double value_m = 1e-3 * boxes[axis]->value();
    if (std::abs(value_m - stated.translation_m[axis]) > 0.5e-6)
      stated.translation_m[axis] = value_m;
  }
  return stated;
}

std::optional<sessions::Requirement> JudgementDialog::requirement() const {
  sessions::Requirement stated;
  stated.projection_px = former_requirement_.projection_px;
  if (ui_.requirementStated->isChecked()) {
    stated.normal_mm = ui_.normal->value();
    stated.lateral_mm = ui_.lateral->value();
    stated.rotation_deg = ui_.rotation->value();
  }
  return stated == sessions::Requirement() ? std::nullopt : std::optional(stated);
}

InputSheetPanel::InputSheetPanel() {
  ui_.setupUi(this);
  styleTable(*ui_.sheet);
  ui_.sheet->setWordWrap(true);
  ui_.sheet->verticalHeader()->setSectionResizeMode(QHeaderView::ResizeToContents);
  ui_.sheet->setSelectionMode(QAbstractItemView::ExtendedSelection);
  connect(ui_.copy, &QAction::triggered, this, &InputSheetPanel::copyChosen);
  connect(ui_.inputSigmas, &QPushButton::clicked, this, &InputSheetPanel::sigmasRequested);
  connect(ui_.judgement, &QPushButton::clicked, this, &InputSheetPanel::judgementRequested);
  setSheet(std::nullopt);
}

void InputSheetPanel::setSheet(const std::optional<sessions::InputSheet>& sheet) {
  ui_.inputSigmas->setEnabled(sheet.has_value());
  ui_.judgement->setEnabled(sheet.has_value());
  if (!sheet) {
    ui_.flags->setText(tr("No case is open."));
    ui_.sheet->setRowCount(0);
    return;
  }
  QStringList sentences;
  for (const sessions::RedFlag& flag : sheet->flags)
    sentences.append(QStringLiteral("⚠ ") + fromText(flag.text));
  ui_.flags->setText(sentences.isEmpty() ? tr("✓ No warnings about the inputs.")
                                         : sentences.join(QLatin1Char('\n')));
  ui_.flags->setFont(boldFont(font(), !sentences.isEmpty()));
  ui_.sheet->setRowCount(static_cast<int>(sheet->lines.size()));
  for (int row = 0; row < ui_.sheet->rowCount(); ++row) {
    const sessions::SheetLine& line = sheet->lines[static_cast<std::size_t>(row)];
    ui_.sheet->setItem(row, 0, new QTableWidgetItem(fromText(line.label)));
    auto* value = new QTableWidgetItem(fromText(line.value));
    value->setToolTip(fromText(line.value));  // it may be longer than the panel is wide
    ui_.sheet->setItem(row, 1, value);
  }
  ui_.sheet->resizeColumnToContents(0);
}

void InputSheetPanel::copyChosen() const {
  QString text;
  const QModelIndexList rows = ui_.sheet->selectionModel()->selectedRows();
  for (const QModelIndex& row : rows)
    text += row.data().toString() + QLatin1Char('\t') + row.siblingAtColumn(1).data().toString() +
            QLatin1Char('\n');
  QApplication::clipboard()->setText(text);
}

}  // namespace boresight::ui
