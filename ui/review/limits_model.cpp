// SPDX-License-Identifier: Apache-2.0
#include "ui/review/limits_model.h"

#include <array>

#include <QFont>

#include "ui/models/number_text.h"
#include "ui/models/options_model.h"

namespace boresight::ui {

using sessions::OptionDescription;

namespace {

/// A value as people type it: without its unit.
QString plainText(const OptionDescription& option) {
  OptionDescription bare = option;
  bare.unit.clear();
  return fromText(sessions::valueText(bare, option.value));
}

}  // namespace

LimitsModel::LimitsModel(QObject* parent) : QAbstractTableModel(parent) { setLimits({}, {}); }

void LimitsModel::setLimits(const sessions::CheckLimits& limits,
                            const sessions::CheckLimits& of_preset) {
  const bool first = now_.empty();
  if (first) beginResetModel();
  limits_ = limits;
  of_preset_ = of_preset;
  now_ = sessions::listOptions(limits_);
  before_ = sessions::listOptions(of_preset_);
  if (first)
    endResetModel();
  else
    Q_EMIT dataChanged(index(0, 0), index(rowCount() - 1, kColumnCount - 1));
}

bool LimitsModel::isChanged(int row) const {
  const auto at = static_cast<std::size_t>(row);
  return at < now_.size() && now_[at].value != before_[at].value;
}

void LimitsModel::reset(int row) {
  if (!isChanged(row)) return;
  const auto at = static_cast<std::size_t>(row);
  sessions::CheckLimits changed = limits_;
  sessions::applyOption(changed, before_[at].name, before_[at].value);
  Q_EMIT edited(changed);
}

void LimitsModel::resetAll() { Q_EMIT edited(of_preset_); }

int LimitsModel::rowCount(const QModelIndex& parent) const {
  return parent.isValid() ? 0 : static_cast<int>(now_.size());
}

int LimitsModel::columnCount(const QModelIndex& parent) const {
  return parent.isValid() ? 0 : kColumnCount;
}

QString LimitsModel::text(int row, int column) const {
  const OptionDescription& option = now_[static_cast<std::size_t>(row)];
  switch (column) {
    case kName:
      return fromText(option.name).section(QLatin1Char('.'), 1);
    case kValue:
      return plainText(option);
    case kUnit:
      return fromText(option.unit);
    case kPreset:
      return plainText(before_[static_cast<std::size_t>(row)]);
    case kRange:
      return OptionsModel::rangeText(option);
    default:
      return {};
  }
}

QVariant LimitsModel::data(const QModelIndex& index, int role) const {
  if (!index.isValid() || index.row() >= rowCount()) return {};
  switch (role) {
    case Qt::DisplayRole:
    case Qt::EditRole:
      return text(index.row(), index.column());
    case Qt::ToolTipRole:
      return fromText(now_[static_cast<std::size_t>(index.row())].help);
    case Qt::FontRole: {
      QFont font;
      font.setBold(isChanged(index.row()) && index.column() <= kValue);
      return font;
    }
    default:
      return {};
  }
}

bool LimitsModel::setData(const QModelIndex& index, const QVariant& value, int role) {
  if (role != Qt::EditRole || index.column() != kValue) return false;
  const QString typed = value.toString().trimmed();
  if (typed == text(index.row(), kValue)) return true;
  sessions::CheckLimits changed = limits_;
  try {
    const OptionDescription& option = now_[static_cast<std::size_t>(index.row())];
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

QVariant LimitsModel::headerData(int section, Qt::Orientation orientation, int role) const {
  if (orientation != Qt::Horizontal || section < 0 || section >= kColumnCount) return {};
  const std::array<QString, kColumnCount> titles = {tr("Limit"), tr("Value"), tr("Unit"),
                                                    tr("Preset"), tr("Range")};
  const std::array<QString, kColumnCount> help = {
      tr("Name of the limit, as in the session's file."),
      tr("What checks are held against; bold where it differs from the preset."),
      tr("Unit of the value; none for counts."), tr("The value in the chosen preset."),
      tr("What the value may be; anything else is refused.")};
  if (role == Qt::DisplayRole) return titles[static_cast<std::size_t>(section)];
  if (role == Qt::ToolTipRole) return help[static_cast<std::size_t>(section)];
  return {};
}

}  // namespace boresight::ui
