// SPDX-License-Identifier: Apache-2.0
#include "ui/review/limits_dialog.h"

#include <QAction>
#include <QCheckBox>
#include <QComboBox>
#include <QHBoxLayout>
#include <QHeaderView>
#include <QLabel>
#include <QPushButton>
#include <QSignalBlocker>
#include <QTableView>
#include <QVBoxLayout>

#include "ui/models/number_text.h"
#include "ui/panels/table_style.h"
#include "ui/review/review_controller.h"

namespace boresight::ui {

LimitsDialog::LimitsDialog(ReviewController& controller, QWidget* parent)
    : QDialog(parent), controller_(controller) {
  setObjectName(QStringLiteral("limitsDialog"));
  setWindowTitle(tr("Limits of the checks"));
  auto* column = new QVBoxLayout(this);
  buildTop(*column);
  buildTable(*column);
  buildBottom(*column);
  connect(&model_, &LimitsModel::edited, &controller_, &ReviewController::setLimits);
  connect(&model_, &LimitsModel::refused, this, [this](const QString& message) {
    help_->setText(tr("✗ Not changed: %1.").arg(message));
  });
  connect(&controller_, &ReviewController::standingChanged, this, &LimitsDialog::showSettings);
  showSettings();
  showChosen();
  resize(640, 460);
}

void LimitsDialog::buildTop(QVBoxLayout& column) {
  auto* row = new QHBoxLayout;
  preset_ = new QComboBox(this);
  preset_->setObjectName(QStringLiteral("preset"));
  for (const sessions::CheckPreset& preset : sessions::checkPresets()) {
    preset_->addItem(fromText(preset.name));
    preset_->setItemData(preset_->count() - 1, fromText(preset.help), Qt::ToolTipRole);
  }
  auto* label = new QLabel(tr("&Preset"), this);
  label->setBuddy(preset_);
  preset_help_ = new QLabel(this);
  preset_help_->setWordWrap(true);
  row->addWidget(label);
  row->addWidget(preset_);
  row->addWidget(preset_help_, 1);
  column.addLayout(row);
  connect(preset_, QOverload<int>::of(&QComboBox::activated), this,
          [this] { controller_.setPreset(preset_->currentText()); });
}

void LimitsDialog::buildTable(QVBoxLayout& column) {
  table_ = new QTableView(this);
  table_->setObjectName(QStringLiteral("limits"));
  table_->setAccessibleName(tr("Limits"));
  table_->setModel(&model_);
  styleTable(*table_);
  table_->setEditTriggers(QAbstractItemView::DoubleClicked | QAbstractItemView::SelectedClicked |
                          QAbstractItemView::EditKeyPressed | QAbstractItemView::AnyKeyPressed);
  auto* reset = new QAction(tr("Back to the preset's value"), table_);
  reset->setShortcut(QKeySequence::Delete);
  reset->setShortcutContext(Qt::WidgetShortcut);
  table_->addAction(reset);
  table_->setContextMenuPolicy(Qt::ActionsContextMenu);
  connect(reset, &QAction::triggered, this, [this] { model_.reset(table_->currentIndex().row()); });
  connect(table_->selectionModel(), &QItemSelectionModel::currentChanged, this,
          &LimitsDialog::showChosen);
  column.addWidget(table_);
  help_ = new QLabel(this);
  help_->setObjectName(QStringLiteral("limitHelp"));
  help_->setWordWrap(true);
  help_->setTextFormat(Qt::PlainText);
  help_->setAlignment(Qt::AlignLeft | Qt::AlignTop);
  help_->setMinimumHeight(2 * help_->fontMetrics().lineSpacing());
  column.addWidget(help_);
}

void LimitsDialog::buildBottom(QVBoxLayout& column) {
  second_ = new QCheckBox(tr("A second person approves"), this);
  second_->setObjectName(QStringLiteral("secondPerson"));
  second_->setToolTip(
      tr("A validation counts only once somebody else than who validated has approved it"));
  reset_ = new QPushButton(tr("Reset all"), this);
  reset_->setToolTip(tr("Take every limit back to the preset's value"));
  reset_->setAutoDefault(false);
  auto* close = new QPushButton(tr("Close"), this);
  close->setAutoDefault(false);
  auto* row = new QHBoxLayout;
  row->addWidget(second_, 1);
  row->addWidget(reset_);
  row->addWidget(close);
  column.addLayout(row);
  connect(second_, &QCheckBox::clicked, &controller_, &ReviewController::setSecondPerson);
  connect(reset_, &QPushButton::clicked, this, [this] { model_.resetAll(); });
  connect(close, &QPushButton::clicked, this, &QDialog::close);
}

void LimitsDialog::showSettings() {
  const sessions::ReviewSettings& settings = controller_.settings();
  const sessions::CheckPreset* preset = sessions::findCheckPreset(settings.preset);
  if (preset == nullptr) return;
  model_.setLimits(sessions::checkLimits(settings.preset, settings.limits), preset->limits);
  preset_->setCurrentText(fromText(preset->name));
  preset_->setToolTip(fromText(preset->help));
  preset_help_->setText(fromText(preset->help));
  second_->setChecked(settings.second_person);
  reset_->setEnabled(!settings.limits.empty());
  fitColumns(*table_);
}

void LimitsDialog::showChosen() {
  const QModelIndex index = table_->currentIndex();
  help_->setText(index.isValid() ? index.data(Qt::ToolTipRole).toString()
                                 : tr("Choose a limit to read what it is for."));
}

}  // namespace boresight::ui
