// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <memory>
#include <vector>

#include <QAbstractTableModel>

#include "sessions/run/trace.h"

namespace boresight::ui {

/// A run as a table: the seed, then one row per iteration. A snapshot that continues the one
/// before appends rows and keeps selections.
class IterationsModel : public QAbstractTableModel {
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
    kColumnCount,
  };
  /// A cell's number as it is, unrounded; NaN where there is none.
  static constexpr int kNumberRole = Qt::UserRole;

  using SnapshotPtr = std::shared_ptr<const sessions::LocalizationTrace>;

  explicit IterationsModel(QObject* parent = nullptr);

  void setSnapshot(SnapshotPtr snapshot);

  /// Rows are the cursor's iterations moved by one: the seed is row 0.
  static int rowOf(int iteration) { return iteration + 1; }
  static int iterationOf(int row) { return row - 1; }
  /// "2.3": the third iteration of the second attempt; "seed" for -1.
  QString iterationName(int iteration) const;
  double number(int iteration, Column column) const;

  int rowCount(const QModelIndex& parent = {}) const override;
  int columnCount(const QModelIndex& parent = {}) const override;
  QVariant data(const QModelIndex& index, int role = Qt::DisplayRole) const override;
  QVariant headerData(int section, Qt::Orientation orientation, int role) const override;

 private:
  int iterationCount() const;
  bool continues(const sessions::LocalizationTrace& next) const;
  const sessions::IterationTrace& iteration(int index) const;
  QString text(int index, Column column) const;
  QString statusOf(int index) const;
  QString hypothesisText(int index) const;
  QString hypothesesList(int index) const;

  SnapshotPtr snapshot_;
};

}  // namespace boresight::ui
