// SPDX-License-Identifier: Apache-2.0
#include "ui/panels/table_style.h"

#include <QHeaderView>
#include <QTableView>

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

void fitColumns(QTableView& table) { table.resizeColumnsToContents(); }

}  // namespace boresight::ui
