// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <vector>

#include <QAbstractTableModel>

#include "ui/review/queue_controller.h"

namespace boresight::ui {

/// What changed between the two last runs of each case, as a table.
class DifferencesModel : public QAbstractTableModel {
  Q_OBJECT

 public:
  enum Column { kCase, kChange, kChecks, kInliers, kApart, kWhy, kColumnCount };
  /// What a column sorts by: text, or a number.
  static constexpr int kSortRole = Qt::UserRole;

  explicit DifferencesModel(QObject* parent = nullptr);

  void setEntries(std::vector<DifferenceEntry> entries);
  const DifferenceEntry& entryAt(int row) const { return entries_[static_cast<std::size_t>(row)]; }

  int rowCount(const QModelIndex& parent = {}) const override;
  int columnCount(const QModelIndex& parent = {}) const override;
  QVariant data(const QModelIndex& index, int role = Qt::DisplayRole) const override;
  QVariant headerData(int section, Qt::Orientation orientation, int role) const override;

 private:
  std::vector<DifferenceEntry> entries_;
};

}  // namespace boresight::ui
