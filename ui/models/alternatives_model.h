// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "sessions/run/alternatives.h"
#include "ui/models/rows_model.h"

namespace boresight::ui {

/// "Competing pose 2", "Candidate 1", "Rolled by +5.0 deg".
QString alternativeTitle(const sessions::Alternative& one);
/// What it was weighed against: "Result of the run", "Chosen candidate", "Chosen roll".
QString chosenTitle(const sessions::Alternative& one);

/// The poses that a run weighed against those that it went on with, one row each: competing
/// poses first, then candidates, then rolled hypotheses by iteration.
class AlternativesModel : public RowsModel<sessions::Alternative> {
  Q_OBJECT

 public:
  enum Column {
    kPose,
    kIteration,
    kEnded,
    kMargin_nats,
    kSimilarity,
    kEvidence_nats,
    kInliers,
    kMatches,
    kApart_mm,
    kApart_deg,
  };

  explicit AlternativesModel(QObject* parent = nullptr);

  void setAlternatives(std::vector<sessions::Alternative> alternatives) {
    setRows(std::move(alternatives), false);
  }
  /// The first row of an iteration (an index into the run's), or -1.
  int firstRowOf(int iteration) const;

 protected:
  QVariant look(const sessions::Alternative& row, int column, int role) const override;
};

}  // namespace boresight::ui
