// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <memory>

#include <QWidget>

#include "ui/models/templates_model.h"
#include "ui/state/view_state.h"

class QComboBox;
class QLabel;
class QStackedWidget;
class QTableView;

namespace boresight::ui {

class MatchView;
class RefinementView;

/// The templates of the iteration under the cursor in a table, and the story of the chosen one; of
/// a refinement, what was found along the edges. Shows and changes the view state's template.
class MatchInspectorPanel : public QWidget {
  Q_OBJECT

 public:
  explicit MatchInspectorPanel(ViewState& view, QWidget* parent = nullptr);

  const TemplatesModel& model() const { return model_; }
  const RowsFilter& filter() const { return filter_; }

 private:
  QWidget* buildMatches();
  QWidget* buildTable();
  void showIteration();
  void showTemplate();
  void chooseRow(const QModelIndex& current);
  void showCount();

  ViewState& view_;
  TemplatesModel model_;
  RowsFilter filter_;
  std::shared_ptr<const sessions::IterationTrace> iteration_;
  QStackedWidget* pages_ = nullptr;
  QLabel* hint_ = nullptr;
  QComboBox* show_ = nullptr;
  QLabel* count_ = nullptr;
  QTableView* table_ = nullptr;
  MatchView* match_ = nullptr;
  RefinementView* refinement_ = nullptr;
  bool showing_ = false;  ///< the table follows the view state, not a person
};

}  // namespace boresight::ui
