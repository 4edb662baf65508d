// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <map>
#include <vector>

#include <QObject>

class QAbstractItemView;
class QHeaderView;
class QTableView;
class QTreeView;

namespace boresight::ui {

/// Keeps a table or a tree from scrolling sideways. When it is too narrow, dispensable columns are
/// hidden, the first of the list first; they reappear when there is room. Once the operator has
/// chosen columns, those stay. Belongs to the view.
class ColumnFitter : public QObject {
  Q_OBJECT

 public:
  /// The view must have its model already.
  ColumnFitter(QTableView& table, std::vector<int> dispensable);
  ColumnFitter(QTreeView& tree, std::vector<int> dispensable);

 protected:
  bool eventFilter(QObject* watched, QEvent* event) override;

 private:
  ColumnFitter(QAbstractItemView& view, QHeaderView& header, std::vector<int> dispensable);

  void fit();
  int widthOf(int column) const;
  void show(int column, bool shown);

  QAbstractItemView& view_;
  QHeaderView& header_;
  std::vector<int> dispensable_;
  std::map<int, int> hidden_;  ///< hidden by this object, with their widths
  bool fitting_ = false;
};

}  // namespace boresight::ui
