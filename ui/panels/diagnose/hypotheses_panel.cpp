// SPDX-License-Identifier: Apache-2.0
#include "ui/panels/diagnose/hypotheses_panel.h"

#include <cmath>

#include <QtWidgets>

#include "core/base/math.h"
#include "core/localizer/acceptance.h"
#include "sessions/text/units.h"
#include "sessions/trace/run_text.h"
#include "ui/models/text.h"
#include "ui/widgets/column_fitter.h"
#include "ui/widgets/widgets.h"

namespace boresight::ui {

using sessions::Alternative;
using sessions::AlternativeKind;
using sessions::kUnknown;

namespace {

QString tr(const char* text) { return AlternativesModel::tr(text); }

QString endedText(const Alternative& alternative) {
  if (alternative.chosen) return tr("chosen");
  return alternative.has_pose ? tr("not chosen") : tr("no pose");
}

/// "55 times"; "12 times more" for a better one.
QString lessLikely(const Alternative& row) {
  if (std::isnan(row.margin_nats)) return {};
  const QString times = fromText(sessions::timesText(std::abs(row.margin_nats)));
  return row.margin_nats < 0.0 ? tr("%1 more").arg(times) : times;
}

std::vector<TableColumn<Alternative>> alternativeColumns() {
  using Row = const Alternative&;
  const auto ofOthers = [](Row row, int count) {
    return row.kind == AlternativeKind::kRolled ? count : kUnknown;
  };
  return {
      {tr("Pose"),
       tr("Competing pose: it shows about the same edges as the result. Candidate: a pose of the "
          "global search, refined. Restart: the best pose, moved along a weak direction and "
          "refined "
          "again. Rolled hypothesis: the render turned about the view axis."),
       -1, alternativeTitle},
      {tr("Iteration"),
       tr("Iteration that evaluated it, counted from 1 over all attempts; competing poses are "
          "compared with the result."),
       -1,
       [](Row row) {
         if (row.kind == AlternativeKind::kCompared) return tr("compared");
         return row.iteration < 0 ? tr("result") : QString::number(row.iteration + 1);
       }},
      {tr("Ended"), tr("Whether the run continued with it."), -1, endedText},
      {tr("Less likely"),
       tr("How many times less likely the competing pose is than the result; below %1 the run is "
          "ambiguous, \"more\": the competing pose is better.")
           .arg(fromText(sessions::timesText(kLeastMargin_nats))),
       0, lessLikely, [](Row row) { return row.margin_nats; }},
      {tr("Similarity"),
       tr("Share of the rendered edges that a competing pose has in common with the result."), 2,
       [](Row row) { return row.similarity; }},
      {tr("Score"),
       tr("Evidence of the image for a compared pose, without a scale: total of its edges, and edge "
          "support. The pose with the best score is the result; within %1 of another pose the run "
          "is ambiguous.")
           .arg(kLeastGap),
       2, [](Row row) { return row.score; }},
      {tr("Probability"), tr("Probability that a compared pose is correct."), 0,
       [](Row row) { return probabilityCell(row.probability); },
       [](Row row) { return row.probability; }},
      {tr("Inliers"), tr("Matches that agree with its pose."), 0,
       [=](Row row) { return ofOthers(row, row.inliers); }},
      {tr("Matches"), tr("Templates that could be searched."), 0,
       [=](Row row) { return ofOthers(row, row.matches); }},
      {tr("Apart, mm"), tr("Distance of the station's origin from that of the chosen pose, mm."), 2,
       [](Row row) { return 1e3 * row.apart_m; }},
      {tr("Apart, deg"), tr("Rotation from the chosen pose, in degrees."), 2,
       [](Row row) { return row.apart_rad / kDegree_rad; }},
  };
}

}  // namespace

AlternativesModel::AlternativesModel() : RowsModel(alternativeColumns()) {}

int AlternativesModel::firstRowOf(int iteration) const {
  return firstRow([iteration](const Alternative& alternative) {
    return iteration >= 0 && alternative.iteration == iteration;
  });
}

QVariant AlternativesModel::look(const Alternative& row, int /*column*/, int role) const {
  return role == Qt::FontRole && row.chosen ? boldFont() : QVariant();
}

HypothesesPanel::HypothesesPanel(ViewState& view) : view_(view) {
  ui_.setupUi(this);
  setUpTable(*ui_.hypotheses, model_);
  using Model = AlternativesModel;
  new ColumnFitter(*ui_.hypotheses, {Model::kMatches, Model::kSimilarity, Model::kInliers,
                                     Model::kIteration, Model::kProbability, Model::kScore,
                                     Model::kApart_deg, Model::kMargin_nats, Model::kApart_mm});
  (new EmptyHint(*ui_.hypotheses))
      ->setText(tr("Other poses of the run: competing poses, compared poses, rolled hypotheses. "
                   "The selected row is drawn on the image."));
  connect(ui_.hypotheses->selectionModel(), &QItemSelectionModel::currentRowChanged, this,
          [this](const QModelIndex& current) {
            if (!showing_) choose(current.isValid() ? current.row() : -1);
          });
  // A click on the row that is drawn already brings it back where the cursor has gone elsewhere.
  connect(ui_.hypotheses, &QTableView::clicked, this, [this](const QModelIndex& row) {
    if (!view_.alternative()) choose(row.row());
  });
  view_.onChange(ViewChange::kSnapshot, this, &HypothesesPanel::showSnapshot);
  view_.onChange(ViewChange::kCursor, this, &HypothesesPanel::showCursor);
  view_.onChange(ViewChange::kAlternative, this, [this] {
    if (!view_.alternative()) select(-1);
  });
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
  model_.setRows(view_.snapshot() ? sessions::alternativesOf(*view_.snapshot())
                                  : std::vector<sessions::Alternative>(),
                 false);
  ui_.hypotheses->resizeColumnsToContents();
}

void HypothesesPanel::showCursor() {
  if (showing_ || !view_.snapshot()) return;
  const int iteration = view_.cursor().iteration;
  view_.setAlternative(std::nullopt);
  const int first = model_.firstRowOf(iteration);
  if (first >= 0)
    ui_.hypotheses->scrollTo(model_.index(first, 0), QAbstractItemView::PositionAtTop);
}

void HypothesesPanel::select(int row) {
  followRow(*ui_.hypotheses, model_.index(row, 0), showing_);
  if (row < 0) ui_.hypotheses->clearSelection();
}

}  // namespace boresight::ui
