// SPDX-License-Identifier: Apache-2.0
#include "ui/models/options_model.h"

#include <algorithm>

#include <QFont>

#include "sessions/io/json_reader.h"

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

QString helpText(const OptionRow& row) {
  const QString unit = row.now.unit.empty() ? QString() : QLatin1Char(' ') + fromText(row.now.unit);
  return OptionsModel::tr("%1: %2 Range %3%4; default %5%4.")
      .arg(fromText(row.now.name), fromText(row.now.help), OptionsModel::rangeText(row.now), unit,
           plainText(row.by_default));
}

std::vector<TableColumn<OptionRow>> optionColumns() {
  using Row = const OptionRow&;
  constexpr auto tr = [](const char* text) { return OptionsModel::tr(text); };
  return {
      {tr("Option"), tr("Name of the option, as in its file and on the command line."), -1,
       [](Row row) { return fromText(row.now.name); }},
      {tr("Value"), tr("Value in use; bold where it differs from the default."), -1,
       [](Row row) { return plainText(row.now); }},
      {tr("Reset"), tr("Click to restore the default."), -1,
       [](Row row) { return row.isChanged() ? OptionsModel::tr("↺ reset") : QString(); }},
      {tr("Unit"), tr("Unit of the value; none for counts, shares and choices."), -1,
       [](Row row) { return fromText(row.now.unit); }},
      {tr("Default"), tr("Value in the chosen profile or preset."), -1,
       [](Row row) { return plainText(row.by_default); }},
      {tr("Range"), tr("Allowed values; others are refused."), -1,
       [](Row row) { return OptionsModel::rangeText(row.now); }},
  };
}

bool isSwitch(const OptionRow& row, int column) {
  return column == OptionsModel::kValue && row.now.kind == OptionKind::kBoolean;
}

}  // namespace

OptionsModel::OptionsModel(QObject* parent) : RowsModel(optionColumns(), parent) {}

void OptionsModel::setOptions(const std::vector<OptionDescription>& now,
                              const std::vector<OptionDescription>& by_default) {
  std::vector<OptionRow> rows;
  for (const OptionDescription& option : now) rows.push_back({option, by_default[rows.size()]});
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
  if (option.kind == OptionKind::kChoice) {
    QStringList names;
    for (const std::string& choice : option.choices) names.append(fromText(choice));
    return names.join(QStringLiteral(", "));
  }
  return fromText(sessions::numberText(option.minimum) + " .. " +
                  sessions::numberText(option.maximum));
}

QVariant OptionsModel::look(const OptionRow& row, int column, int role) const {
  switch (role) {
    case Qt::EditRole:
      return valueOf(row, column);
    case Qt::ToolTipRole:
      return helpText(row);
    case Qt::CheckStateRole:
      if (!isSwitch(row, column)) return {};
      return static_cast<int>(std::get<bool>(row.now.value) ? Qt::Checked : Qt::Unchecked);
    case Qt::FontRole: {
      QFont font;
      font.setBold(row.isChanged() && column <= kValue);
      return font;
    }
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

}  // namespace boresight::ui
