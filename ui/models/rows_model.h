// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <algorithm>
#include <functional>
#include <utility>
#include <vector>

#include <QAbstractTableModel>
#include <QFont>
#include <QSortFilterProxyModel>

#include "ui/models/text.h"

namespace boresight::ui {

/// Sort key of a column: a text, or a number (NaN where there is none).
inline constexpr int kSortRole = Qt::UserRole;

/// One column of a table: its head, and the content of its cells.
template <class Row>
struct TableColumn {
  using Value = std::function<QVariant(const Row& row)>;

  TableColumn(QString title_, QString help_, int decimals_, Value value_, Value sort_ = Value())
      : title(std::move(title_)),
        help(std::move(help_)),
        decimals(decimals_),
        value(std::move(value_)),
        sort(std::move(sort_)) {}

  QString title;
  QString help;  ///< with the unit: tool tip of the head, and of cells without their own
  int decimals;  ///< of its numbers; -1: text
  Value value;   ///< a number (NaN: none) or a text
  Value sort;    ///< sort key, if it is not the value
};

/// The font, bold or not.
QFont boldFont(QFont font = QFont(), bool bold = true);

/// Of cells and heads: numbers to the right, texts to the left.
QVariant columnAlignment(int decimals);

/// A table of rows of one type, whose columns are functions of a row.
template <class Row>
class RowsModel : public QAbstractTableModel {
 public:
  explicit RowsModel(std::vector<TableColumn<Row>> columns) : columns_(std::move(columns)) {}

  const std::vector<Row>& rows() const { return rows_; }
  const Row& at(int row) const { return rows_[static_cast<std::size_t>(row)]; }
  /// The first row for which `test` holds, or -1.
  template <class Test>
  int firstRow(Test&& test) const {
    for (int row = 0; row < rowCount(); ++row)
      if (test(at(row))) return row;
    return -1;
  }

  int rowCount(const QModelIndex& parent = {}) const override {
    return parent.isValid() ? 0 : static_cast<int>(rows_.size());
  }
  int columnCount(const QModelIndex& parent = {}) const override {
    return parent.isValid() ? 0 : static_cast<int>(columns_.size());
  }

  QVariant data(const QModelIndex& index, int role = Qt::DisplayRole) const override {
    if (!index.isValid() || index.row() >= rowCount()) return {};
    const Row& row = at(index.row());
    const QVariant own = look(row, index.column(), role);
    return own.isValid() ? own
                         : cell(row, columns_[static_cast<std::size_t>(index.column())], role);
  }

  QVariant headerData(int section, Qt::Orientation orientation,
                      int role = Qt::DisplayRole) const override {
    if (orientation != Qt::Horizontal || section < 0 || section >= columnCount()) return {};
    const TableColumn<Row>& column = columns_[static_cast<std::size_t>(section)];
    if (role == Qt::DisplayRole) return column.title;
    if (role == Qt::TextAlignmentRole) return columnAlignment(column.decimals);
    return role == Qt::ToolTipRole ? column.help : QVariant();
  }

  /// With `continues`, rows change in place and new ones are appended, so that selections and
  /// editors stay.
  void setRows(std::vector<Row> rows, bool continues) {
    const int before = rowCount();
    const int after = static_cast<int>(rows.size());
    if (!continues || after < before) {
      beginResetModel();
      rows_ = std::move(rows);
      endResetModel();
      return;
    }
    if (after > before) beginInsertRows({}, before, after - 1);
    rows_ = std::move(rows);
    if (after > before) endInsertRows();
    if (before > 0) Q_EMIT dataChanged(index(0, 0), index(before - 1, columnCount() - 1));
  }

  void setRow(int row, Row value) {
    rows_[static_cast<std::size_t>(row)] = std::move(value);
    Q_EMIT dataChanged(index(row, 0), index(row, columnCount() - 1));
  }

  /// Changes rows in place when `key` is equal for all rows.
  template <class Key>
  void setRowsByKey(std::vector<Row> rows, Key&& key) {
    const bool same = std::equal(
        rows.begin(), rows.end(), rows_.begin(), rows_.end(),
        [&key](const Row& a, const Row& b) { return std::invoke(key, a) == std::invoke(key, b); });
    setRows(std::move(rows), same);
  }

 protected:
  /// For changes on which no order depends: whoever changes the row updates the views.
  Row& changeable(int row) { return rows_[static_cast<std::size_t>(row)]; }

  /// Value of a cell for a role; an invalid one leaves it to the column.
  virtual QVariant look(const Row& /*row*/, int /*column*/, int /*role*/) const { return {}; }

  QVariant valueOf(const Row& row, int column) const {
    return columns_[static_cast<std::size_t>(column)].value(row);
  }

 private:
  static QVariant cell(const Row& row, const TableColumn<Row>& column, int role) {
    switch (role) {
      case Qt::DisplayRole: {
        const QVariant value = column.value(row);
        const bool text = column.decimals < 0 || value.userType() == QMetaType::QString;
        return text ? value : numberText(value.toDouble(), column.decimals);
      }
      case kSortRole:
        return column.sort ? column.sort(row) : column.value(row);
      case Qt::ToolTipRole:
        return column.help;
      case Qt::TextAlignmentRole:
        return columnAlignment(column.decimals);
      default:
        return {};
    }
  }

  std::vector<TableColumn<Row>> columns_;
  std::vector<Row> rows_;
};

/// Rows of a table that fulfil a condition, sorted by number or text; rows without a number come
/// last in either order.
class RowsFilter : public QSortFilterProxyModel {
  Q_OBJECT

 public:
  using Condition = std::function<bool(int row)>;

  RowsFilter();

  /// Condition for rows of the source; without one all rows are shown.
  void setCondition(Condition condition);

 protected:
  bool filterAcceptsRow(int row, const QModelIndex& parent) const override;
  bool lessThan(const QModelIndex& left, const QModelIndex& right) const override;

 private:
  Condition condition_;
};

}  // namespace boresight::ui
