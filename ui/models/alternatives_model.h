// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <vector>

#include <QAbstractTableModel>

#include "sessions/run/alternatives.h"

namespace boresight::ui {

/// "Rival 2", "Restart +40.0 deg, -25 mm", "Rolled by +5.0 deg".
QString alternativeTitle(const sessions::Alternative& one);
/// What it was weighed against: "Result of the run", "Chosen restart", "Chosen roll".
QString chosenTitle(const sessions::Alternative& one);

/// The poses that a run weighed against those that it went on with, one row each: rivals first,
/// then restarts and rolled hypotheses by iteration.
class AlternativesModel : public QAbstractTableModel {
  Q_OBJECT

 public:
  enum Column {
    kPose,
    kIteration,
    kEnded,
    kMargin_nats,
    kSimilarity,
    kEvidence_nats,
    kSupport,
    kInliers,
    kMatches,
    kApart_mm,
    kApart_deg,
    kColumnCount,
  };
  /// A cell's number as it is, unrounded; NaN where there is none.
  static constexpr int kNumberRole = Qt::UserRole;

  explicit AlternativesModel(QObject* parent = nullptr);

  void setAlternatives(std::vector<sessions::Alternative> alternatives);
  const std::vector<sessions::Alternative>& alternatives() const { return alternatives_; }
  const sessions::Alternative& alternative(int row) const {
    return alternatives_[static_cast<std::size_t>(row)];
  }
  /// The first row of an iteration (an index into the run's), or -1.
  int firstRowOf(int iteration) const;

  int rowCount(const QModelIndex& parent = {}) const override;
  int columnCount(const QModelIndex& parent = {}) const override;
  QVariant data(const QModelIndex& index, int role = Qt::DisplayRole) const override;
  QVariant headerData(int section, Qt::Orientation orientation, int role) const override;

 private:
  static double number(const sessions::Alternative& one, Column column);
  static QString text(const sessions::Alternative& one, Column column);

  std::vector<sessions::Alternative> alternatives_;
};

}  // namespace boresight::ui
