// SPDX-License-Identifier: Apache-2.0
#include "ui/panels/rivals_panel.h"

#include <QFont>
#include <QtWidgets>

#include "core/base/math.h"
#include "core/localizer/competing_poses.h"
#include "sessions/text/units.h"
#include "ui/panels/widgets.h"

namespace boresight::ui {

using sessions::Alternative;
using sessions::AlternativeKind;
using sessions::kUnknown;

namespace {

QString tr(const char* text) { return AlternativesModel::tr(text); }

QString endedText(const Alternative& one) {
  if (one.chosen) return tr("chosen");
  if (one.kind != AlternativeKind::kRival)
    return one.ended == LocalizationStatus::kRunning ? tr("not chosen") : tr("no pose");
  if (one.ended == LocalizationStatus::kRunning) return tr("not tried");
  return QString::fromLatin1(localizationStatusText(one.ended))
      .replace(QLatin1Char('_'), QLatin1Char(' '));
}

std::vector<TableColumn<Alternative>> alternativeColumns() {
  using Row = const Alternative&;
  const auto ofOthers = [](Row one, int count) {
    return one.kind == AlternativeKind::kRolled ? count : kUnknown;
  };
  return {
      {tr("Pose"),
       tr("A rival: a pose under which the model's edges look like those of the result. A "
          "candidate: a pose that the search found. A rolled hypothesis: the render turned about "
          "the view."),
       -1, alternativeTitle},
      {tr("Iteration"),
       tr("The iteration that weighed it, counted from 1 over all attempts; rivals are weighed "
          "against the result."),
       -1,
       [](Row one) {
         if (one.kind == AlternativeKind::kCandidate) return tr("search");
         return one.iteration < 0 ? tr("result") : QString::number(one.iteration + 1);
       }},
      {tr("Ended"),
       tr("What became of it; a rival that converged is a pose that the image supports."), -1,
       endedText},
      {tr("Behind, nats"),
       tr("Evidence of the result beyond that of a rival that converged, in nats; below %1 "
          "the run is ambiguous, below zero the rival is the better one.")
           .arg(CompetingPoses::kMinMargin_nats),
       0, [](Row one) { return one.margin_nats; }},
      {tr("Similarity"),
       tr("How much the model's edges look like themselves where the rival puts them; 1: the "
          "same."),
       2, [](Row one) { return one.similarity; }},
      {tr("Evidence, nats"),
       tr("How strongly the image's edges support a candidate: mean over its edges and half of "
          "the weakest quadrant, in nats."),
       2, [](Row one) { return one.evidence_nats; }},
      {tr("Inliers"), tr("Matches that agree with its pose."), 0,
       [=](Row one) { return ofOthers(one, one.inliers); }},
      {tr("Matches"), tr("Templates that could be searched."), 0,
       [=](Row one) { return ofOthers(one, one.matches); }},
      {tr("Apart, mm"),
       tr("How far the station's origin lies from where the chosen pose puts it, mm."), 2,
       [](Row one) { return 1e3 * one.apart_m; }},
      {tr("Apart, deg"), tr("How far it is turned from the chosen pose, in degrees."), 2,
       [](Row one) { return one.apart_rad / kDegree_rad; }},
  };
}

}  // namespace

AlternativesModel::AlternativesModel(QObject* parent) : RowsModel(alternativeColumns(), parent) {}

int AlternativesModel::firstRowOf(int iteration) const {
  return firstRow(
      [iteration](const Alternative& one) { return iteration >= 0 && one.iteration == iteration; });
}

QVariant AlternativesModel::look(const Alternative& row, int /*column*/, int role) const {
  if (role != Qt::FontRole || !row.chosen) return {};
  QFont bold;
  bold.setBold(true);
  return bold;
}

using sessions::AlternativeKind;

RivalsPanel::RivalsPanel(ViewState& view, QWidget* parent) : QWidget(parent), view_(view) {
  auto* column = new QVBoxLayout(this);
  column->setContentsMargins(4, 4, 4, 4);
  table_ = named(new QTableView(this), "rivals");
  table_->setAccessibleName(tr("Rivals, candidates and rolled hypotheses"));
  setUpTable(*table_, model_);
  column->addWidget(table_);
  auto* hint = new EmptyHint(*table_);
  hint->setText(
      tr("Poses that a run weighs beside the one it goes on with: rivals of its result "
         "(ambiguity.enabled), candidates of the search, rolled hypotheses. The chosen row is "
         "drawn on the image."));
  connect(table_->selectionModel(), &QItemSelectionModel::currentRowChanged, this,
          [this](const QModelIndex& current) {
            if (!showing_) choose(current.isValid() ? current.row() : -1);
          });
  // A click on the row that is drawn already brings it back where the cursor has gone elsewhere.
  connect(table_, &QTableView::clicked, this, [this](const QModelIndex& row) {
    if (!view_.alternative()) choose(row.row());
  });
  view_.onChange(ViewChange::kSnapshot, this, &RivalsPanel::showSnapshot);
  view_.onChange(ViewChange::kCursor, this, &RivalsPanel::showCursor);
  view_.onChange(ViewChange::kAlternative, this, &RivalsPanel::showAlternative);
  showSnapshot();
}

void RivalsPanel::choose(int row) {
  if (row < 0 || row >= model_.rowCount()) {
    view_.setAlternative(std::nullopt);
    return;
  }
  const sessions::Alternative chosen = model_.at(row);
  const QScopedValueRollback<bool> from_here(showing_, true);
  const auto& run = *view_.snapshot();
  const int last = static_cast<int>(run.iterations.size()) - 1;
  const int cursor = view_.cursor().iteration;
  const bool of_rival = chosen.kind == AlternativeKind::kRival &&
                        sessions::rivalOfIteration(run, model_.rows(), cursor) == chosen.number - 1;
  if (!of_rival)
    view_.setCursor({chosen.iteration < 0 ? last : chosen.iteration, Stage::kFinished});
  view_.setAlternative(chosen);
  select(row);
}

void RivalsPanel::showSnapshot() {
  const QScopedValueRollback<bool> follows(showing_, true);
  model_.setRows(view_.snapshot() ? sessions::alternativesOf(*view_.snapshot())
                                  : std::vector<sessions::Alternative>(),
                 false);
  table_->resizeColumnsToContents();
}

void RivalsPanel::showCursor() {
  if (showing_ || !view_.snapshot()) return;
  const int iteration = view_.cursor().iteration;
  const int rival = sessions::rivalOfIteration(*view_.snapshot(), model_.rows(), iteration);
  if (rival >= 0) {
    choose(rival);
    return;
  }
  view_.setAlternative(std::nullopt);
  const int first = model_.firstRowOf(iteration);
  if (first >= 0) table_->scrollTo(model_.index(first, 0), QAbstractItemView::PositionAtTop);
}

void RivalsPanel::showAlternative() {
  if (!view_.alternative()) select(-1);
}

void RivalsPanel::select(int row) {
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
