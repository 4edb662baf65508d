// SPDX-License-Identifier: Apache-2.0
#include "ui/review/queue_model.h"

#include <limits>
#include <utility>

#include <QIcon>
#include <QPixmap>

#include "ui/models/cases_model.h"
#include "ui/models/html_table.h"

namespace boresight::ui {

using sessions::RunChange;
using sessions::RunDifference;

namespace {

QString signOf(RunChange change) {
  return change == RunChange::kBetter  ? DifferencesModel::tr("▲ better")
         : change == RunChange::kWorse ? DifferencesModel::tr("▼ worse")
                                       : DifferencesModel::tr("= same");
}

QString beforeAndNow(int before, int now) { return QStringLiteral("%1 → %2").arg(before).arg(now); }

QString apartText(const RunDifference& made) {
  if (!made.before.converged || !made.after.converged) return {};
  return DifferencesModel::tr("%1 mm, %2 mrad")
      .arg(numberText(made.comparison.translation_mm, 3),
           numberText(made.comparison.rotation_mrad, 3));
}

using Difference = const RunDifference&;

/// A cell of a case that has a difference; nothing of others.
template <class Value>
auto ofDifference(Value value) {
  return [value](const DifferenceEntry& entry) {
    return entry.difference ? QVariant(value(*entry.difference)) : QVariant();
  };
}

/// Sorted with the worse ones first when it ascends.
std::vector<TableColumn<DifferenceEntry>> differenceColumns() {
  constexpr auto tr = [](const char* text) { return DifferencesModel::tr(text); };
  return {
      {tr("Case"), tr("The case."), -1,
       [](const DifferenceEntry& entry) { return fromText(entry.case_id); }},
      {tr("Change"),
       tr("Whether the last run is better than the one before: by the truth where it is known, "
          "else by the checks."),
       -1, ofDifference([](Difference made) { return signOf(made.change); }),
       ofDifference([](Difference made) {
         return made.change == RunChange::kWorse ? 0 : made.change == RunChange::kBetter ? 1 : 2;
       })},
      {tr("Failed checks"), tr("How many failed: before, and now."), 0,
       ofDifference([](Difference made) {
         return beforeAndNow(made.before.checks_failed, made.after.checks_failed);
       }),
       ofDifference(
           [](Difference made) { return made.after.checks_failed - made.before.checks_failed; })},
      {tr("Inliers"), tr("Inliers of the last matching iteration: before, and now."), 0,
       ofDifference(
           [](Difference made) { return beforeAndNow(made.before.inliers, made.after.inliers); }),
       ofDifference([](Difference made) { return made.after.inliers - made.before.inliers; })},
      {tr("Poses apart"), tr("How far the two results are apart at the camera, in mm and mrad."), 0,
       ofDifference(apartText),
       ofDifference([](Difference made) { return made.comparison.translation_mm; })},
      {tr("Why, and where they differ first"),
       tr("What the change is judged by, and the first thing in which the runs are not the same to "
          "the bit."),
       -1, ofDifference([](Difference made) { return fromText(sessions::changeText(made)); })},
  };
}

QString tableHtml(const RunDifference& made) {
  QVector<QStringList> rows = {
      {QString(), DifferencesModel::tr("before"), DifferencesModel::tr("now")}};
  for (const sessions::DifferenceLine& line : sessions::differenceLines(made))
    rows.append({fromText(line.label).toHtmlEscaped(), fromText(line.before).toHtmlEscaped(),
                 fromText(line.after).toHtmlEscaped()});
  return htmlTable(rows) +
         QStringLiteral("<p>%1</p>").arg(fromText(sessions::changeText(made)).toHtmlEscaped());
}

}  // namespace

DifferencesModel::DifferencesModel(QObject* parent) : RowsModel(differenceColumns(), parent) {}

void DifferencesModel::setEntries(std::vector<DifferenceEntry> entries) {
  setRowsByKey(std::move(entries), [](const DifferenceEntry& entry) { return entry.case_id; });
}

QVariant DifferencesModel::look(const DifferenceEntry& entry, int column, int role) const {
  const bool tip = role == Qt::ToolTipRole;
  if (entry.difference) return tip ? tableHtml(*entry.difference) : QVariant();
  if (!tip && (role != Qt::DisplayRole || column != kWhy)) return {};
  return entry.problem.isEmpty() ? tr("… being compared") : entry.problem;
}

using sessions::QueueGroup;
using sessions::QueueRow;

namespace {

constexpr double kToPercent = 100.0;
constexpr double kNaN = std::numeric_limits<double>::quiet_NaN();
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
      .arg(numberText(kToPercent * row.from_seed->share, 0),
           numberText(row.from_seed->translation_mm, 1),
           numberText(row.from_seed->rotation_mrad, 1));
}

QString tooltipOf(const QueueEntry& entry, int column) {
  const QueueRow& row = entry.row;
  if (column == QueueModel::kMargin && !row.margin_of.empty())
    return QueueModel::tr("Of the check '%1'").arg(fromText(row.margin_of));
  QString text = fromText(row.case_id) + QLatin1Char('\n') + fromText(row.review_status_text) +
                 QLatin1Char('\n') + troubleOf(entry);
  for (const sessions::Check& check : row.checks)
    if (check.state == sessions::CheckState::kFailed)
      text += QStringLiteral("\n✗ ") + fromText(check.title) + QStringLiteral(": ") +
              fromText(check.sentence);
  return text;
}

std::vector<TableColumn<QueueEntry>> queueColumns() {
  using Entry = const QueueEntry&;
  constexpr auto tr = [](const char* text) { return QueueModel::tr(text); };
  return {
      {tr("Case"),
       tr("The case, with the edges of its result over the image; red: those of the seed, as "
          "there is no result."),
       -1, [](Entry entry) { return fromText(entry.row.case_id); }},
      {tr("State"), tr("Where the case stands."), -1,
       [](Entry entry) { return QueueModel::reviewStatusText(entry.row); }},
      {tr("Trouble"),
       tr("What to look at. Sorted by it: failed runs, then failed checks, then the margin, then "
          "the distance from the seed; what is decided comes last."),
       -1, troubleOf},
      {tr("Margin,\n%"),
       tr("How far the worst check's figure is on the good side of its limit, in percent of the "
          "limit; negative: beyond it."),
       0, [](Entry entry) { return kToPercent * entry.row.margin.value_or(kNaN); }},
      {tr("From\nseed"),
       tr("How far the result is from the seed, in mm and mrad, and as a part of the seed's stated "
          "uncertainty (100 %: on its border)."),
       0, [](Entry entry) { return fromSeedText(entry.row); },
       [](Entry entry) { return entry.row.from_seed ? entry.row.from_seed->share : kNaN; }},
      {tr("Inliers"), tr("Inliers of the last matching iteration."), 0,
       [](Entry entry) { return entry.row.iterations > 0 ? entry.row.inliers : kNaN; }},
  };
}

}  // namespace

QueueModel::QueueModel(QObject* parent) : RowsModel(queueColumns(), parent) {}

void QueueModel::setEntries(std::vector<QueueEntry> entries) {
  setRowsByKey(std::move(entries), [](const QueueEntry& entry) { return entry.row.case_id; });
}

int QueueModel::rowOf(const QString& id) const {
  return firstRow(
      [wanted = id.toStdString()](const QueueEntry& entry) { return entry.row.case_id == wanted; });
}

QString QueueModel::reviewStatusText(const QueueRow& row) {
  if (row.group == QueueGroup::kAwaits) return tr("☆ to be approved");
  return CasesModel::stateText(caseStateOf(row.review_state));
}

QVariant QueueModel::look(const QueueEntry& entry, int column, int role) const {
  if (role == Qt::ToolTipRole) return tooltipOf(entry, column);
  if (role != Qt::DecorationRole || column != kCase || entry.thumbnail.isNull()) return {};
  return QIcon(QPixmap::fromImage(entry.thumbnail));
}

QueueFilter::QueueFilter(QueueModel& model, QObject* parent) : RowsFilter(parent), model_(model) {
  setSourceModel(&model);
}

void QueueFilter::setText(const QString& text) {
  setCondition([this, words = text.trimmed()](int row) {
    for (const int column : {QueueModel::kCase, QueueModel::kStatus, QueueModel::kTrouble})
      if (model_.index(row, column).data().toString().contains(words, Qt::CaseInsensitive))
        return true;
    return false;
  });
}

bool QueueFilter::lessThan(const QModelIndex& left, const QModelIndex& right) const {
  if (left.column() != QueueModel::kTrouble) return RowsFilter::lessThan(left, right);
  return sessions::moreTrouble(model_.at(left.row()).row, model_.at(right.row()).row);
}

}  // namespace boresight::ui
