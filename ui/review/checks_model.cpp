// SPDX-License-Identifier: Apache-2.0
#include "ui/review/checks_model.h"

#include <algorithm>
#include <array>
#include <utility>

#include <QFont>
#include <QGuiApplication>
#include <QPalette>

#include "ui/models/number_text.h"

namespace boresight::ui {

using sessions::CheckState;

namespace {

int rank(CheckState state) {
  return state == CheckState::kFailed ? 0 : state == CheckState::kPassed ? 1 : 2;
}

QString shortLimit(const sessions::Check& check) {
  return fromText(sessions::limitText(check))
      .replace(QStringLiteral("at most"), QStringLiteral("≤"))
      .replace(QStringLiteral("at least"), QStringLiteral("≥"));
}

bool isAsked(const CheckRow& row) { return row.check.state != CheckState::kNotApplicable; }

}  // namespace

ChecksModel::ChecksModel(QObject* parent) : QAbstractTableModel(parent) {}

QString ChecksModel::sign(CheckState state) {
  switch (state) {
    case CheckState::kPassed:
      return QStringLiteral("✓");
    case CheckState::kFailed:
      return QStringLiteral("✗");
    case CheckState::kNotApplicable:
      break;
  }
  return QStringLiteral("–");
}

bool ChecksModel::hasSameChecks(const std::vector<CheckRow>& rows) const {
  return std::equal(rows.begin(), rows.end(), rows_.begin(), rows_.end(),
                    [](const CheckRow& a, const CheckRow& b) { return a.check.id == b.check.id; });
}

void ChecksModel::setRows(std::vector<CheckRow> rows, bool current) {
  std::stable_sort(rows.begin(), rows.end(), [](const CheckRow& a, const CheckRow& b) {
    return rank(a.check.state) < rank(b.check.state);
  });
  const bool same = hasSameChecks(rows);
  if (same && rows == rows_ && current == current_) return;
  current_ = current;
  if (same) {
    rows_ = std::move(rows);
    if (!rows_.empty()) Q_EMIT dataChanged(index(0, 0), index(rowCount() - 1, kColumnCount - 1));
  } else {
    beginResetModel();
    rows_ = std::move(rows);
    endResetModel();
  }
  Q_EMIT headerDataChanged(Qt::Horizontal, kCheck, kCheck);
}

int ChecksModel::rowCount(const QModelIndex& parent) const {
  return parent.isValid() ? 0 : static_cast<int>(rows_.size());
}

int ChecksModel::columnCount(const QModelIndex& parent) const {
  return parent.isValid() ? 0 : kColumnCount;
}

QString ChecksModel::text(const CheckRow& row, int column) const {
  const sessions::Check& check = row.check;
  if (column == kCheck) return sign(check.state) + QLatin1Char(' ') + fromText(check.title);
  if (column == kFound) return fromText(sessions::foundText(check));
  if (column == kLimit) return shortLimit(check);
  if (check.state != CheckState::kFailed) return {};
  return row.reason.isEmpty() ? tr("✎ type a reason") : row.reason;
}

QVariant ChecksModel::data(const QModelIndex& index, int role) const {
  if (!index.isValid() || index.row() >= rowCount()) return {};
  const CheckRow& row = checkAt(index.row());
  const int column = index.column();
  switch (role) {
    case Qt::DisplayRole:
      return text(row, column);
    case Qt::EditRole:
      return column == kReason ? row.reason : text(row, column);
    case Qt::ToolTipRole:
      return tr("%1: %2. %3")
          .arg(fromText(row.check.title), fromText(sessions::checkStateText(row.check.state)),
               fromText(row.check.sentence));
    case Qt::ForegroundRole: {
      const bool placeholder = column == kReason && row.reason.isEmpty();
      if (current_ && isAsked(row) && !placeholder) return {};
      return QGuiApplication::palette().brush(QPalette::Disabled, QPalette::Text);
    }
    case Qt::FontRole: {
      QFont font;
      font.setBold(row.check.state == CheckState::kFailed && column == kCheck);
      font.setItalic(column == kReason && row.reason.isEmpty());
      return font;
    }
    case Qt::TextAlignmentRole:
      return static_cast<int>((column == kFound ? Qt::AlignRight : Qt::AlignLeft) |
                              Qt::AlignVCenter);
    default:
      return {};
  }
}

bool ChecksModel::setData(const QModelIndex& index, const QVariant& value, int role) {
  if (role != Qt::EditRole || !(flags(index) & Qt::ItemIsEditable)) return false;
  const std::string id = checkAt(index.row()).check.id;
  Q_EMIT reasonEdited(id, value.toString());
  return true;
}

Qt::ItemFlags ChecksModel::flags(const QModelIndex& index) const {
  const Qt::ItemFlags flags = QAbstractTableModel::flags(index);
  if (!index.isValid() || index.column() != kReason || !current_) return flags;
  const bool failed = checkAt(index.row()).check.state == CheckState::kFailed;
  return failed ? flags | Qt::ItemIsEditable : flags;
}

QString ChecksModel::countsText() const {
  if (rows_.empty()) return tr("Check");
  if (!current_) return tr("Check (no longer of what is here)");
  std::array<int, 3> counts = {};
  for (const CheckRow& row : rows_) ++counts[static_cast<std::size_t>(rank(row.check.state))];
  return tr("Check: ✗ %1  ✓ %2  – %3").arg(counts[0]).arg(counts[1]).arg(counts[2]);
}

QVariant ChecksModel::headerData(int section, Qt::Orientation orientation, int role) const {
  if (orientation != Qt::Horizontal || section < 0 || section >= kColumnCount) return {};
  const std::array<QString, kColumnCount> titles = {countsText(), tr("Found"), tr("Limit"),
                                                    tr("Reason to pass over")};
  const std::array<QString, kColumnCount> help = {
      tr("What is asked of the pose: ✗ failed, ✓ passed, – could not be asked."),
      tr("What was measured, with its unit; nothing where the sentence alone tells."),
      tr("What the figure must keep to: of the preset, or as edited under Limits."),
      tr("A failed check stands in the way of a validation until somebody says why it may be "
         "passed over. The reason goes with the pose; it is dropped when the figure changes.")};
  if (role == Qt::DisplayRole) return titles[static_cast<std::size_t>(section)];
  if (role == Qt::ToolTipRole) return help[static_cast<std::size_t>(section)];
  return {};
}

}  // namespace boresight::ui
