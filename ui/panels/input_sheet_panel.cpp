// SPDX-License-Identifier: Apache-2.0
#include "ui/panels/input_sheet_panel.h"

#include <QtWidgets>

#include "sessions/session/input_sigmas.h"
#include "ui/models/number_text.h"
#include "ui/panels/widgets.h"

namespace boresight::ui {
namespace {

constexpr double kPercent = 100.0;

}  // namespace

InputSigmasDialog::InputSigmasDialog(const sessions::SessionCase& one, QWidget* parent)
    : QDialog(parent) {
  setWindowTitle(tr("How well mesh and camera are known"));
  const sessions::InputSigmas sigmas(one);
  auto* column = new QVBoxLayout(this);
  mesh_ = group(tr("Stated for the mesh, one sigma"), QStringLiteral("meshStated"),
                sigmas.mesh_scale_stated);
  mesh_scale_percent_ =
      box(mesh_, tr("Scale"), QStringLiteral("meshScale"), kPercent * sigmas.mesh_scale,
          kPercent * sessions::kMaxScaleSigma, tr(" %"));
  camera_ = group(tr("Stated for the camera, one sigma"), QStringLiteral("cameraStated"),
                  sigmas.calibration_stated);
  focal_percent_ = box(camera_, tr("Focal length"), QStringLiteral("focal"),
                       kPercent * sigmas.calibration.focal_relative,
                       kPercent * sessions::kMaxFocalSigma, tr(" %"));
  principal_point_px_ =
      box(camera_, tr("Principal point"), QStringLiteral("principalPoint"),
          sigmas.calibration.principal_point_px, sessions::kMaxPrincipalPointSigma_px, tr(" px"));
  column->addWidget(mesh_);
  column->addWidget(camera_);
  auto* buttons = new QDialogButtonBox(QDialogButtonBox::Ok | QDialogButtonBox::Cancel, this);
  connect(buttons, &QDialogButtonBox::accepted, this, &QDialog::accept);
  connect(buttons, &QDialogButtonBox::rejected, this, &QDialog::reject);
  column->addWidget(buttons);
}

QGroupBox* InputSigmasDialog::group(const QString& title, const QString& name, bool stated) {
  auto* made = new QGroupBox(title, this);
  made->setObjectName(name);
  made->setCheckable(true);
  made->setChecked(stated);
  made->setToolTip(tr("Off: the values shown are assumed"));
  new QFormLayout(made);
  return made;
}

QDoubleSpinBox* InputSigmasDialog::box(QGroupBox* group, const QString& label, const QString& name,
                                       double value, double maximum, const QString& unit) {
  auto* made = new QDoubleSpinBox(group);
  made->setObjectName(name);
  made->setDecimals(4);
  made->setRange(0.0, maximum);
  made->setSingleStep(0.01);
  made->setValue(value);
  made->setSuffix(unit);
  static_cast<QFormLayout*>(group->layout())->addRow(label, made);
  return made;
}

std::optional<double> InputSigmasDialog::meshScaleSigma() const {
  if (!mesh_->isChecked()) return std::nullopt;
  return mesh_scale_percent_->value() / kPercent;
}

std::optional<sessions::CalibrationSigma> InputSigmasDialog::calibrationSigma() const {
  if (!camera_->isChecked()) return std::nullopt;
  return sessions::CalibrationSigma{focal_percent_->value() / kPercent,
                                    principal_point_px_->value()};
}

InputSheetPanel::InputSheetPanel(QWidget* parent) : QWidget(parent) {
  auto* column = new QVBoxLayout(this);
  column->setContentsMargins(4, 4, 4, 4);
  flags_ = named(new QLabel(this), "flags");
  flags_->setWordWrap(true);
  flags_->setTextFormat(Qt::PlainText);
  flags_->setMargin(6);
  flags_->setTextInteractionFlags(Qt::TextSelectableByMouse | Qt::TextSelectableByKeyboard);
  column->addWidget(flags_);
  table_ = named(new QTableWidget(0, 2, this), "sheet");
  table_->setAccessibleName(tr("Inputs"));
  styleTable(*table_);
  table_->setWordWrap(true);
  table_->verticalHeader()->setSectionResizeMode(QHeaderView::ResizeToContents);
  table_->setSelectionMode(QAbstractItemView::ExtendedSelection);
  table_->setHorizontalHeaderLabels({tr("Input"), tr("Value")});
  table_->horizontalHeader()->setStretchLastSection(true);
  column->addWidget(table_, 1);
  auto* copy = new QAction(tr("Copy"), table_);
  copy->setShortcut(QKeySequence::Copy);
  copy->setShortcutContext(Qt::WidgetShortcut);
  table_->addAction(copy);
  table_->setContextMenuPolicy(Qt::ActionsContextMenu);
  connect(copy, &QAction::triggered, this, &InputSheetPanel::copyChosen);
  sigmas_ =
      named(new QPushButton(tr("How well mesh and camera are known ..."), this), "inputSigmas");
  connect(sigmas_, &QPushButton::clicked, this, &InputSheetPanel::sigmasRequested);
  column->addWidget(sigmas_);
  setSheet(std::nullopt);
}

void InputSheetPanel::showFlags(const std::vector<sessions::RedFlag>& flags) {
  QStringList sentences;
  for (const sessions::RedFlag& flag : flags)
    sentences.append(QStringLiteral("⚠ ") + fromText(flag.text));
  flags_->setText(flags.empty() ? tr("✓ Nothing looks wrong with the inputs.")
                                : sentences.join(QLatin1Char('\n')));
  QFont font = this->font();
  font.setBold(!flags.empty());
  flags_->setFont(font);
}

void InputSheetPanel::setSheet(const std::optional<sessions::InputSheet>& sheet) {
  sigmas_->setEnabled(sheet.has_value());
  if (!sheet) {
    flags_->setText(tr("No case is open."));
    table_->setRowCount(0);
    return;
  }
  showFlags(sheet->flags);
  table_->setRowCount(static_cast<int>(sheet->lines.size()));
  for (int row = 0; row < table_->rowCount(); ++row) {
    const sessions::SheetLine& line = sheet->lines[static_cast<std::size_t>(row)];
    table_->setItem(row, 0, new QTableWidgetItem(fromText(line.label)));
    auto* value = new QTableWidgetItem(fromText(line.value));
    value->setToolTip(fromText(line.value));  // it may be longer than the panel is wide
    table_->setItem(row, 1, value);
  }
  table_->resizeColumnToContents(0);
}

QString InputSheetPanel::text() const {
  QString text = flags_->text() + QLatin1Char('\n');
  for (int row = 0; row < table_->rowCount(); ++row)
    text += table_->item(row, 0)->text() + QStringLiteral(": ") + table_->item(row, 1)->text() +
            QLatin1Char('\n');
  return text;
}

void InputSheetPanel::copyChosen() const {
  QString text;
  const QModelIndexList rows = table_->selectionModel()->selectedRows();
  for (const QModelIndex& row : rows)
    text += row.data().toString() + QLatin1Char('\t') + row.siblingAtColumn(1).data().toString() +
            QLatin1Char('\n');
  QApplication::clipboard()->setText(text);
}

}  // namespace boresight::ui
