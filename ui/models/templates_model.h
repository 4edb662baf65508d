// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <vector>

#include <QAbstractTableModel>

#include "sessions/run/match_details.h"

namespace boresight::ui {

/// The templates of one iteration and what became of them, one row each, in their order.
class TemplatesModel : public QAbstractTableModel {
  Q_OBJECT

 public:
  enum Column {
    kNumber,
    kX_px,
    kY_px,
    kDepth_m,
    kDistinctness,
    kDx_px,
    kDy_px,
    kScore,
    kEdgeShare,
    kEmptyShare,
    kMargin,
    kResidual_px,
    kVerdict,
    kBorder,
    kColumnCount,
  };
  /// A cell as a number to sort by; NaN where there is none.
  static constexpr int kNumberRole = Qt::UserRole;

  explicit TemplatesModel(QObject* parent = nullptr);

  /// nullptr, or an iteration without templates: no rows.
  void setIteration(const sessions::IterationTrace* iteration);
  const sessions::MatchDetails& details(int row) const {
    return details_[static_cast<std::size_t>(row)];
  }
  /// "inlier", "outlier", "found", "not searched".
  static QString verdictOf(const sessions::MatchDetails& details);

  int rowCount(const QModelIndex& parent = {}) const override;
  int columnCount(const QModelIndex& parent = {}) const override;
  QVariant data(const QModelIndex& index, int role = Qt::DisplayRole) const override;
  QVariant headerData(int section, Qt::Orientation orientation, int role) const override;

 private:
  bool reached_match_ = false;
  std::vector<sessions::MatchDetails> details_;
};

}  // namespace boresight::ui
