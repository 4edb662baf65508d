// SPDX-License-Identifier: Apache-2.0
#include "ui/models/options_model.h"

#include <algorithm>
#include <array>

#include <QFont>

#include "sessions/io/config_file.h"
#include "sessions/io/json_reader.h"
#include "ui/models/number_text.h"

namespace boresight::ui {

using sessions::OptionDescription;
using sessions::OptionKind;

namespace {

/// Branches have this id, leaves their branch's row plus one.
constexpr quintptr kBranchId = 0;

LocalizerOptions optionsOf(const QString& profile) {
  return sessions::profileOptions(profile.toStdString()).value_or(defaultProfile());
}

/// A value as people type it: "true", "12", "0.5", "histogram".
QString plainText(const OptionDescription& option) {
  OptionDescription bare = option;
  bare.unit.clear();
  return fromText(sessions::valueText(bare, option.value));
}

}  // namespace

OptionsModel::OptionsModel(QObject* parent) : QAbstractItemModel(parent) {
  setProfile(QStringLiteral("default"));
}

QStringList OptionsModel::profiles() {
  return QString::fromLatin1(sessions::profileNames()).split(QStringLiteral(", "));
}

void OptionsModel::setOptions(const QString& profile, const LocalizerOptions& options) {
  beginResetModel();
  profile_ = profiles().contains(profile) ? profile : profiles().front();
  of_profile_ = sessions::listOptions(optionsOf(profile_));
  take(options);
  branches_.clear();
  for (std::size_t i = 0; i < now_.size(); ++i) {
    const QString name = fromText(now_[i].name).section(QLatin1Char('.'), 0, 0);
    if (branches_.empty() || branches_.back().name != name) branches_.push_back({name, {}});
    branches_.back().options.push_back(i);
  }
  endResetModel();
}

void OptionsModel::setProfile(const QString& profile) {
  setOptions(profile, optionsOf(profile));
  Q_EMIT edited();
}

void OptionsModel::take(const LocalizerOptions& options) {
  options_ = options;
  now_ = sessions::listOptions(options);
}

std::size_t OptionsModel::optionIndex(const QModelIndex& index) const {
  const auto branch = static_cast<std::size_t>(index.internalId() - 1);
  return branches_[branch].options[static_cast<std::size_t>(index.row())];
}

const OptionDescription* OptionsModel::option(const QModelIndex& index) const {
  return index.isValid() && index.internalId() != kBranchId ? &now_[optionIndex(index)] : nullptr;
}

bool OptionsModel::isChanged(const QModelIndex& index) const {
  if (option(index) == nullptr) return false;
  const std::size_t i = optionIndex(index);
  return now_[i].value != of_profile_[i].value;
}

int OptionsModel::changedCount() const {
  int count = 0;
  for (std::size_t i = 0; i < now_.size(); ++i) count += now_[i].value != of_profile_[i].value;
  return count;
}

void OptionsModel::reset(const QModelIndex& index) {
  if (isChanged(index)) apply(index, plainText(of_profile_[optionIndex(index)]).toStdString());
}

bool OptionsModel::apply(const QModelIndex& index, const std::string& text) {
  LocalizerOptions changed = options_;
  try {
    sessions::applyOptionText(changed, option(index)->name, text);
  } catch (const sessions::OptionError& error) {
    Q_EMIT refused(fromText(error.what()));
    return false;
  }
  take(changed);
  const QModelIndex parent = index.parent();
  Q_EMIT dataChanged(this->index(index.row(), 0, parent),
                     this->index(index.row(), kColumnCount - 1, parent));
  Q_EMIT dataChanged(parent, parent.siblingAtColumn(kColumnCount - 1));
  Q_EMIT edited();
  return true;
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

QModelIndex OptionsModel::index(int row, int column, const QModelIndex& parent) const {
  if (!hasIndex(row, column, parent)) return {};
  const quintptr id = parent.isValid() ? static_cast<quintptr>(parent.row()) + 1 : kBranchId;
  return createIndex(row, column, id);
}

QModelIndex OptionsModel::parent(const QModelIndex& index) const {
  if (!index.isValid() || index.internalId() == kBranchId) return {};
  return createIndex(static_cast<int>(index.internalId()) - 1, 0, kBranchId);
}

int OptionsModel::rowCount(const QModelIndex& parent) const {
  if (!parent.isValid()) return static_cast<int>(branches_.size());
  if (parent.internalId() != kBranchId || parent.column() != 0) return 0;
  return static_cast<int>(branches_[static_cast<std::size_t>(parent.row())].options.size());
}

int OptionsModel::columnCount(const QModelIndex& /*parent*/) const { return kColumnCount; }

QString OptionsModel::text(std::size_t option, Column column) const {
  switch (column) {
    case kName:
      return fromText(now_[option].name).section(QLatin1Char('.'), 1);
    case kValue:
      return plainText(now_[option]);
    case kUnit:
      return fromText(now_[option].unit);
    case kDefault:
      return plainText(of_profile_[option]);
    case kRange:
      return rangeText(now_[option]);
    case kReset:
      return now_[option].value != of_profile_[option].value ? tr("↺ reset") : QString();
    case kColumnCount:
      break;
  }
  return {};
}

QString OptionsModel::helpText(std::size_t option) const {
  const OptionDescription& one = now_[option];
  const QString unit = one.unit.empty() ? QString() : QLatin1Char(' ') + fromText(one.unit);
  return tr("%1: %2 Range %3%4; in profile %5: %6%4.")
      .arg(fromText(one.name), fromText(one.help), rangeText(one), unit, profile_,
           plainText(of_profile_[option]));
}

QVariant OptionsModel::branchData(const QModelIndex& index, int role) const {
  if (role != Qt::DisplayRole || index.column() != kName) return {};
  return branches_[static_cast<std::size_t>(index.row())].name;
}

QVariant OptionsModel::data(const QModelIndex& index, int role) const {
  if (!index.isValid()) return {};
  if (index.internalId() == kBranchId) return branchData(index, role);
  const std::size_t option = optionIndex(index);
  const auto column = static_cast<Column>(index.column());
  switch (role) {
    case Qt::DisplayRole:
    case Qt::EditRole:
      return text(option, column);
    case Qt::ToolTipRole:
      return helpText(option);
    case Qt::CheckStateRole:
      if (column != kValue || now_[option].kind != OptionKind::kBoolean) return {};
      return static_cast<int>(std::get<bool>(now_[option].value) ? Qt::Checked : Qt::Unchecked);
    case Qt::FontRole: {
      if (!isChanged(index) || column > kValue) return {};
      QFont bold;
      bold.setBold(true);
      return bold;
    }
    case kChangedRole:
      return isChanged(index);
    default:
      return {};
  }
}

bool OptionsModel::setData(const QModelIndex& index, const QVariant& value, int role) {
  const OptionDescription* one = option(index);
  if (one == nullptr || index.column() != kValue) return false;
  if (role == Qt::CheckStateRole)
    return apply(index, value.toInt() == Qt::Checked ? "true" : "false");
  if (role != Qt::EditRole) return false;
  const QString typed = value.toString().trimmed();
  if (typed == plainText(*one)) return true;
  return apply(index, typed.toStdString());
}

Qt::ItemFlags OptionsModel::flags(const QModelIndex& index) const {
  Qt::ItemFlags flags = QAbstractItemModel::flags(index);
  const OptionDescription* one = option(index);
  if (one == nullptr || index.column() != kValue) return flags;
  const bool boolean = one->kind == OptionKind::kBoolean;
  return flags | (boolean ? Qt::ItemIsUserCheckable : Qt::ItemIsEditable);
}

QVariant OptionsModel::headerData(int section, Qt::Orientation orientation, int role) const {
  if (orientation != Qt::Horizontal || section < 0 || section >= kColumnCount) return {};
  const std::array<QString, kColumnCount> titles = {tr("Option"),  tr("Value"), tr("Unit"),
                                                    tr("Default"), tr("Range"), QString()};
  const std::array<QString, kColumnCount> help = {
      tr("Stage and name of the option, as in config.json and on the command line."),
      tr("What the next run works with; bold where it differs from the profile."),
      tr("Unit of the value; none for counts, shares and choices."),
      tr("The value in the chosen profile."),
      tr("What the value may be; anything else is refused."),
      tr("Click to go back to the profile's value.")};
  if (role == Qt::DisplayRole) return titles[static_cast<std::size_t>(section)];
  if (role == Qt::ToolTipRole) return help[static_cast<std::size_t>(section)];
  return {};
}

OptionsFilter::OptionsFilter(QObject* parent) : QSortFilterProxyModel(parent) {
  setRecursiveFilteringEnabled(true);  // a branch shows when one of its options does
}

void OptionsFilter::setWords(const QString& text) {
  words_ = text.simplified().split(QLatin1Char(' '));
  invalidateFilter();
}

void OptionsFilter::setChangedOnly(bool changed_only) {
  changed_only_ = changed_only;
  invalidateFilter();
}

bool OptionsFilter::filterAcceptsRow(int row, const QModelIndex& parent) const {
  const auto* model = qobject_cast<const OptionsModel*>(sourceModel());
  const QModelIndex index = sourceModel()->index(row, 0, parent);
  const sessions::OptionDescription* option = model ? model->option(index) : nullptr;
  if (option == nullptr) return false;
  if (changed_only_ && !model->isChanged(index)) return false;
  const QString text = fromText(option->name + " " + option->help);
  return std::all_of(words_.begin(), words_.end(), [&text](const QString& word) {
    return text.contains(word, Qt::CaseInsensitive);
  });
}

}  // namespace boresight::ui
