// SPDX-License-Identifier: Apache-2.0
#include "ui/review/queue_model.h"

#include <algorithm>
#include <cmath>
#include <iterator>
#include <limits>
#include <utility>

#include <QIcon>
#include <QPixmap>

#include "ui/models/column_info.h"
#include "ui/models/number_text.h"

namespace boresight::ui {

using sessions::CaseStanding;
using sessions::QueueGroup;
using sessions::QueueRow;

namespace {

constexpr double kPercent = 100.0;
constexpr double kNaN = std::numeric_limits<double>::quiet_NaN();
constexpr const char* kContext = "boresight::ui::QueueModel";

constexpr ColumnInfo kColumns[] = {
    {QT_TRANSLATE_NOOP("boresight::ui::QueueModel", "Case"),
     QT_TRANSLATE_NOOP("boresight::ui::QueueModel",
                       "The case, with the edges of its result over the image; red: those of the "
                       "seed, as there is no result."),
     -1},
    {QT_TRANSLATE_NOOP("boresight::ui::QueueModel", "State"),
     QT_TRANSLATE_NOOP("boresight::ui::QueueModel", "Where the case stands."), -1},
    {QT_TRANSLATE_NOOP("boresight::ui::QueueModel", "Trouble"),
     QT_TRANSLATE_NOOP("boresight::ui::QueueModel",
                       "What to look at. Sorted by it: failed runs, then failed checks, then the "
                       "margin, then the distance from the seed; what is decided comes last."),
     -1},
    {QT_TRANSLATE_NOOP("boresight::ui::QueueModel", "Margin,\n%"),
     QT_TRANSLATE_NOOP("boresight::ui::QueueModel",
                       "How far the worst check's figure is on the good side of its limit, in "
                       "percent of the limit; negative: beyond it."),
     0},
    {QT_TRANSLATE_NOOP("boresight::ui::QueueModel", "From\nseed"),
     QT_TRANSLATE_NOOP("boresight::ui::QueueModel",
                       "How far the result is from the seed, in mm and mrad, and as a part of the "
                       "seed's stated uncertainty (100 %: on its border)."),
     0},
    {QT_TRANSLATE_NOOP("boresight::ui::QueueModel", "Inliers"),
     QT_TRANSLATE_NOOP("boresight::ui::QueueModel", "Inliers of the last matching iteration."), 0},
};
static_assert(std::size(kColumns) == QueueModel::kColumnCount);

double numberOf(const QueueRow& row, int column) {
  if (column == QueueModel::kMargin) return row.margin.value_or(kNaN);
  if (column == QueueModel::kFromSeed) return row.from_seed ? row.from_seed->share : kNaN;
  return row.iterations > 0 ? row.inliers : kNaN;
}

/// Whether what the row says of its checks is of the document as it is.
QString remarkOf(const QueueEntry& entry) {
  if (entry.checked) return {};
  return entry.row.checks.empty() ? QueueModel::tr("… being checked")
                                  : QueueModel::tr(" … being checked again");
}

QString troubleOf(const QueueEntry& entry) {
  const QueueRow& row = entry.row;
  const bool unknown = !entry.checked && row.checks.empty() && row.group == QueueGroup::kOpen;
  QString text = unknown ? QString() : fromText(sessions::troubleText(row));
  if (!text.isEmpty()) text[0] = text[0].toUpper();
  return text + (row.group == QueueGroup::kOpen ? remarkOf(entry) : QString());
}

QString fromSeedText(const QueueRow& row) {
  if (!row.from_seed) return {};
  return QueueModel::tr("%1 %\n%2 mm\n%3 mrad")
      .arg(numberText(kPercent * row.from_seed->share, 0),
           numberText(row.from_seed->translation_mm, 1),
           numberText(row.from_seed->rotation_mrad, 1));
}

QString tooltipOf(const QueueEntry& entry, int column) {
  const QueueRow& row = entry.row;
  if (column == QueueModel::kMargin && !row.margin_of.empty())
    return QueueModel::tr("Of the check '%1'").arg(fromText(row.margin_of));
  QString text = fromText(row.case_id) + QLatin1Char('\n') + fromText(row.standing_text) +
                 QLatin1Char('\n') + troubleOf(entry);
  for (const sessions::Check& check : row.checks)
    if (check.state == sessions::CheckState::kFailed)
      text += QStringLiteral("\n✗ ") + fromText(check.title) + QStringLiteral(": ") +
              fromText(check.sentence);
  return text;
}

}  // namespace

QueueModel::QueueModel(QObject* parent) : QAbstractTableModel(parent) {}

void QueueModel::setEntries(std::vector<QueueEntry> entries) {
  const bool same = std::equal(
      entries.begin(), entries.end(), entries_.begin(), entries_.end(),
      [](const QueueEntry& a, const QueueEntry& b) { return a.row.case_id == b.row.case_id; });
  if (!same) beginResetModel();
  entries_ = std::move(entries);
  if (!same)
    endResetModel();
  else if (!entries_.empty())
    Q_EMIT dataChanged(index(0, 0), index(rowCount() - 1, kColumnCount - 1));
}

int QueueModel::rowOf(const QString& id) const {
  const auto found = std::find_if(
      entries_.begin(), entries_.end(),
      [wanted = id.toStdString()](const QueueEntry& one) { return one.row.case_id == wanted; });
  return found == entries_.end() ? -1 : static_cast<int>(found - entries_.begin());
}

QString QueueModel::standingText(const QueueRow& row) {
  if (row.group == QueueGroup::kAwaits) return tr("☆ to be approved");
  switch (row.standing) {
    case CaseStanding::kNew:
      return tr("○ new");
    case CaseStanding::kConverged:
      return tr("✓ converged");
    case CaseStanding::kFailed:
      return tr("✗ failed");
    case CaseStanding::kAnnotated:
      return tr("✎ annotated");
    case CaseStanding::kValidated:
      return tr("★ validated");
    case CaseStanding::kRejected:
      return tr("⊘ rejected");
  }
  return {};
}

QString QueueModel::textOf(const QueueEntry& entry, int column) const {
  switch (column) {
    case kCase:
      return fromText(entry.row.case_id);
    case kStanding:
      return standingText(entry.row);
    case kTrouble:
      return troubleOf(entry);
    case kMargin:
      return numberText(kPercent * numberOf(entry.row, column), 0);
    case kFromSeed:
      return fromSeedText(entry.row);
    default:
      return numberText(numberOf(entry.row, column), 0);
  }
}

int QueueModel::rowCount(const QModelIndex& parent) const {
  return parent.isValid() ? 0 : static_cast<int>(entries_.size());
}

int QueueModel::columnCount(const QModelIndex& parent) const {
  return parent.isValid() ? 0 : kColumnCount;
}

QVariant QueueModel::data(const QModelIndex& index, int role) const {
  if (!index.isValid() || index.row() >= rowCount()) return {};
  const QueueEntry& entry = entryAt(index.row());
  const int column = index.column();
  switch (role) {
    case Qt::DisplayRole:
      return textOf(entry, column);
    case Qt::ToolTipRole:
      return tooltipOf(entry, column);
    case Qt::DecorationRole:
      if (column != kCase || entry.thumbnail.isNull()) return {};
      return QIcon(QPixmap::fromImage(entry.thumbnail));
    default:
      return columnCell(kContext, kColumns[column], role);
  }
}

QVariant QueueModel::headerData(int section, Qt::Orientation orientation, int role) const {
  return columnHeader(kContext, kColumns, section, orientation, role);
}

QueueFilter::QueueFilter(QueueModel& model, QObject* parent)
    : QSortFilterProxyModel(parent), model_(model) {
  setSourceModel(&model);
  setDynamicSortFilter(true);
}

void QueueFilter::setText(const QString& text) {
  text_ = text.trimmed();
  invalidateFilter();
}

bool QueueFilter::filterAcceptsRow(int row, const QModelIndex& /*parent*/) const {
  if (text_.isEmpty()) return true;
  for (const int column : {QueueModel::kCase, QueueModel::kStanding, QueueModel::kTrouble})
    if (model_.index(row, column).data().toString().contains(text_, Qt::CaseInsensitive))
      return true;
  return false;
}

bool QueueFilter::lessThan(const QModelIndex& left, const QModelIndex& right) const {
  const QueueRow& a = model_.entryAt(left.row()).row;
  const QueueRow& b = model_.entryAt(right.row()).row;
  const int column = left.column();
  if (column == QueueModel::kTrouble) return sessions::moreTrouble(a, b);
  if (column <= QueueModel::kStanding)
    return left.data().toString().localeAwareCompare(right.data().toString()) < 0;
  const double one = numberOf(a, column);
  const double other = numberOf(b, column);
  if (std::isnan(one) || std::isnan(other))
    return std::isnan(one) != std::isnan(other) &&
           std::isnan(sortOrder() == Qt::AscendingOrder ? other : one);
  return one < other;
}

}  // namespace boresight::ui
