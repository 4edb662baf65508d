// SPDX-License-Identifier: Apache-2.0
#include "ui/models/templates_filter.h"

#include <cmath>

#include "ui/models/templates_model.h"

namespace boresight::ui {

TemplatesFilter::TemplatesFilter(QObject* parent) : QSortFilterProxyModel(parent) {
  setSortRole(TemplatesModel::kNumberRole);
}

void TemplatesFilter::setShow(Show show) {
  show_ = show;
  invalidateFilter();
}

QString TemplatesFilter::nameOf(Show show) {
  switch (show) {
    case Show::kAll:
      return tr("All");
    case Show::kInliers:
      return tr("Inliers");
    case Show::kOutliers:
      return tr("Outliers");
    case Show::kLowMargin:
      return tr("Low margin (under %1 %)").arg(100.0 * sessions::kLowMargin);
    case Show::kAtBorder:
      return tr("At the window's border");
    case Show::kNotSearched:
      return tr("Not searched");
  }
  return {};
}

bool TemplatesFilter::filterAcceptsRow(int row, const QModelIndex& /*parent*/) const {
  const auto* templates = qobject_cast<const TemplatesModel*>(sourceModel());
  if (templates == nullptr) return true;
  const sessions::MatchDetails& one = templates->details(row);
  switch (show_) {
    case Show::kAll:
      return true;
    case Show::kInliers:
      return one.inlier;
    case Show::kOutliers:
      return one.solved && !one.inlier;
    case Show::kLowMargin:
      return one.hasLowMargin();
    case Show::kAtBorder:
      return one.at_border;
    case Show::kNotSearched:
      return !one.searched;
  }
  return true;
}

bool TemplatesFilter::lessThan(const QModelIndex& left, const QModelIndex& right) const {
  const double a = left.data(sortRole()).toDouble();
  const double b = right.data(sortRole()).toDouble();
  if (std::isnan(a) && std::isnan(b)) return false;
  if (std::isnan(a)) return sortOrder() == Qt::DescendingOrder;
  if (std::isnan(b)) return sortOrder() == Qt::AscendingOrder;
  return a < b;
}

}  // namespace boresight::ui
