// SPDX-License-Identifier: Apache-2.0
#include "ui/panels/input_sheet_panel.h"

#include <QtWidgets>

#include "sessions/session/input_sigmas.h"
#include "ui/models/text.h"
#include "ui/panels/widgets.h"

namespace boresight::ui {
namespace {

constexpr double kPercent = 100.0;

}  // namespace

InputSigmasDialog::InputSigmasDialog(const sessions::SessionCase& one, QWidget* parent)
    : QDialog(parent) {
  ui_.setupUi(this);
  const sessions::InputSigmas sigmas(one);
  const auto show = [](QDoubleSpinBox* box, double value, double maximum) {
    box->setMaximum(maximum);
    box->setValue(value);
  };
  ui_.meshStated->setChecked(sigmas.mesh_scale_stated);
  ui_.cameraStated->setChecked(sigmas.calibration_stated);
  show(ui_.meshScale, kPercent * sigmas.mesh_scale, kPercent * sessions::kMaxScaleSigma);
  show(ui_.focal, kPercent * sigmas.calibration.focal_relative,
       kPercent * sessions::kMaxFocalSigma);
  show(ui_.principalPoint, sigmas.calibration.principal_point_px,
       sessions::kMaxPrincipalPointSigma_px);
  connect(ui_.buttons, &QDialogButtonBox::accepted, this, &QDialog::accept);
  connect(ui_.buttons, &QDialogButtonBox::rejected, this, &QDialog::reject);
}

std::optional<double> InputSigmasDialog::meshScaleSigma() const {
  if (!ui_.meshStated->isChecked()) return std::nullopt;
  return ui_.meshScale->value() / kPercent;
}

std::optional<sessions::CalibrationSigma> InputSigmasDialog::calibrationSigma() const {
  if (!ui_.cameraStated->isChecked()) return std::nullopt;
  return sessions::CalibrationSigma{ui_.focal->value() / kPercent, ui_.principalPoint->value()};
}

InputSheetPanel::InputSheetPanel(QWidget* parent) : QWidget(parent) {
  ui_.setupUi(this);
  styleTable(*ui_.sheet);
  ui_.sheet->setWordWrap(true);
  ui_.sheet->verticalHeader()->setSectionResizeMode(QHeaderView::ResizeToContents);
  ui_.sheet->setSelectionMode(QAbstractItemView::ExtendedSelection);
  ui_.sheet->horizontalHeader()->setStretchLastSection(true);
  auto* copy = new QAction(tr("Copy"), ui_.sheet);
  copy->setShortcut(QKeySequence::Copy);
  copy->setShortcutContext(Qt::WidgetShortcut);
  ui_.sheet->addAction(copy);
  ui_.sheet->setContextMenuPolicy(Qt::ActionsContextMenu);
  connect(copy, &QAction::triggered, this, &InputSheetPanel::copyChosen);
  connect(ui_.inputSigmas, &QPushButton::clicked, this, &InputSheetPanel::sigmasRequested);
  setSheet(std::nullopt);
}

void InputSheetPanel::showFlags(const std::vector<sessions::RedFlag>& flags) {
  QStringList sentences;
  for (const sessions::RedFlag& flag : flags)
    sentences.append(QStringLiteral("⚠ ") + fromText(flag.text));
  ui_.flags->setText(flags.empty() ? tr("✓ No warnings about the inputs.")
                                   : sentences.join(QLatin1Char('\n')));
  QFont font = this->font();
  font.setBold(!flags.empty());
  ui_.flags->setFont(font);
}

void InputSheetPanel::setSheet(const std::optional<sessions::InputSheet>& sheet) {
  ui_.inputSigmas->setEnabled(sheet.has_value());
  if (!sheet) {
    ui_.flags->setText(tr("No case is open."));
    ui_.sheet->setRowCount(0);
    return;
  }
  showFlags(sheet->flags);
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

QString InputSheetPanel::text() const {
  QString text = ui_.flags->text() + QLatin1Char('\n');
  for (int row = 0; row < ui_.sheet->rowCount(); ++row)
    text += ui_.sheet->item(row, 0)->text() + QStringLiteral(": ") +
            ui_.sheet->item(row, 1)->text() + QLatin1Char('\n');
  return text;
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
