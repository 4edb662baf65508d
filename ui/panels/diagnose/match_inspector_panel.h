// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <memory>
#include <optional>

#include <QWidget>

#include "ui_match_inspector_panel.h"

#include "ui/panels/diagnose/match_view.h"
#include "ui/state/view_state.h"

namespace boresight::ui {

class HistogramPlot;

/// The templates of the iteration under the cursor in a table, and the details of the chosen one;
/// for a refinement, statistics of the edges found. Shows and changes the view state's template.
class MatchInspectorPanel : public QWidget {
  Q_OBJECT

 public:
  explicit MatchInspectorPanel(ViewState& view);

  const TemplatesModel& model() const { return model_; }
  const RowsFilter& filter() const { return filter_; }

 private:
  void showIteration();
  void showRefinement();
  void showDirections();
  void showTemplate();
  void showCount();
  std::optional<int> lastMatched() const;

  ViewState& view_;
  TemplatesModel model_;
  RowsFilter filter_;
  std::shared_ptr<const sessions::IterationTrace> iteration_;
  HistogramPlot* histogram_ = nullptr;  ///< of a refinement
  bool showing_ = false;                ///< the table is being updated by the view state
  Ui::MatchInspectorPanel ui_;
};

}  // namespace boresight::ui
