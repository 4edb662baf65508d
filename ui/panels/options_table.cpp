// SPDX-License-Identifier: Apache-2.0
#include "ui/panels/options_table.h"

#include <algorithm>
#include <limits>

#include <QtWidgets>

#include "ui/panels/widgets.h"

namespace boresight::ui {

using sessions::OptionDescription;
using sessions::OptionKind;

namespace {

constexpr int kLowest = std::numeric_limits<int>::min();
constexpr int kHighest = std::numeric_limits<int>::max();

/// Arrows and wheel stay in range; typed numbers may leave it, so that they are refused with a
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

OptionsTable::OptionsTable(QWidget* parent) : QTableView(parent) {
  filter_.setSourceModel(&model_);
  setUpTable(*this, filter_);
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

void OptionsTable::setOptions(const std::vector<OptionDescription>& now,
                              const std::vector<OptionDescription>& by_default) {
  const bool fitted = model_.rowCount() > 0;
  model_.setOptions(now, by_default);
  showHelp();
  if (fitted) return;
  resizeColumnsToContents();
  // One long number must not push the rest out of sight; tooltip and editor show it whole.
  const int most = fontMetrics().horizontalAdvance(QStringLiteral("0.123456789"));
  for (const int column : {OptionsModel::kValue, OptionsModel::kDefault})
    setColumnWidth(column, std::min(columnWidth(column), most));
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

void OptionsTable::showHelp() {
  Q_EMIT helpChanged(currentIndex().data(Qt::ToolTipRole).toString());
}

}  // namespace boresight::ui
