// SPDX-License-Identifier: Apache-2.0
#include "ui/review/differences_model.h"

#include <algorithm>
#include <iterator>
#include <utility>

#include <QStringList>

#include "ui/models/column_info.h"
#include "ui/models/number_text.h"

namespace boresight::ui {

using sessions::RunChange;
using sessions::RunDifference;

namespace {

constexpr const char* kContext = "boresight::ui::DifferencesModel";

constexpr ColumnInfo kColumns[] = {
    {QT_TRANSLATE_NOOP("boresight::ui::DifferencesModel", "Case"),
     QT_TRANSLATE_NOOP("boresight::ui::DifferencesModel", "The case."), -1},
    {QT_TRANSLATE_NOOP("boresight::ui::DifferencesModel", "Change"),
     QT_TRANSLATE_NOOP("boresight::ui::DifferencesModel",
                       "Whether the last run is better than the one before: by the truth where it "
                       "is known, else by the checks."),
     -1},
    {QT_TRANSLATE_NOOP("boresight::ui::DifferencesModel", "Failed checks"),
     QT_TRANSLATE_NOOP("boresight::ui::DifferencesModel", "How many failed: before, and now."), 0},
    {QT_TRANSLATE_NOOP("boresight::ui::DifferencesModel", "Inliers"),
     QT_TRANSLATE_NOOP("boresight::ui::DifferencesModel",
                       "Inliers of the last matching iteration: before, and now."),
     0},
    {QT_TRANSLATE_NOOP("boresight::ui::DifferencesModel", "Poses apart"),
     QT_TRANSLATE_NOOP("boresight::ui::DifferencesModel",
                       "How far the two results are apart at the camera, in mm and mrad."),
     0},
    {QT_TRANSLATE_NOOP("boresight::ui::DifferencesModel", "Why, and where they differ first"),
     QT_TRANSLATE_NOOP("boresight::ui::DifferencesModel",
                       "What the change is judged by, and the first thing in which the runs are "
                       "not the same to the bit."),
     -1},
};
static_assert(std::size(kColumns) == DifferencesModel::kColumnCount);

QString signOf(RunChange change) {
  switch (change) {
    case RunChange::kBetter:
      return DifferencesModel::tr("▲ better");
    case RunChange::kWorse:
      return DifferencesModel::tr("▼ worse");
    case RunChange::kSame:
      break;
  }
  return DifferencesModel::tr("= same");
}

QString beforeAndNow(int before, int now) { return QStringLiteral("%1 → %2").arg(before).arg(now); }

QString textOf(const RunDifference& made, int column) {
  switch (column) {
    case DifferencesModel::kChange:
      return signOf(made.change);
    case DifferencesModel::kChecks:
      return beforeAndNow(made.before.checks_failed, made.after.checks_failed);
    case DifferencesModel::kInliers:
      return beforeAndNow(made.before.inliers, made.after.inliers);
    case DifferencesModel::kApart:
      if (!made.before.converged || !made.after.converged) return {};
      return DifferencesModel::tr("%1 mm, %2 mrad")
          .arg(numberText(made.comparison.translation_mm, 3),
               numberText(made.comparison.rotation_mrad, 3));
    default:
      return fromText(sessions::changeText(made));
  }
}

/// Worse ones first when it ascends.
QVariant sortValue(const RunDifference& made, int column) {
  switch (column) {
    case DifferencesModel::kChange:
      return made.change == RunChange::kWorse ? 0 : made.change == RunChange::kBetter ? 1 : 2;
    case DifferencesModel::kChecks:
      return made.after.checks_failed - made.before.checks_failed;
    case DifferencesModel::kInliers:
      return made.after.inliers - made.before.inliers;
    case DifferencesModel::kApart:
      return made.comparison.translation_mm;
    default:
      return textOf(made, column);
  }
}

QString tableHtml(const RunDifference& made) {
  QString html = DifferencesModel::tr("<table><tr><th></th><th>before</th><th>now</th></tr>");
  for (const sessions::DifferenceLine& line : sessions::differenceLines(made))
    html += QStringLiteral("<tr><td>%1&nbsp;</td><td>%2&nbsp;</td><td>%3</td></tr>")
                .arg(fromText(line.label).toHtmlEscaped(), fromText(line.before).toHtmlEscaped(),
                     fromText(line.after).toHtmlEscaped());
  return html + QStringLiteral("</table><p>%1</p>")
                    .arg(fromText(sessions::changeText(made)).toHtmlEscaped());
}

}  // namespace

DifferencesModel::DifferencesModel(QObject* parent) : QAbstractTableModel(parent) {}

void DifferencesModel::setEntries(std::vector<DifferenceEntry> entries) {
  const bool same = std::equal(
      entries.begin(), entries.end(), entries_.begin(), entries_.end(),
      [](const DifferenceEntry& a, const DifferenceEntry& b) { return a.case_id == b.case_id; });
  if (!same) beginResetModel();
  entries_ = std::move(entries);
  if (!same)
    endResetModel();
  else if (!entries_.empty())
    Q_EMIT dataChanged(index(0, 0), index(rowCount() - 1, kColumnCount - 1));
}

int DifferencesModel::rowCount(const QModelIndex& parent) const {
  return parent.isValid() ? 0 : static_cast<int>(entries_.size());
}

int DifferencesModel::columnCount(const QModelIndex& parent) const {
  return parent.isValid() ? 0 : kColumnCount;
}

QVariant DifferencesModel::data(const QModelIndex& index, int role) const {
  if (!index.isValid() || index.row() >= rowCount()) return {};
  const DifferenceEntry& entry = entryAt(index.row());
  const int column = index.column();
  if (role == Qt::TextAlignmentRole) return columnCell(kContext, kColumns[column], role);
  if (role != Qt::DisplayRole && role != kSortRole && role != Qt::ToolTipRole) return {};
  if (column == kCase && role != Qt::ToolTipRole) return fromText(entry.case_id);
  if (!entry.difference) {
    const QString told = entry.problem.isEmpty() ? tr("… being compared") : entry.problem;
    if (role == kSortRole) return {};
    return column == kWhy || role == Qt::ToolTipRole ? QVariant(told) : QVariant();
  }
  if (role == Qt::ToolTipRole) return tableHtml(*entry.difference);
  return role == kSortRole ? sortValue(*entry.difference, column)
                           : QVariant(textOf(*entry.difference, column));
}

QVariant DifferencesModel::headerData(int section, Qt::Orientation orientation, int role) const {
  return columnHeader(kContext, kColumns, section, orientation, role);
}

}  // namespace boresight::ui
