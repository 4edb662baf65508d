// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <span>

#include <QVariant>

namespace boresight::ui {

/// One column of a table as its model describes it; the texts are those of a translation context.
struct ColumnInfo {
  const char* title;
  const char* help;  ///< with the unit
  int decimals;      ///< of its numbers; -1: text
};

/// What is the same for every cell of a column: the help as a tooltip, numbers to the right.
/// Nothing for other roles.
QVariant columnCell(const char* context, const ColumnInfo& info, int role);
/// Title and help of a column; nothing for rows and for columns that there are not.
QVariant columnHeader(const char* context, std::span<const ColumnInfo> columns, int section,
                      Qt::Orientation orientation, int role);

}  // namespace boresight::ui
