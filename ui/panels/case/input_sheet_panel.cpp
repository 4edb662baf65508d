// SPDX-License-Identifier: Apache-2.0
#include "ui/panels/case/input_sheet_panel.h"

#include <cstddef>

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
  ui_.meshStated->setChecked(former_.mesh_scale_stated);
  ui_.cameraStated->setChecked(former_.stated != sessions::StatedCalibration());
  for (QWidget* field :
       std::initializer_list<QWidget*>{ui_.cameraStated, ui_.focal, ui_.principalPoint}) {
    if (!former_.calibration_derived) break;
    field->setEnabled(false);
    field->setToolTip(tr("The camera's covariance counts in place of these"));
  }
  ui_.meshScale->setMaximum(kPercent * sessions::kMaxScaleSigma);
  ui_.focal->setMaximum(kPercent * sessions::kMaxFocalSigma);
  ui_.principalPoint->setMaximum(sessions::kMaxPrincipalPointSigma_px);
  const auto stated = former_calibration_.value_or(sessions::StatedCalibration());
  mesh_scale_ = {*ui_.meshScale, kPercent, former_.mesh_scale};
  focal_ = {*ui_.focal, kPercent, stated.focal_relative, former_.calibration.focal_relative};
  centre_px_ = {*ui_.principalPoint, 1.0, stated.principal_point_px,
                former_.calibration.principal_point_px};
  if (former_calibration_ && !former_.calibration_derived) {
    const QString assumed = tr("Assumed. Changing it, or ticking the group again, states it");
    if (!stated.focal_relative) ui_.focal->setToolTip(assumed);
    if (!stated.principal_point_px) ui_.principalPoint->setToolTip(assumed);
  }
  connect(ui_.cameraStated, &QGroupBox::toggled, this, [this] { camera_toggled_ = true; });
}

std::optional<double> InputSigmasDialog::meshScaleSigma() const {
  return ui_.meshStated->isChecked() ? mesh_scale_.value() : std::nullopt;
}

std::optional<sessions::StatedCalibration> InputSigmasDialog::calibrationSigma() const {
  if (former_.calibration_derived) return former_calibration_;
  if (!ui_.cameraStated->isChecked()) return std::nullopt;
  sessions::StatedCalibration stated{focal_.value(), centre_px_.value()};
  if (!camera_toggled_) return stated;
  if (!stated.focal_relative) stated.focal_relative = former_.calibration.focal_relative;
  if (!stated.principal_point_px)
    stated.principal_point_px = former_.calibration.principal_point_px;
  return stated;
}

JudgementDialog::JudgementDialog(const sessions::SessionCase& one,
                                 const sessions::Requirement& limits, QWidget* parent)
    : QDialog(parent),
      former_end_effector_(one.camera_from_end_effector.value_or(Pose())),
      former_requirement_(one.requirement),
      limits_(limits),
      former_symmetries_(one.symmetries) {
  ui_.setupUi(this);
  if (!former_requirement_) ui_.requirement->setTitle(tr("Requirement, assumed from the preset"));
  ui_.endEffectorStated->setChecked(one.camera_from_end_effector.has_value());
  QDoubleSpinBox* const place[] = {ui_.endEffectorX, ui_.endEffectorY, ui_.endEffectorZ};
  for (std::size_t axis = 0; axis < 3; ++axis)
    place_m_[axis] = {*place[axis], 1e3,
                      former_end_effector_.translation_m[static_cast<Eigen::Index>(axis)]};
  normal_mm_ = {*ui_.normal, 1.0, limits_.normal_mm};
  lateral_mm_ = {*ui_.lateral, 1.0, limits_.lateral_mm};
  rotation_deg_ = {*ui_.rotation, 1.0, limits_.rotation_deg};
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
  for (std::size_t axis = 0; axis < 3; ++axis)
    stated.translation_m[static_cast<Eigen::Index>(axis)] = place_m_[axis].value().value_or(0.0);
  return stated;
}

std::optional<sessions::Requirement> JudgementDialog::requirement() const {
  const sessions::Requirement stated{normal_mm_.value(), lateral_mm_.value(), rotation_deg_.value(),
                                     limits_.projection_px};
  if (stated == limits_) return former_requirement_;
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
