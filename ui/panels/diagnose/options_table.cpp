// SPDX-License-Identifier: Apache-2.0
#include "ui/panels/diagnose/options_table.h"

#include <algorithm>
#include <limits>

#include <QtWidgets>

#include "sessions/io/json/json_reader.h"
#include "sessions/text/plain_text.h"
#include "ui/widgets/column_fitter.h"
#include "ui/widgets/widgets.h"

namespace boresight::ui {

using sessions::OptionDescription;
using sessions::OptionKind;

namespace {

/// A value without its unit: "true", "12", "0.5", "histogram".
QString plainText(const OptionDescription& option) {
  OptionDescription bare = option;
  bare.unit.clear();
  return fromText(sessions::valueText(bare, option.value));
}

/// Rounded for comparison by eye; tool tip and editor show the whole value.
QString shownText(const OptionDescription& option) {
  constexpr int kDigits = 6;
  const QString whole = plainText(option);
  const auto* real = std::get_if<double>(&option.value);
  const QString rounded = real ? QString::number(*real, 'g', kDigits) : whole;
  return rounded.size() < whole.size() ? rounded : whole;
}

QString helpText(const OptionRow& row) {
  const QString unit = row.now.unit.empty() ? QString() : QLatin1Char(' ') + fromText(row.now.unit);
  return OptionsModel::tr("%1: %2 Value %6%4; range %3%4; default %5%4.")
      .arg(fromText(row.now.name), fromText(row.now.help), OptionsModel::rangeText(row.now), unit,
           plainText(row.by_default), plainText(row.now));
}

std::vector<TableColumn<OptionRow>> optionColumns() {
  using Row = const OptionRow&;
  constexpr auto tr = [](const char* text) { return OptionsModel::tr(text); };
  return {
      {tr("Option"), tr("Name of the option, as in its file and on the command line."), -1,
       [](Row row) { return fromText(row.now.name); }},
      {tr("Value"), tr("Value in use; bold where it differs from the default."), -1,
       [](Row row) { return shownText(row.now); }},
      {tr("Reset"), tr("Click to restore the default."), -1,
       [](Row row) { return row.isChanged() ? OptionsModel::tr("↺ reset") : QString(); }},
      {tr("Unit"), tr("Unit of the value; none for counts, shares and choices."), -1,
       [](Row row) { return fromText(row.now.unit); }},
      {tr("Default"), tr("Value in the chosen profile or preset."), -1,
       [](Row row) { return shownText(row.by_default); }},
      {tr("Range"), tr("Allowed values; others are refused."), -1,
       [](Row row) { return OptionsModel::rangeText(row.now); }},
  };
}

bool isSwitch(const OptionRow& row, int column) {
  return column == OptionsModel::kValue && row.now.kind == OptionKind::kBoolean;
}

constexpr int kLowest = std::numeric_limits<int>::min();
constexpr int kHighest = std::numeric_limits<int>::max();

/// Arrows and wheel stay in range; typed numbers may leave it, so that they are rejected with a
/// message instead of being changed silently.
class IntegerBox : public QSpinBox {
 public:
  IntegerBox(const OptionDescription& option, QWidget* parent)
      : QSpinBox(parent),
        low_(static_cast<int>(option.minimum)),
        high_(static_cast<int>(option.maximum)) {
    setRange(kLowest, kHighest);
  }

  void stepBy(int steps) override { setValue(std::clamp(value() + steps, low_, high_)); }

 private:
  int low_;
  int high_;
};

/// Values are set and read by the editors' user property.
class OptionDelegate : public QStyledItemDelegate {
 public:
  using QStyledItemDelegate::QStyledItemDelegate;

  QWidget* createEditor(QWidget* parent, const QStyleOptionViewItem& /*option*/,
                        const QModelIndex& index) const override {
    const auto* filter = static_cast<const QSortFilterProxyModel*>(index.model());
    const auto* model = static_cast<const OptionsModel*>(filter->sourceModel());
    const OptionDescription& option = model->at(filter->mapToSource(index).row()).now;
    QWidget* editor = newEditor(option, parent);
    editor->setAutoFillBackground(true);
    editor->setToolTip(
        QStringLiteral("%1 %2").arg(OptionsModel::rangeText(option), fromText(option.unit)));
    return editor;
  }

 private:
  static QWidget* newEditor(const OptionDescription& option, QWidget* parent) {
    if (option.kind == OptionKind::kChoice) {
      auto* box = new QComboBox(parent);
      for (const std::string& choice : option.choices) box->addItem(fromText(choice));
      return box;
    }
    const bool fits = option.minimum >= kLowest && option.maximum <= kHighest;
    if (option.kind == OptionKind::kInteger && fits) return new IntegerBox(option, parent);
    return new QLineEdit(parent);
  }
};

}  // namespace

OptionsModel::OptionsModel() : RowsModel(optionColumns()) {}

void OptionsModel::setOptions(const std::vector<OptionDescription>& current,
                              const std::vector<OptionDescription>& by_default) {
  std::vector<OptionRow> rows;
  for (const OptionDescription& option : current) rows.push_back({option, by_default[rows.size()]});
  setRowsByKey(std::move(rows), [](const OptionRow& row) { return row.now.name; });
}

int OptionsModel::changedCount() const {
  return static_cast<int>(std::ranges::count_if(rows(), &OptionRow::isChanged));
}

void OptionsModel::reset(int row) {
  if (row < 0 || !at(row).isChanged()) return;
  Q_EMIT edited(at(row).now.name, plainText(at(row).by_default).toStdString());
}

QString OptionsModel::rangeText(const OptionDescription& option) {
  if (option.kind == OptionKind::kBoolean) return tr("true, false");
  if (option.kind == OptionKind::kChoice) return fromText(sessions::joined(option.choices));
  return fromText(sessions::numberText(option.minimum) + " .. " +
                  sessions::numberText(option.maximum));
}

QVariant OptionsModel::look(const OptionRow& row, int column, int role) const {
  switch (role) {
    case Qt::EditRole:
      return column == kValue ? plainText(row.now) : valueOf(row, column);
    case Qt::ToolTipRole:
      return helpText(row);
    case Qt::CheckStateRole:
      if (!isSwitch(row, column)) return {};
      return static_cast<int>(std::get<bool>(row.now.value) ? Qt::Checked : Qt::Unchecked);
    case Qt::FontRole:
      return boldFont(QFont(), row.isChanged() && column <= kValue);
    default:
      return {};
  }
}

bool OptionsModel::setData(const QModelIndex& index, const QVariant& value, int role) {
  const bool check = role == Qt::CheckStateRole;
  if (index.column() != kValue || !(check || role == Qt::EditRole)) return false;
  const OptionDescription& option = at(index.row()).now;
  const QString typed = check ? QString::fromLatin1(value.toInt() == Qt::Checked ? "true" : "false")
                              : value.toString().trimmed();
  const std::string name = option.name;  // the answer replaces the row
  if (typed != plainText(option)) Q_EMIT edited(name, typed.toStdString());
  return true;
}

Qt::ItemFlags OptionsModel::flags(const QModelIndex& index) const {
  const Qt::ItemFlags flags = QAbstractTableModel::flags(index);
  if (!index.isValid() || index.column() != kValue) return flags;
  return flags | (isSwitch(at(index.row()), kValue) ? Qt::ItemIsUserCheckable : Qt::ItemIsEditable);
}

OptionsTable::OptionsTable(QWidget* parent) : QTableView(parent) {
  filter_.setSourceModel(&model_);
  setUpTable(*this, filter_);
  new ColumnFitter(*this, {OptionsModel::kRange, OptionsModel::kDefault, OptionsModel::kUnit});
  setItemDelegateForColumn(OptionsModel::kValue, new OptionDelegate(this));
  setEditTriggers(DoubleClicked | SelectedClicked | EditKeyPressed | AnyKeyPressed);
  auto* reset = new QAction(tr("Restore the default"), this);
  reset->setShortcut(QKeySequence::Delete);
  reset->setShortcutContext(Qt::WidgetShortcut);
  addAction(reset);
  setContextMenuPolicy(Qt::ActionsContextMenu);
  const auto reset_row = [this](const QModelIndex& index) {
    if (index.isValid()) model_.reset(filter_.mapToSource(index).row());
  };
  connect(reset, &QAction::triggered, this, [=, this] { reset_row(currentIndex()); });
  connect(this, &QTableView::clicked, this, [=](const QModelIndex& index) {
    if (index.column() == OptionsModel::kReset) reset_row(index);
  });
  connect(selectionModel(), &QItemSelectionModel::currentChanged, this, &OptionsTable::showHelp);
}

void OptionsTable::setOptions(const std::vector<OptionDescription>& current,
                              const std::vector<OptionDescription>& by_default) {
  const bool fitted = model_.rowCount() > 0;
  model_.setOptions(current, by_default);
  showHelp();
  if (fitted) return;
  resizeColumnsToContents();
  // Values that are typed later find the columns wide enough.
  const int least = fontMetrics().horizontalAdvance(QStringLiteral("0.00123456")) + 16;
  for (const int column : {OptionsModel::kValue, OptionsModel::kDefault})
    setColumnWidth(column, std::max(columnWidth(column), least));
  setColumnWidth(OptionsModel::kReset,
                 fontMetrics().horizontalAdvance(OptionsModel::tr("↺ reset")) + 16);
}

void OptionsTable::setFilter(const QString& words, bool changed_only) {
  const QStringList all = words.simplified().split(QLatin1Char(' '));
  filter_.setCondition([this, all, changed_only](int row) {
    const OptionRow& option = model_.at(row);
    const QString text = fromText(option.now.name + " " + option.now.help);
    return (!changed_only || option.isChanged()) &&
           std::ranges::all_of(all, [&text](const QString& word) {
             return text.contains(word, Qt::CaseInsensitive);
           });
  });
}

void OptionsTable::describeIn(QLabel& help, const QString& prompt) {
  help_ = &help;
  prompt_ = prompt;
  help.setMinimumHeight(2 * help.fontMetrics().lineSpacing());
}

void OptionsTable::showHelp() {
  if (!help_) return;
  const QString help = currentIndex().data(Qt::ToolTipRole).toString();
  help_->setText(help.isEmpty() ? prompt_ : help);
}

}  // namespace boresight::ui
