// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <QWidget>

#include "ui_hypotheses_panel.h"

#include "sessions/trace/alternatives.h"
#include "ui/models/rows_model.h"
#include "ui/state/view_state.h"

namespace boresight::ui {

/// The alternatives of a run, one row each: competing poses first, then compared poses, then rolled
/// hypotheses by iteration.
class AlternativesModel : public RowsModel<sessions::Alternative> {
  Q_OBJECT

 public:
  enum Column {
    kPose,
    kIteration,
    kEnded,
    kMargin_nats,
    kSimilarity,
    kScore,
    kProbability,
    kInliers,
    kMatches,
    kApart_mm,
    kApart_deg,
  };

  AlternativesModel();

  /// The first row of an iteration (an index into the run's), or -1.
  int firstRowOf(int iteration) const;

 protected:
  QVariant look(const sessions::Alternative& row, int column, int role) const override;
};

/// Other poses that a run compared: competing poses, compared poses, rolled hypotheses. The chosen
/// one is drawn on the image together with the pose with which the run continued; if it belongs to
/// an iteration, the cursor moves there.
class HypothesesPanel : public QWidget {
  Q_OBJECT

 public:
  explicit HypothesesPanel(ViewState& view);

  const AlternativesModel& model() const { return model_; }
  /// -1: none.
  void choose(int row);

 private:
  void showSnapshot();
  void showCursor();
  void select(int row);

  ViewState& view_;
  AlternativesModel model_;
  bool showing_ = false;  ///< the table is being updated by the view state, not the operator
  Ui::HypothesesPanel ui_;
};

}  // namespace boresight::ui
