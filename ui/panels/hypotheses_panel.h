// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <QWidget>

#include "ui/models/alternatives_model.h"
#include "ui/state/view_state.h"

class QTableView;

namespace boresight::ui {

/// What else a run compared: poses that compete with its result, candidates, rolled hypotheses. The
/// chosen one is drawn on the image with the pose that the run went on with; one that belongs to an
/// iteration takes the cursor there.
class HypothesesPanel : public QWidget {
  Q_OBJECT

 public:
  explicit HypothesesPanel(ViewState& view, QWidget* parent = nullptr);

  const AlternativesModel& model() const { return model_; }
  /// -1: none.
  void choose(int row);

 private:
  void showSnapshot();
  void showCursor();
  void showAlternative();
  void select(int row);

  ViewState& view_;
  AlternativesModel model_;
  QTableView* table_ = nullptr;
  bool showing_ = false;  ///< the table follows the view state, not the operator
};

}  // namespace boresight::ui
