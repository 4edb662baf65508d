// SPDX-License-Identifier: Apache-2.0
#include "ui/panels/match_inspector_panel.h"

#include <QtWidgets>

#include "ui/panels/match_view.h"
#include "ui/panels/refinement_view.h"
#include "ui/panels/widgets.h"

namespace boresight::ui {

MatchInspectorPanel::MatchInspectorPanel(ViewState& view, QWidget* parent)
    : QWidget(parent), view_(view) {
  filter_.setSourceModel(&model_);
  auto* column = new QVBoxLayout(this);
  column->setContentsMargins(4, 4, 4, 4);
  pages_ = new QStackedWidget(this);
  hint_ = new QLabel(this);
  hint_->setAlignment(Qt::AlignCenter);
  hint_->setWordWrap(true);
  refinement_ = new RefinementView(this);
  pages_->addWidget(hint_);
  pages_->addWidget(buildMatches());
  pages_->addWidget(refinement_);
  column->addWidget(pages_);
  view_.onChange(ViewChange::kSnapshot | ViewChange::kCursor, this,
                 &MatchInspectorPanel::showIteration);
  view_.onChange(ViewChange::kTemplate, this, &MatchInspectorPanel::showTemplate);
  showIteration();
}

QWidget* MatchInspectorPanel::buildMatches() {
  auto* splitter = new QSplitter(Qt::Horizontal, this);
  splitter->addWidget(buildTable());
  match_ = new MatchView(this);
  splitter->addWidget(match_);
  splitter->setStretchFactor(0, 1);
  splitter->setStretchFactor(1, 3);
  splitter->setChildrenCollapsible(false);
  splitter->setSizes({360, 1000});
  return splitter;
}

QWidget* MatchInspectorPanel::buildTable() {
  auto* part = new QWidget(this);
  auto* column = new QVBoxLayout(part);
  column->setContentsMargins(0, 0, 0, 0);
  auto* row = new QHBoxLayout;
  show_ = new QComboBox(part);
  show_->setAccessibleName(tr("Which templates are listed"));
  show_->setSizeAdjustPolicy(QComboBox::AdjustToMinimumContentsLengthWithIcon);
  show_->setMinimumContentsLength(8);
  show_->addItems(TemplatesModel::showNames());
  count_ = named(new QLabel(part), "count");
  row->addWidget(show_);
  row->addWidget(count_, 1);
  column->addLayout(row);
  table_ = newTable("templates", tr("Templates"), filter_, part);
  table_->setSortingEnabled(true);
  table_->sortByColumn(TemplatesModel::kNumber, Qt::AscendingOrder);
  column->addWidget(table_, 1);
  connect(show_, QOverload<int>::of(&QComboBox::currentIndexChanged), this, [this](int index) {
    showing_ = true;
    filter_.setCondition([this, show = static_cast<TemplatesModel::Show>(index)](int source_row) {
      return model_.isShown(source_row, show);
    });
    showing_ = false;
    showCount();
    showTemplate();
  });
  connect(table_->selectionModel(), &QItemSelectionModel::currentRowChanged, this,
          &MatchInspectorPanel::chooseRow);
  return part;
}

void MatchInspectorPanel::showCount() {
  count_->setText(tr("%1 of %2").arg(filter_.rowCount()).arg(model_.rowCount()));
}

void MatchInspectorPanel::showIteration() {
  const auto* run = view_.snapshot().get();
  const int index = view_.cursor().iteration;
  const bool exists = run && index >= 0 && index < static_cast<int>(run->iterations.size());
  const auto next = exists ? run->iterations[static_cast<std::size_t>(index)] : nullptr;
  if (next != iteration_ || !next) {
    iteration_ = next;
    showing_ = true;
    model_.setIteration(iteration_.get());
    showing_ = false;
    table_->resizeColumnsToContents();
    showCount();
  }
  const bool refines = iteration_ && iteration_->kind == IterationKind::kRefine;
  if (refines && iteration_->reached >= Stage::kRefine) {
    refinement_->setIteration(*iteration_);
    pages_->setCurrentWidget(refinement_);
  } else if (model_.rowCount() > 0) {
    pages_->setCurrentIndex(1);
  } else {
    hint_->setText(!run          ? tr("Nothing has run yet.")
                   : !iteration_ ? tr("The seed has no matches; choose an iteration.")
                                 : tr("This iteration has no templates yet."));
    pages_->setCurrentWidget(hint_);
  }
  showTemplate();
}

void MatchInspectorPanel::showTemplate() {
  const int selected = view_.selectedTemplate();
  showing_ = true;
  const QModelIndex row = filter_.mapFromSource(model_.index(selected, 0));
  table_->setCurrentIndex(row);
  if (row.isValid()) table_->scrollTo(row);
  showing_ = false;
  const auto* run = view_.snapshot().get();
  if (selected < 0 || selected >= model_.rowCount() || !run || !run->edges) {
    match_->showNote(tr("Choose a template in the table or in the image."));
    return;
  }
  match_->showMatch({run->edges, iteration_, selected});
}

void MatchInspectorPanel::chooseRow(const QModelIndex& current) {
  if (showing_ || !current.isValid()) return;
  view_.selectTemplate(filter_.mapToSource(current).row());
}

}  // namespace boresight::ui
