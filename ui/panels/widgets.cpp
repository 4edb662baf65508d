// SPDX-License-Identifier: Apache-2.0
#include "ui/panels/widgets.h"

#include <QtWidgets>

namespace boresight::ui {

void styleTable(QTableView& table) {
  table.setSelectionBehavior(QAbstractItemView::SelectRows);
  table.setSelectionMode(QAbstractItemView::SingleSelection);
  table.setEditTriggers(QAbstractItemView::NoEditTriggers);
  table.setAlternatingRowColors(true);
  table.setWordWrap(false);
  table.setTabKeyNavigation(false);
  table.setShowGrid(false);
  table.setHorizontalScrollMode(QAbstractItemView::ScrollPerPixel);
  table.verticalHeader()->hide();
  table.verticalHeader()->setDefaultSectionSize(table.fontMetrics().height() + 6);
  table.horizontalHeader()->setHighlightSections(false);
}

void setUpTable(QTableView& table, QAbstractItemModel& model) {
  table.setModel(&model);
  styleTable(table);
}

void addRow(QTableWidget& table, const QStringList& texts) {
  const int row = table.rowCount();
  table.setRowCount(row + 1);
  for (int column = 0; column < texts.size(); ++column) {
    auto* item = new QTableWidgetItem(texts[column]);
    item->setTextAlignment((column > 0 ? Qt::AlignRight : Qt::AlignLeft) | Qt::AlignVCenter);
    table.setItem(row, column, item);
  }
}

void setTip(QAction& action, const QString& tip) {
  const QKeySequence keys = action.shortcut();
  action.setToolTip(
      keys.isEmpty() ? tip
                     : QStringLiteral("%1 (%2)").arg(tip, keys.toString(QKeySequence::NativeText)));
  action.setStatusTip(tip);
}

EmptyHint::EmptyHint(QAbstractItemView& view, int least_rows)
    : QLabel(view.viewport()), view_(view), least_rows_(least_rows) {
  setObjectName(QStringLiteral("emptyHint"));
  setAlignment(Qt::AlignCenter);
  setWordWrap(true);
  setMargin(12);
  setAttribute(Qt::WA_TransparentForMouseEvents);
  view.viewport()->installEventFilter(this);
  const QAbstractItemModel* model = view.model();
  connect(model, &QAbstractItemModel::modelReset, this, &EmptyHint::showOrHide);
  connect(model, &QAbstractItemModel::rowsInserted, this, &EmptyHint::showOrHide);
  connect(model, &QAbstractItemModel::rowsRemoved, this, &EmptyHint::showOrHide);
  connect(model, &QAbstractItemModel::layoutChanged, this, &EmptyHint::showOrHide);
  showOrHide();
}

void EmptyHint::showOrHide() {
  setGeometry(view_.viewport()->rect());
  setVisible(view_.model()->rowCount() <= least_rows_);
}

bool EmptyHint::eventFilter(QObject* watched, QEvent* event) {
  if (event->type() == QEvent::Resize) setGeometry(view_.viewport()->rect());
  return QLabel::eventFilter(watched, event);
}

}  // namespace boresight::ui
