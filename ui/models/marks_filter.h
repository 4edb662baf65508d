// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <QSortFilterProxyModel>

namespace boresight::ui {

/// Marks of one kind, sorted by number or name; what has no number comes last either way.
class MarksFilter : public QSortFilterProxyModel {
  Q_OBJECT

 public:
  enum class Show { kAll, kUsed, kOff, kHalfMade, kStandOut, kLines };
  static constexpr int kShowCount = 6;

  explicit MarksFilter(QObject* parent = nullptr);

  void setShow(Show show);
  /// For a list to choose from.
  static QString nameOf(Show show);

 protected:
  bool filterAcceptsRow(int row, const QModelIndex& parent) const override;
  bool lessThan(const QModelIndex& left, const QModelIndex& right) const override;

 private:
  Show show_ = Show::kAll;
};

}  // namespace boresight::ui
