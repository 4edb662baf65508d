// SPDX-License-Identifier: Apache-2.0
#include "ui/models/rows_model.h"

#include <cmath>

namespace boresight::ui {

QFont boldFont(QFont font, bool bold) {
  font.setBold(bold);
  return font;
}

QVariant columnAlignment(int decimals) {
  return static_cast<int>((decimals >= 0 ? Qt::AlignRight : Qt::AlignLeft) | Qt::AlignVCenter);
}

RowsFilter::RowsFilter() { setSortRole(kSortRole); }

void RowsFilter::setCondition(Condition condition) {
  condition_ = std::move(condition);
  invalidateFilter();
}

bool RowsFilter::filterAcceptsRow(int row, const QModelIndex& /*parent*/) const {
  return !condition_ || condition_(row);
}

bool RowsFilter::lessThan(const QModelIndex& left, const QModelIndex& right) const {
  const QVariant first = left.data(sortRole());
  const QVariant second = right.data(sortRole());
  if (first.userType() == QMetaType::QString && second.userType() == QMetaType::QString)
    return QString::localeAwareCompare(first.toString(), second.toString()) < 0;
  const double a = first.toDouble();
  const double b = second.toDouble();
  if (std::isnan(a) || std::isnan(b))
    return std::isnan(a) != std::isnan(b) && std::isnan(sortOrder() == Qt::AscendingOrder ? b : a);
  return a < b;
}

}  // namespace boresight::ui
