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

QTableView* newTable(const char* name, const QString& title, QAbstractItemModel& model,
                     QWidget* parent) {
  auto* table = named(new QTableView(parent), name);
  table->setAccessibleName(title);
  table->setModel(&model);
  styleTable(*table);
  return table;
}

QAction* addAction(QMenu& menu, const QString& text, const QKeySequence& keys, const QString& tip) {
  QAction* action = menu.addAction(text);
  action->setShortcut(keys);
  setTip(*action, tip);
  return action;
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
