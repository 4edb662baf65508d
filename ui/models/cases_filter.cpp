// SPDX-License-Identifier: Apache-2.0
#include "ui/models/cases_filter.h"

#include <cmath>

namespace boresight::ui {

CasesFilter::CasesFilter(QObject* parent) : QSortFilterProxyModel(parent) {
  setSortRole(CasesModel::kSortRole);
}

void CasesFilter::setText(const QString& text) {
  text_ = text.trimmed();
  invalidateFilter();
}

void CasesFilter::setState(std::optional<CaseState> state) {
  state_ = state;
  invalidateFilter();
}

bool CasesFilter::filterAcceptsRow(int row, const QModelIndex& /*parent*/) const {
  const auto* cases = qobject_cast<const CasesModel*>(sourceModel());
  if (cases == nullptr) return true;
  const CaseRow& one = cases->caseAt(row);
  if (state_ && one.state != *state_) return false;
  return one.id.contains(text_, Qt::CaseInsensitive) ||
         one.station.contains(text_, Qt::CaseInsensitive);
}

bool CasesFilter::lessThan(const QModelIndex& left, const QModelIndex& right) const {
  if (left.column() < CasesModel::kNormal_mm) return QSortFilterProxyModel::lessThan(left, right);
  const double a = left.data(sortRole()).toDouble();
  const double b = right.data(sortRole()).toDouble();
  if (std::isnan(a) && std::isnan(b)) return false;
  if (std::isnan(a)) return sortOrder() == Qt::DescendingOrder;
  if (std::isnan(b)) return sortOrder() == Qt::AscendingOrder;
  return a < b;
}

}  // namespace boresight::ui
