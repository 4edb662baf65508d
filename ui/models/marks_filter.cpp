// SPDX-License-Identifier: Apache-2.0
#include "ui/models/marks_filter.h"

#include <cmath>

#include "ui/models/marks_model.h"

namespace boresight::ui {

MarksFilter::MarksFilter(QObject* parent) : QSortFilterProxyModel(parent) {
  setSortRole(MarksModel::kNumberRole);
}

void MarksFilter::setShow(Show show) {
  show_ = show;
  invalidateFilter();
}

QString MarksFilter::nameOf(Show show) {
  switch (show) {
    case Show::kAll:
      return tr("All");
    case Show::kUsed:
      return tr("In use");
    case Show::kOff:
      return tr("Off");
    case Show::kHalfMade:
      return tr("Half made");
    case Show::kStandOut:
      return tr("Standing out");
    case Show::kLines:
      return tr("Lines");
  }
  return {};
}

bool MarksFilter::filterAcceptsRow(int row, const QModelIndex& /*parent*/) const {
  const auto* model = qobject_cast<const MarksModel*>(sourceModel());
  if (model == nullptr || show_ == Show::kAll) return true;
  const sessions::Marks& marks = model->marks();
  const bool line = model->isLine(row);
  const std::size_t at = static_cast<std::size_t>(row) - (line ? marks.points.size() : 0);
  const bool on = line ? marks.lines[at].enabled : marks.points[at].enabled;
  const bool complete = line ? marks.lines[at].complete() : marks.points[at].complete();
  switch (show_) {
    case Show::kUsed:
      return on && complete;
    case Show::kOff:
      return !on;
    case Show::kHalfMade:
      return !complete;
    case Show::kStandOut:
      return model->standsOut(row);
    case Show::kLines:
      return line;
    case Show::kAll:
      break;
  }
  return true;
}

bool MarksFilter::lessThan(const QModelIndex& left, const QModelIndex& right) const {
  const QVariant first = left.data(sortRole());
  const QVariant second = right.data(sortRole());
  if (left.column() == MarksModel::kName || left.column() == MarksModel::kComment)
    return QString::localeAwareCompare(first.toString(), second.toString()) < 0;
  const double a = first.toDouble();
  const double b = second.toDouble();
  if (std::isnan(a) && std::isnan(b)) return false;
  if (std::isnan(a)) return sortOrder() == Qt::DescendingOrder;
  if (std::isnan(b)) return sortOrder() == Qt::AscendingOrder;
  return a < b;
}

}  // namespace boresight::ui
