// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <vector>

#include <QAbstractTableModel>
#include <QSortFilterProxyModel>

#include "ui/review/queue_controller.h"

namespace boresight::ui {

/// The queue's cases as a table.
class QueueModel : public QAbstractTableModel {
  Q_OBJECT

 public:
  enum Column { kCase, kStanding, kTrouble, kMargin, kFromSeed, kInliers, kColumnCount };

  explicit QueueModel(QObject* parent = nullptr);

  /// Rows of the same cases change in place, so that selections stay.
  void setEntries(std::vector<QueueEntry> entries);
  const QueueEntry& entryAt(int row) const { return entries_[static_cast<std::size_t>(row)]; }
  /// -1 where there is none.
  int rowOf(const QString& id) const;
  /// Where a case stands: a word with a sign of its own shape before it.
  static QString standingText(const sessions::QueueRow& row);

  int rowCount(const QModelIndex& parent = {}) const override;
  int columnCount(const QModelIndex& parent = {}) const override;
  QVariant data(const QModelIndex& index, int role = Qt::DisplayRole) const override;
  QVariant headerData(int section, Qt::Orientation orientation, int role) const override;

 private:
  QString textOf(const QueueEntry& entry, int column) const;

  std::vector<QueueEntry> entries_;
};

/// Cases whose id, state or trouble holds a text. By trouble they are in the queue's order, by
/// another column in that one's; those without a number come last either way.
class QueueFilter : public QSortFilterProxyModel {
  Q_OBJECT

 public:
  explicit QueueFilter(QueueModel& model, QObject* parent = nullptr);

  void setText(const QString& text);

 protected:
  bool filterAcceptsRow(int row, const QModelIndex& parent) const override;
  bool lessThan(const QModelIndex& left, const QModelIndex& right) const override;

 private:
  QueueModel& model_;
  QString text_;
};

}  // namespace boresight::ui
