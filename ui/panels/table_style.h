// SPDX-License-Identifier: Apache-2.0
#pragma once

QT_BEGIN_NAMESPACE
class QTableView;
QT_END_NAMESPACE

namespace boresight::ui {

/// How all tables look: whole rows, one at a time, no row numbers, compact, columns as wide as what
/// they hold.
void styleTable(QTableView& table);
/// Columns as wide as their heads and cells are now.
void fitColumns(QTableView& table);

}  // namespace boresight::ui
