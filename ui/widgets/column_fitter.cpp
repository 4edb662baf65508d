// SPDX-License-Identifier: Apache-2.0
#include "ui/widgets/column_fitter.h"

#include <algorithm>
#include <utility>

#include <QtWidgets>

#include "ui/widgets/widgets.h"

namespace boresight::ui {

ColumnFitter::ColumnFitter(QTableView& table, std::vector<int> dispensable)
    : ColumnFitter(table, *table.horizontalHeader(), std::move(dispensable)) {}

ColumnFitter::ColumnFitter(QTreeView& tree, std::vector<int> dispensable)
    : ColumnFitter(tree, *tree.header(), std::move(dispensable)) {}

ColumnFitter::ColumnFitter(QAbstractItemView& view, QHeaderView& header,
                           std::vector<int> dispensable)
    : QObject(&view), view_(view), header_(header), dispensable_(std::move(dispensable)) {
  view_.viewport()->installEventFilter(this);
  const auto fit_later = [this] {
    QMetaObject::invokeMethod(this, &ColumnFitter::fit, Qt::QueuedConnection);
  };
  connectEach(*view_.model(), this, fit_later, &QAbstractItemModel::modelReset,
              &QAbstractItemModel::rowsInserted, &QAbstractItemModel::layoutChanged);
}

bool ColumnFitter::eventFilter(QObject* watched, QEvent* event) {
  if (event->type() == QEvent::Resize) fit();
  return QObject::eventFilter(watched, event);
}

/// The width that a column needs: the last one may be stretched over what is left.
int ColumnFitter::widthOf(int column) const {
  const auto hidden = hidden_.find(column);
  if (hidden != hidden_.end()) return hidden->second;
  const bool stretched = header_.stretchLastSection() && column == header_.count() - 1;
  return stretched ? header_.sectionSizeHint(column) : header_.sectionSize(column);
}

void ColumnFitter::show(int column, bool shown) {
  const auto hidden = hidden_.find(column);
  if (shown == (hidden == hidden_.end())) return;
  if (!shown) {
    hidden_[column] = widthOf(column);
    header_.setSectionHidden(column, true);
    return;
  }
  const int width = hidden->second;
  hidden_.erase(hidden);
  header_.setSectionHidden(column, false);
  // A view that fits columns to their contents takes hidden ones for empty.
  header_.resizeSection(column, std::max(width, header_.sectionSize(column)));
}

void ColumnFitter::fit() {
  if (fitting_ || hasChosenColumns(view_)) return;
  fitting_ = true;  // a scroll bar that goes makes the viewport larger
  int room = view_.viewport()->width();
  for (int column = 0; column < header_.count(); ++column)
    if (std::find(dispensable_.begin(), dispensable_.end(), column) == dispensable_.end())
      room -= widthOf(column);
  for (auto column = dispensable_.rbegin(); column != dispensable_.rend(); ++column) {
    const int width = widthOf(*column);
    const bool fits = width <= room;
    room = fits ? room - width : 0;  // what is less important does not take its place
    show(*column, fits);
  }
  fitting_ = false;
}

}  // namespace boresight::ui
