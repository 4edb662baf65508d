// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "sessions/run/match_details.h"
#include "ui/models/rows_model.h"

namespace boresight::ui {

/// The templates of one iteration and what became of them, one row each, in their order.
class TemplatesModel : public RowsModel<sessions::MatchDetails> {
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
  };
  /// Which templates a list shows.
  enum class Show { kAll, kInliers, kOutliers, kLowMargin, kAtBorder, kNotSearched };

  explicit TemplatesModel(QObject* parent = nullptr);

  /// nullptr, or an iteration without templates: no rows.
  void setIteration(const sessions::IterationTrace* iteration);
  /// "inlier", "outlier", "found", "not searched".
  static QString verdictOf(const sessions::MatchDetails& details);
  /// The names of `Show`, in its order.
  static QStringList showNames();
  bool isShown(int row, Show show) const;

 protected:
  QVariant look(const sessions::MatchDetails& row, int column, int role) const override;

 private:
  bool reached_match_ = false;
};

}  // namespace boresight::ui
