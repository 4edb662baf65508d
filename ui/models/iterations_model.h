// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <memory>

#include "sessions/run/trace.h"
#include "ui/models/rows_model.h"

namespace boresight::ui {

/// The seed, or an iteration as its run tells of it.
struct IterationRow {
  QString name;                                           ///< "2.3", or "seed"
  std::shared_ptr<const sessions::IterationTrace> trace;  ///< nullptr: the seed
  QString status;
};

/// A run as a table: the seed, then one row per iteration. A snapshot that continues the one
/// before appends rows and keeps selections.
class IterationsModel : public RowsModel<IterationRow> {
  Q_OBJECT

 public:
  enum Column {
    kNumber,
    kKind,
    kHypothesis,
    kLevel,
    kTranslation_mm,
    kRotation_deg,
    kImage_px,
    kTemplates,
    kMatches,
    kInliers,
    kThreshold_px,
    kBestScore,
    kMeanScore,
    kRms_px,
    kRendering_ms,
    kMatching_ms,
    kPose_ms,
    kStatus,
  };
  using SnapshotPtr = std::shared_ptr<const sessions::LocalizationTrace>;

  explicit IterationsModel(QObject* parent = nullptr);

  void setSnapshot(SnapshotPtr snapshot);

  /// Rows are the cursor's iterations moved by one: the seed is row 0.
  static int rowOf(int iteration) { return iteration + 1; }
  static int iterationOf(int row) { return row - 1; }
  /// "2.3": the third iteration of the second attempt; "seed" for -1.
  QString iterationName(int iteration) const;
  /// A cell's number as it is, unrounded; NaN where there is none.
  double number(int iteration, Column column) const;

 protected:
  QVariant look(const IterationRow& row, int column, int role) const override;

 private:
  SnapshotPtr snapshot_;
};

}  // namespace boresight::ui
