// SPDX-License-Identifier: Apache-2.0
#include "ui/models/column_info.h"

#include <QCoreApplication>

namespace boresight::ui {

QVariant columnCell(const char* context, const ColumnInfo& info, int role) {
  if (role == Qt::ToolTipRole) return QCoreApplication::translate(context, info.help);
  if (role == Qt::TextAlignmentRole)
    return static_cast<int>((info.decimals >= 0 ? Qt::AlignRight : Qt::AlignLeft) |
                            Qt::AlignVCenter);
  return {};
}

QVariant columnHeader(const char* context, std::span<const ColumnInfo> columns, int section,
                      Qt::Orientation orientation, int role) {
  const bool exists = section >= 0 && section < static_cast<int>(columns.size());
  if (orientation != Qt::Horizontal || !exists) return {};
  const ColumnInfo& info = columns[static_cast<std::size_t>(section)];
  if (role == Qt::DisplayRole) return QCoreApplication::translate(context, info.title);
  return role == Qt::ToolTipRole ? columnCell(context, info, role) : QVariant();
}

}  // namespace boresight::ui
