// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <QSortFilterProxyModel>

namespace boresight::ui {

/// Templates of one kind, sorted by number; what has no number comes last either way.
class TemplatesFilter : public QSortFilterProxyModel {
  Q_OBJECT

 public:
  enum class Show { kAll, kInliers, kOutliers, kLowMargin, kAtBorder, kNotSearched };
  static constexpr int kShowCount = 6;

  explicit TemplatesFilter(QObject* parent = nullptr);

  void setShow(Show show);
  Show shown() const { return show_; }
  /// For a list to choose from.
  static QString nameOf(Show show);

 protected:
  bool filterAcceptsRow(int row, const QModelIndex& parent) const override;
  bool lessThan(const QModelIndex& left, const QModelIndex& right) const override;

 private:
  Show show_ = Show::kAll;
};

}  // namespace boresight::ui
