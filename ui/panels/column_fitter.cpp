// SPDX-License-Identifier: Apache-2.0
#include "ui/panels/column_fitter.h"

#include <algorithm>
#include <utility>

#include <QtWidgets>

#include "ui/panels/widgets.h"

namespace boresight::ui {

ColumnFitter::ColumnFitter(QTableView& table, std::vector<int> dispensable)
    : QObject(&table), table_(table), dispensable_(std::move(dispensable)) {
  table_.viewport()->installEventFilter(this);
  const QAbstractItemModel* model = table_.model();
  connect(model, &QAbstractItemModel::modelReset, this, &ColumnFitter::fit, Qt::QueuedConnection);
  connect(model, &QAbstractItemModel::rowsInserted, this, &ColumnFitter::fit, Qt::QueuedConnection);
  connect(model, &QAbstractItemModel::layoutChanged, this, &ColumnFitter::fit,
          Qt::QueuedConnection);
}

bool ColumnFitter::eventFilter(QObject* watched, QEvent* event) {
  if (event->type() == QEvent::Resize) fit();
  return QObject::eventFilter(watched, event);
}

int ColumnFitter::widthOf(int column) const {
  const auto hidden = hidden_.find(column);
  return hidden == hidden_.end() ? table_.columnWidth(column) : hidden->second;
}

void ColumnFitter::show(int column, bool shown) {
  if (shown == hidden_.contains(column)) {
    if (shown)
      hidden_.erase(column);
    else
      hidden_[column] = table_.columnWidth(column);
    table_.setColumnHidden(column, !shown);
  }
}

void ColumnFitter::fit() {
  if (fitting_ || hasChosenColumns(table_)) return;
  fitting_ = true;  // a scroll bar that goes makes the viewport larger
  int room = table_.viewport()->width();
  for (int column = 0; column < table_.horizontalHeader()->count(); ++column)
    if (std::find(dispensable_.begin(), dispensable_.end(), column) == dispensable_.end())
      room -= table_.columnWidth(column);
  for (auto column = dispensable_.rbegin(); column != dispensable_.rend(); ++column) {
    const int width = widthOf(*column);
    const bool fits = width <= room;
    room = fits ? room - width : 0;  // what is less important does not take its place
    show(*column, fits);
  }
  fitting_ = false;
}

}  // namespace boresight::ui
