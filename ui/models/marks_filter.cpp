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
  const MarkFacts facts = model->factsOf(row);
  switch (show_) {
    case Show::kUsed:
      return facts.enabled && facts.complete;
    case Show::kOff:
      return !facts.enabled;
    case Show::kHalfMade:
      return !facts.complete;
    case Show::kStandOut:
      return model->standsOut(row);
    case Show::kLines:
      return facts.line != nullptr;
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
