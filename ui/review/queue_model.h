// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "ui/models/rows_model.h"
#include "ui/review/queue_controller.h"

namespace boresight::ui {

/// What changed between the two last runs of each case, as a table.
class DifferencesModel : public RowsModel<DifferenceEntry> {
  Q_OBJECT

 public:
  enum Column { kCase, kChange, kChecks, kInliers, kApart, kWhy };

  explicit DifferencesModel(QObject* parent = nullptr);

  void setEntries(std::vector<DifferenceEntry> entries);

 protected:
  QVariant look(const DifferenceEntry& entry, int column, int role) const override;
};

/// The queue's cases as a table.
class QueueModel : public RowsModel<QueueEntry> {
  Q_OBJECT

 public:
  enum Column { kCase, kStatus, kTrouble, kMargin, kFromSeed, kInliers };

  explicit QueueModel(QObject* parent = nullptr);

  /// Rows of the same cases change in place, so that selections stay.
  void setEntries(std::vector<QueueEntry> entries);
  /// -1 where there is none.
  int rowOf(const QString& id) const;
  /// Where a case stands: a word with a sign of its own shape before it.
  static QString reviewStatusText(const sessions::QueueRow& row);

 protected:
  QVariant look(const QueueEntry& entry, int column, int role) const override;
};

/// Cases whose id, state or trouble holds a text. By trouble they are in the queue's order, by
/// another column in that one's; those without a number come last either way.
class QueueFilter : public RowsFilter {
  Q_OBJECT

 public:
  explicit QueueFilter(QueueModel& model, QObject* parent = nullptr);

  void setText(const QString& text);

 protected:
  bool lessThan(const QModelIndex& left, const QModelIndex& right) const override;

 private:
  QueueModel& model_;
};

}  // namespace boresight::ui
