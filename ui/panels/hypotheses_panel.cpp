// SPDX-License-Identifier: Apache-2.0
#include "ui/panels/hypotheses_panel.h"

#include <QtWidgets>

#include "ui/panels/widgets.h"

namespace boresight::ui {

using sessions::AlternativeKind;

HypothesesPanel::HypothesesPanel(ViewState& view, QWidget* parent) : QWidget(parent), view_(view) {
  auto* column = new QVBoxLayout(this);
  column->setContentsMargins(4, 4, 4, 4);
  table_ = named(new QTableView(this), "hypotheses");
  table_->setAccessibleName(tr("Competing poses, candidates and rolled hypotheses"));
  setUpTable(*table_, model_);
  column->addWidget(table_);
  auto* hint = new EmptyHint(*table_);
  hint->setText(
      tr("Other poses that a run compares: those that compete with its result, candidates of the "
         "search, rolled hypotheses. The chosen row is drawn on the image."));
  connect(table_->selectionModel(), &QItemSelectionModel::currentRowChanged, this,
          [this](const QModelIndex& current) {
            if (!showing_) choose(current.isValid() ? current.row() : -1);
          });
  // A click on the row that is drawn already brings it back where the cursor has gone elsewhere.
  connect(table_, &QTableView::clicked, this, [this](const QModelIndex& row) {
    if (!view_.alternative()) choose(row.row());
  });
  view_.onChange(ViewChange::kSnapshot, this, &HypothesesPanel::showSnapshot);
  view_.onChange(ViewChange::kCursor, this, &HypothesesPanel::showCursor);
  view_.onChange(ViewChange::kAlternative, this, &HypothesesPanel::showAlternative);
  showSnapshot();
}

void HypothesesPanel::choose(int row) {
  if (row < 0 || row >= model_.rowCount()) {
    view_.setAlternative(std::nullopt);
    return;
  }
  const sessions::Alternative chosen = model_.at(row);
  const QScopedValueRollback<bool> from_here(showing_, true);
  const auto& run = *view_.snapshot();
  const int last = static_cast<int>(run.iterations.size()) - 1;
  view_.setCursor({chosen.iteration < 0 ? last : chosen.iteration, Stage::kFinished});
  view_.setAlternative(chosen);
  select(row);
}

void HypothesesPanel::showSnapshot() {
  const QScopedValueRollback<bool> follows(showing_, true);
  model_.setAlternatives(view_.snapshot() ? sessions::alternativesOf(*view_.snapshot())
                                          : std::vector<sessions::Alternative>());
  table_->resizeColumnsToContents();
}

void HypothesesPanel::showCursor() {
  if (showing_ || !view_.snapshot()) return;
  const int iteration = view_.cursor().iteration;
  view_.setAlternative(std::nullopt);
  const int first = model_.firstRowOf(iteration);
  if (first >= 0) table_->scrollTo(model_.index(first, 0), QAbstractItemView::PositionAtTop);
}

void HypothesesPanel::showAlternative() {
  if (!view_.alternative()) select(-1);
}

void HypothesesPanel::select(int row) {
  const QScopedValueRollback<bool> follows(showing_, true);
  if (row < 0) {
    table_->setCurrentIndex({});
    table_->clearSelection();
  } else {
    table_->setCurrentIndex(model_.index(row, 0));
    table_->scrollTo(model_.index(row, 0));
  }
}

}  // namespace boresight::ui
