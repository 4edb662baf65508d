// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <map>
#include <vector>

#include <QObject>

class QTableView;

namespace boresight::ui {

/// Keeps a table from scrolling sideways: where it is too narrow, columns that can be done without
/// are hidden, the first of the list first, and come back where there is room. Once the operator
/// has chosen columns, those stay. Belongs to the table.
class ColumnFitter : public QObject {
  Q_OBJECT

 public:
  /// The table must have its model already.
  ColumnFitter(QTableView& table, std::vector<int> dispensable);

 protected:
  bool eventFilter(QObject* watched, QEvent* event) override;

 private:
  void fit();
  int widthOf(int column) const;
  void show(int column, bool shown);

  QTableView& table_;
  std::vector<int> dispensable_;
  std::map<int, int> hidden_;  ///< by this object, with their widths
  bool fitting_ = false;
};

}  // namespace boresight::ui
