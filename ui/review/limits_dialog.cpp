// SPDX-License-Identifier: Apache-2.0
#include "ui/review/limits_dialog.h"

#include <QtWidgets>

#include "ui/models/number_text.h"
#include "ui/models/options_model.h"
#include "ui/panels/widgets.h"
#include "ui/review/review_controller.h"

namespace boresight::ui {

using sessions::OptionDescription;

namespace {

/// A value as people type it: without its unit.
QString typedText(const OptionDescription& option) {
  OptionDescription bare = option;
  bare.unit.clear();
  return fromText(sessions::valueText(bare, option.value));
}

std::vector<TableColumn<LimitRow>> limitColumns() {
  using Row = const LimitRow&;
  constexpr auto tr = [](const char* text) { return LimitsModel::tr(text); };
  return {
      {tr("Limit"), tr("Name of the limit, as in the session's file."), -1,
       [](Row row) { return fromText(row.now.name).section(QLatin1Char('.'), 1); }},
      {tr("Value"), tr("What checks are held against; bold where it differs from the preset."), -1,
       [](Row row) { return typedText(row.now); }},
      {tr("Unit"), tr("Unit of the value; none for counts."), -1,
       [](Row row) { return fromText(row.now.unit); }},
      {tr("Preset"), tr("The value in the chosen preset."), -1,
       [](Row row) { return typedText(row.of_preset); }},
      {tr("Range"), tr("What the value may be; anything else is refused."), -1,
       [](Row row) { return OptionsModel::rangeText(row.now); }},
  };
}

}  // namespace

LimitsModel::LimitsModel(QObject* parent) : RowsModel(limitColumns(), parent) { setLimits({}, {}); }

void LimitsModel::setLimits(const sessions::CheckLimits& limits,
                            const sessions::CheckLimits& of_preset) {
  limits_ = limits;
  of_preset_ = of_preset;
  std::vector<LimitRow> rows;
  const auto presets = sessions::listOptions(of_preset_);
  for (const OptionDescription& option : sessions::listOptions(limits_))
    rows.push_back({option, presets[rows.size()]});
  setRows(std::move(rows), true);
}

void LimitsModel::reset(int row) {
  if (row < 0 || !at(row).isChanged()) return;
  sessions::CheckLimits changed = limits_;
  sessions::applyOption(changed, at(row).of_preset.name, at(row).of_preset.value);
  Q_EMIT edited(changed);
}

void LimitsModel::resetAll() { Q_EMIT edited(of_preset_); }

QVariant LimitsModel::look(const LimitRow& row, int column, int role) const {
  if (role == Qt::EditRole) return valueOf(row, column);
  if (role == Qt::ToolTipRole) return fromText(row.now.help);
  if (role != Qt::FontRole) return {};
  QFont font;
  font.setBold(row.isChanged() && column <= kValue);
  return font;
}

bool LimitsModel::setData(const QModelIndex& index, const QVariant& value, int role) {
  if (role != Qt::EditRole || index.column() != kValue) return false;
  const OptionDescription& option = at(index.row()).now;
  const QString typed = value.toString().trimmed();
  if (typed == typedText(option)) return true;
  sessions::CheckLimits changed = limits_;
  try {
    sessions::applyOptionText(changed, option.name, typed.toStdString());
  } catch (const sessions::OptionError& error) {
    Q_EMIT refused(fromText(error.what()));
    return false;
  }
  Q_EMIT edited(changed);
  return true;
}

Qt::ItemFlags LimitsModel::flags(const QModelIndex& index) const {
  const Qt::ItemFlags flags = QAbstractTableModel::flags(index);
  return index.isValid() && index.column() == kValue ? flags | Qt::ItemIsEditable : flags;
}

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
  preset_ = named(new QComboBox(this), "preset");
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
  table_ = newTable("limits", tr("Limits"), model_, this);
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
  help_ = named(new QLabel(this), "limitHelp");
  help_->setWordWrap(true);
  help_->setTextFormat(Qt::PlainText);
  help_->setAlignment(Qt::AlignLeft | Qt::AlignTop);
  help_->setMinimumHeight(2 * help_->fontMetrics().lineSpacing());
  column.addWidget(help_);
}

void LimitsDialog::buildBottom(QVBoxLayout& column) {
  second_ = named(new QCheckBox(tr("A second person approves"), this), "secondPerson",
                  tr("A validation counts only after a second person has approved it"));
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
  table_->resizeColumnsToContents();
}

void LimitsDialog::showChosen() {
  const QModelIndex index = table_->currentIndex();
  help_->setText(index.isValid() ? index.data(Qt::ToolTipRole).toString()
                                 : tr("Choose a limit to read what it is for."));
}

}  // namespace boresight::ui
