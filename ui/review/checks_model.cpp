// SPDX-License-Identifier: Apache-2.0
#include "ui/review/checks_model.h"

#include <algorithm>
#include <array>
#include <utility>

#include <QtWidgets>

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

QString reasonText(const CheckRow& row) {
  if (row.check.state != CheckState::kFailed) return {};
  return row.reason.isEmpty() ? ChecksModel::tr("✎ type a reason") : row.reason;
}

std::vector<TableColumn<CheckRow>> columns() {
  using Row = const CheckRow&;
  constexpr auto tr = [](const char* text) { return ChecksModel::tr(text); };
  return {
      {tr("Check"), tr("What is asked of the pose: ✗ failed, ✓ passed, – could not be asked."), -1,
       [](Row row) {
         return ChecksModel::sign(row.check.state) + QLatin1Char(' ') + fromText(row.check.title);
       }},
      {tr("Found"), tr("What was measured, with its unit; nothing where the sentence alone tells."),
       0, [](Row row) { return fromText(sessions::foundText(row.check)); }},
      {tr("Limit"), tr("What the figure must keep to: of the preset, or as edited under Limits."),
       -1, [](Row row) { return shortLimit(row.check); }},
      {tr("Reason to pass over"),
       tr("A pose with a failed check can be validated only with a reason to pass over the check. "
          "The reason is stored with the pose, and dropped when the measured value changes."),
       -1, reasonText},
  };
}

}  // namespace

ChecksModel::ChecksModel(QObject* parent) : RowsModel(columns(), parent) {}

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

void ChecksModel::setRows(std::vector<CheckRow> rows, bool current) {
  std::stable_sort(rows.begin(), rows.end(), [](const CheckRow& a, const CheckRow& b) {
    return rank(a.check.state) < rank(b.check.state);
  });
  if (rows == this->rows() && current == current_) return;
  current_ = current;
  setRowsByKey(std::move(rows), [](const CheckRow& row) { return row.check.id; });
  Q_EMIT headerDataChanged(Qt::Horizontal, kCheck, kCheck);
}

QVariant ChecksModel::look(const CheckRow& row, int column, int role) const {
  const bool placeholder = column == kReason && row.reason.isEmpty();
  switch (role) {
    case Qt::EditRole:
      return column == kReason ? row.reason : valueOf(row, column);
    case Qt::ToolTipRole:
      return tr("%1: %2. %3")
          .arg(fromText(row.check.title), fromText(sessions::checkStateText(row.check.state)),
               fromText(row.check.sentence));
    case Qt::ForegroundRole:
      if (current_ && row.check.state != CheckState::kNotApplicable && !placeholder) return {};
      return QGuiApplication::palette().brush(QPalette::Disabled, QPalette::Text);
    case Qt::FontRole: {
      QFont font;
      font.setBold(row.check.state == CheckState::kFailed && column == kCheck);
      font.setItalic(placeholder);
      return font;
    }
    default:
      return {};
  }
}

bool ChecksModel::setData(const QModelIndex& index, const QVariant& value, int role) {
  if (role != Qt::EditRole || !(flags(index) & Qt::ItemIsEditable)) return false;
  const std::string id = at(index.row()).check.id;
  Q_EMIT reasonEdited(id, value.toString());
  return true;
}

Qt::ItemFlags ChecksModel::flags(const QModelIndex& index) const {
  const Qt::ItemFlags flags = QAbstractTableModel::flags(index);
  if (!index.isValid() || index.column() != kReason || !current_) return flags;
  const bool failed = at(index.row()).check.state == CheckState::kFailed;
  return failed ? flags | Qt::ItemIsEditable : flags;
}

QString ChecksModel::countsText() const {
  if (rows().empty()) return tr("Check");
  if (!current_) return tr("Check (no longer of what is here)");
  std::array<int, 3> counts = {};
  for (const CheckRow& row : rows()) ++counts[static_cast<std::size_t>(rank(row.check.state))];
  return tr("Check: ✗ %1  ✓ %2  – %3").arg(counts[0]).arg(counts[1]).arg(counts[2]);
}

QVariant ChecksModel::headerData(int section, Qt::Orientation orientation, int role) const {
  const bool counts = orientation == Qt::Horizontal && section == kCheck;
  return counts && role == Qt::DisplayRole ? countsText()
                                           : RowsModel::headerData(section, orientation, role);
}

}  // namespace boresight::ui
