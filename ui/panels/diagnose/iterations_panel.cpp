// SPDX-License-Identifier: Apache-2.0
#include "ui/panels/diagnose/iterations_panel.h"

#include <algorithm>
#include <cmath>
#include <cstddef>

#include <QtWidgets>

#include "core/base/math.h"
#include "sessions/text/units.h"
#include "sessions/trace/run_text.h"
#include "ui/models/text.h"
#include "ui/plots/plots.h"
#include "ui/widgets/column_fitter.h"
#include "ui/widgets/widgets.h"

namespace boresight::ui {

using sessions::IterationTrace;
using sessions::kUnknown;

std::vector<Stage> stagesOf(const IterationTrace& iteration) {
  std::vector<Stage> stages = {Stage::kRender, Stage::kRefine};
  if (iteration.kind == IterationKind::kMatch)
    stages = {Stage::kRender, Stage::kTemplates, Stage::kMatch, Stage::kPose};
  std::erase_if(stages, [&iteration](Stage stage) {
    return stage != Stage::kRender && stage > iteration.reached;
  });
  return stages;
}

int shownStage(const std::vector<Stage>& stages, Stage cursor) {
  int shown = 0;
  for (std::size_t i = 0; i < stages.size(); ++i)
    if (stages[i] <= cursor) shown = static_cast<int>(i);
  return shown;
}

RunCursor stageFrom(const sessions::LocalizationTrace& run, const RunCursor& cursor, int steps) {
  std::vector<RunCursor> all = {{-1, Stage::kFinished}};
  int at = 0;
  for (int i = 0; i < static_cast<int>(run.iterations.size()); ++i) {
    for (const Stage stage : stagesOf(*run.iterations[static_cast<std::size_t>(i)])) {
      const bool reached = stage == Stage::kRender || stage <= cursor.stage;
      if (i < cursor.iteration || (i == cursor.iteration && reached))
        at = static_cast<int>(all.size());
      all.push_back({i, stage});
    }
    all.back().stage = Stage::kFinished;
  }
  const int next = std::clamp(at + steps, 0, static_cast<int>(all.size()) - 1);
  return next == at ? cursor : all[static_cast<std::size_t>(next)];
}

namespace {

struct StageText {
  const char* name;
  const char* help;
};
/// From Stage::kRender to Stage::kRefine, in the order of `Stage`.
constexpr StageText kStageTexts[] = {
    {QT_TR_NOOP("Render"),
     QT_TR_NOOP("Show the edges rendered from the iteration's initial pose.")},
    {QT_TR_NOOP("Templates"), QT_TR_NOOP("Show the templates cut from the render.")},
    {QT_TR_NOOP("Match"), QT_TR_NOOP("Show where the templates were found in the image.")},
    {QT_TR_NOOP("Pose"),
     QT_TR_NOOP("Show the pose solved from the matches, its inliers and residuals.")},
    {QT_TR_NOOP("Refine"),
     QT_TR_NOOP("Show the pose refined until rendered and image edges meet.")},
};
static_assert(std::size(kStageTexts) ==
              static_cast<int>(Stage::kRefine) - static_cast<int>(Stage::kRender) + 1);

const StageText& textOf(Stage stage) {
  return kStageTexts[static_cast<int>(stage) - static_cast<int>(Stage::kRender)];
}

/// Whether a pose came out of the iteration.
bool isSolved(const IterationTrace& iteration) {
  return iteration.reached >= Stage::kPose && iteration.status != LocalizationStatus::kPnpFailed &&
         iteration.status != LocalizationStatus::kFault;
}

const HypothesisSummary* chosenOf(const IterationTrace& iteration) {
  const auto chosen = static_cast<std::size_t>(iteration.chosen_hypothesis);
  if (iteration.kind == IterationKind::kRefine || chosen >= iteration.hypotheses.size())
    return nullptr;
  return &iteration.hypotheses[chosen];
}

/// "+40.0 deg".
QString placeText(const HypothesisSummary& hypothesis_summary) {
  const double turn_deg = hypothesis_summary.roll_rad / kDegree_rad;
  return QLatin1String(turn_deg < 0.0 ? "" : "+") + numberText(turn_deg, 1) +
         QStringLiteral(" deg");
}

double ofPose(const IterationTrace& iteration, double value) {
  return isSolved(iteration) ? value : kUnknown;
}

double ofStage(const IterationTrace& iteration, Stage stage, double value) {
  return iteration.reached >= stage ? value : kUnknown;
}

/// Counts of a refinement are of places along edges.
double countOf(const IterationTrace& iteration, Stage stage, int of_match, int of_refinement) {
  const bool refines = iteration.kind == IterationKind::kRefine;
  return ofStage(iteration, refines ? Stage::kRefine : stage, refines ? of_refinement : of_match);
}

double ofMatch(const IterationTrace& iteration, Stage stage, double value) {
  return iteration.kind == IterationKind::kMatch ? ofStage(iteration, stage, value) : kUnknown;
}

QString hypothesisText(const IterationTrace& iteration) {
  const HypothesisSummary* chosen = chosenOf(iteration);
  if (chosen == nullptr) return {};
  return IterationsModel::tr("%1 (of %2)").arg(placeText(*chosen)).arg(iteration.hypotheses.size());
}

/// One line per hypothesis, the one chosen marked.
QString hypothesesList(const IterationTrace& iteration) {
  constexpr auto tr = [](const char* text) { return IterationsModel::tr(text); };
  if (chosenOf(iteration) == nullptr) return {};
  QStringList lines;
  for (std::size_t i = 0; i < iteration.hypotheses.size(); ++i) {
    const HypothesisSummary& each = iteration.hypotheses[i];
    QString line =
        tr("%1: %2 of %3 inliers").arg(placeText(each)).arg(each.inliers).arg(each.matches);
    if (!each.solved) line += tr(", no pose");
    if (static_cast<int>(i) == iteration.chosen_hypothesis) line += tr(" (chosen)");
    lines << line;
  }
  return lines.join(QLatin1Char('\n'));
}

QString kindText(const IterationTrace& iteration) {
  return iteration.kind == IterationKind::kRefine ? IterationsModel::tr("refine")
                                                  : IterationsModel::tr("match");
}

using Line = const IterationRow&;
using Trace = const IterationTrace&;

/// A column's value of iterations; the seed has none.
auto number(double (*value)(Trace)) {
  return [value](Line row) { return row.trace ? value(*row.trace) : kUnknown; };
}
auto text(QString (*value)(Trace)) {
  return [value](Line row) { return row.trace ? value(*row.trace) : QString(); };
}

std::vector<TableColumn<IterationRow>> iterationColumns() {
  constexpr auto tr = [](const char* text) { return IterationsModel::tr(text); };
  return {
      {tr("Iteration"),
       tr("Attempt and iteration: 2.3 is the third iteration of the second attempt. After a failed "
          "attempt the next starts from the seed."),
       -1, [](Line row) { return row.name; }},
      {tr("Kind"),
       tr("match: templates are searched and a pose is solved from them; refine: the pose is "
          "adjusted until rendered and image edges meet."),
       -1, text(kindText)},
      {tr("Hypothesis"),
       tr("Roll of the render that the iteration used, in degrees, and number of renders. Hover "
          "over a cell to list all."),
       -1, text(hypothesisText)},
      {tr("Level"),
       tr("Level of the image pyramid: 0 is the full image, each further one has half its size."),
       0, number([](Trace trace) -> double { return trace.level; })},
      {tr("Moved, mm"), tr("Translation by this iteration, in mm."), 3,
       number([](Trace trace) { return ofPose(trace, 1e3 * trace.correction_translation_m); })},
      {tr("Turned, deg"), tr("Rotation by this iteration, in degrees."), 3, number([](Trace trace) {
         return ofPose(trace, trace.correction_rotation_rad / kDegree_rad);
       })},
      {tr("In image, px"),
       tr("Shift of the scene in the image by the correction: mean over the corners of its box, in "
          "pixels of the full image."),
       2, number([](Trace trace) { return ofPose(trace, trace.correction_image_px); })},
      {tr("Templates"),
       tr("Templates cut from the render; of a refinement: points along the rendered edges."), 0,
       number([](Trace trace) {
         return countOf(trace, Stage::kTemplates, trace.template_count,
                        trace.refinement.sample_count);
       })},
      {tr("Matches"),
       tr("Templates searched in the image; of a refinement: points with an image edge."), 0,
       number([](Trace trace) {
         return countOf(trace, Stage::kMatch, trace.searched_count, trace.refinement.found_count);
       })},
      {tr("Inliers"), tr("Matches that agree with the pose; of a refinement: points used."), 0,
       number([](Trace trace) {
         return countOf(trace, Stage::kPose, trace.support(), trace.refinement.used_count);
       })},
      {tr("Threshold, px"),
       tr("Largest residual of an inlier, in pixels of the full image; of a refinement: search "
          "radius for an edge."),
       1, number([](Trace trace) { return trace.threshold_px; })},
      {tr("Best score"), tr("Highest similarity S of a match; 2 is perfect."), 3,
       number([](Trace trace) { return ofMatch(trace, Stage::kMatch, trace.best_score); })},
      {tr("Mean score"), tr("Mean similarity S over the matches; 2 is perfect."), 3,
       number([](Trace trace) { return ofMatch(trace, Stage::kMatch, trace.mean_score); })},
      {tr("RMS, px"), tr("Root mean square residual of the inliers, in pixels of the full image."),
       2, number([](Trace trace) { return ofPose(trace, trace.rms_px()); })},
      {tr("Render, ms"), tr("Wall time of rendering the scene's edges, in ms."), 0,
       number([](Trace trace) { return 1e3 * trace.seconds.rendering; })},
      {tr("Match, ms"), tr("Wall time of choosing and searching templates, in ms."), 0,
       number([](Trace trace) {
         return ofMatch(trace, Stage::kTemplates, 1e3 * trace.seconds.matching);
       })},
      {tr("Pose, ms"), tr("Wall time of solving for the pose, or of refining it, in ms."), 0,
       number([](Trace trace) {
         return ofStage(trace, Stage::kPose, 1e3 * (trace.seconds.pose + trace.seconds.refinement));
       })},
      {tr("Status"), tr("Status of the iteration, or its last complete stage."), -1,
       [](Line row) { return row.status; }},
  };
}

QString statusText(const sessions::LocalizationTrace& run, std::size_t index) {
  const IterationTrace& iteration = *run.iterations[index];
  const bool last = index + 1 == run.iterations.size();
  if (last && run.last_under_way)
    return IterationsModel::tr("%1 done").arg(QString::fromLatin1(stageText(iteration.reached)));
  // The end of the run is not noted in the iteration that brought it.
  const LocalizationStatus status =
      last && iteration.status == LocalizationStatus::kRunning ? run.status : iteration.status;
  if (status == LocalizationStatus::kRunning)
    return last ? IterationsModel::tr("halted") : IterationsModel::tr("continued");
  return QString::fromLatin1(localizationStatusText(status))
      .replace(QLatin1Char('_'), QLatin1Char(' '));
}

/// All iterations but the last one are the same records, and none was lost.
bool continues(const sessions::LocalizationTrace* former, const sessions::LocalizationTrace* next) {
  if (!former || !next || former->iterations.empty()) return false;
  const auto& before = former->iterations;
  return next->iterations.size() >= before.size() &&
         std::equal(before.begin(), before.end() - 1, next->iterations.begin());
}

}  // namespace

RunScrubber::RunScrubber(ViewState& view) : view_(view) {
  ui_.setupUi(this);
  actions_ = {ui_.goFirst, ui_.goPrevious,      ui_.goNext,
              ui_.goLast,  ui_.goPreviousStage, ui_.goNextStage};
  const std::array buttons = {ui_.first, ui_.previous,      ui_.next,
                              ui_.last,  ui_.previousStage, ui_.nextStage};
  for (std::size_t i = 0; i < buttons.size(); ++i) {
    buttons[i]->setDefaultAction(actions_[i]);
    buttons[i]->setAccessibleName(actions_[i]->text());
    connect(actions_[i], &QAction::triggered, this, [this, i] { go(static_cast<Step>(i)); });
  }
  ui_.shownIteration->setMinimumWidth(
      fontMetrics().horizontalAdvance(QStringLiteral("8.88 (88 of 88)")));
  stages_ = new QButtonGroup(this);
  for (QToolButton* each : {ui_.stage1, ui_.stage2, ui_.stage3, ui_.stage4})
    stages_->addButton(each, stages_->buttons().size());
  connect(stages_, &QButtonGroup::idClicked, this, &RunScrubber::chooseStage);
  connect(ui_.iterations, &QSlider::valueChanged, this, [this](int value) {
    view_.setCursor({value, Stage::kFinished});
  });
  view_.onChange(ViewChange::kSnapshot | ViewChange::kCursor, this, &RunScrubber::showCursor);
  showCursor();
}

/// "2.3 (5 of 13)".
void RunScrubber::showPlace() {
  const auto* run = view_.snapshot().get();
  const int iteration = view_.cursor().iteration;
  const QString name = run ? fromText(sessions::iterationName(*run, iteration)) : tr("seed");
  ui_.shownIteration->setText(
      iteration < 0 ? name
                    : tr("%1 (%2 of %3)").arg(name).arg(iteration + 1).arg(run->iterations.size()));
}

void RunScrubber::go(Step step) {
  const RunCursor& cursor = view_.cursor();
  if (step == Step::kPreviousStage || step == Step::kNextStage) {
    if (const auto& run = view_.snapshot())
      view_.setCursor(stageFrom(*run, cursor, step == Step::kNextStage ? 1 : -1));
    return;
  }
  const int target = step == Step::kFirst      ? -1
                     : step == Step::kPrevious ? cursor.iteration - 1
                     : step == Step::kNext     ? cursor.iteration + 1
                                               : ui_.iterations->maximum();
  view_.setCursor({target, Stage::kFinished});
}

void RunScrubber::chooseStage(int index) {
  const auto shown = view_.iteration();
  if (shown == nullptr) return;
  const std::vector<Stage> stages = stagesOf(*shown);
  const bool last = index + 1 >= static_cast<int>(stages.size());
  view_.setCursor({view_.cursor().iteration,
                   last ? Stage::kFinished : stages[static_cast<std::size_t>(index)]});
}

void RunScrubber::showCursor() {
  const int last =
      view_.snapshot() ? static_cast<int>(view_.snapshot()->iterations.size()) - 1 : -1;
  const QSignalBlocker blocked(ui_.iterations);
  ui_.iterations->setRange(-1, last);
  ui_.iterations->setValue(view_.cursor().iteration);
  ui_.iterations->setEnabled(last >= 0);
  for (const Step back : {Step::kFirst, Step::kPrevious})
    action(back)->setEnabled(view_.cursor().iteration >= 0);
  for (const Step forward : {Step::kNext, Step::kLast})
    action(forward)->setEnabled(view_.cursor().iteration < last);
  showPlace();
  showStages();
}

void RunScrubber::showStages() {
  const auto shown = view_.iteration();
  const std::vector<Stage> stages = shown ? stagesOf(*shown) : std::vector<Stage>();
  const int chosen = shown ? shownStage(stages, view_.cursor().stage) : -1;
  // An exclusive group cannot have none checked.
  stages_->setExclusive(false);
  for (int i = 0; i < stages_->buttons().size(); ++i) {
    auto* button = qobject_cast<QToolButton*>(stages_->button(i));
    const bool exists = i < static_cast<int>(stages.size());
    button->setVisible(exists);
    button->setChecked(i == chosen);
    button->setFont(boldFont(font(), i == chosen));
    if (!exists) continue;
    button->setText(tr(textOf(stages[static_cast<std::size_t>(i)]).name));
    button->setToolTip(tr(textOf(stages[static_cast<std::size_t>(i)]).help));
  }
  stages_->setExclusive(chosen >= 0);
  const auto* run = view_.snapshot().get();
  action(Step::kPreviousStage)->setEnabled(run && view_.cursor().iteration >= 0);
  action(Step::kNextStage)
      ->setEnabled(run && !(stageFrom(*run, view_.cursor(), 1) == view_.cursor()));
}

IterationsModel::IterationsModel() : RowsModel(iterationColumns()) {}

void IterationsModel::setSnapshot(SnapshotPtr snapshot) {
  std::vector<IterationRow> rows;
  if (snapshot) rows.push_back({tr("seed"), nullptr, {}});
  for (std::size_t i = 0; snapshot && i < snapshot->iterations.size(); ++i)
    rows.push_back({fromText(sessions::iterationName(*snapshot, static_cast<int>(i))),
                    snapshot->iterations[i], statusText(*snapshot, i)});
  const bool goes_on = continues(snapshot_.get(), snapshot.get());
  snapshot_ = std::move(snapshot);
  setRows(std::move(rows), goes_on);
}

QString IterationsModel::iterationName(int iteration) const {
  const int row = rowOf(iteration);
  return row > 0 && row < rowCount() ? at(row).name : tr("seed");
}

double IterationsModel::number(int iteration, Column column) const {
  const QVariant value = index(rowOf(iteration), column).data(kSortRole);
  return value.isValid() ? value.toDouble() : kUnknown;
}

QVariant IterationsModel::look(const IterationRow& row, int column, int role) const {
  const bool lists = role == Qt::ToolTipRole && column == kHypothesis && row.trace;
  return lists ? hypothesesList(*row.trace) : QVariant();
}

IterationsPanel::IterationsPanel(ViewState& view) : view_(view) {
  ui_.setupUi(this);
  buildTable();
  corrections_ = new DoublePlot({tr("moved, mm"), true}, {tr("turned, deg"), true});
  fit_ = new DoublePlot({tr("inliers"), true}, {tr("rms, px"), false});
  for (DoublePlot* plot : {corrections_, fit_}) {
    plot->setNames([this](int iteration) { return model_.iterationName(iteration); });
    ui_.plotRow->addWidget(plot);
    connect(plot, &DoublePlot::chosen, this, [this](int iteration) {
      view_.setCursor({iteration, Stage::kFinished});
    });
  }
  view_.onChange(ViewChange::kSnapshot, this, &IterationsPanel::showSnapshot);
  view_.onChange(ViewChange::kCursor, this, &IterationsPanel::showCursor);
  showSnapshot();
  showCursor();
}

void IterationsPanel::buildTable() {
  setUpTable(*ui_.iterations, model_);
  using Model = IterationsModel;
  new ColumnFitter(*ui_.iterations,
                   {Model::kPose_ms, Model::kMatching_ms, Model::kRendering_ms, Model::kHypothesis,
                    Model::kMeanScore, Model::kBestScore, Model::kThreshold_px, Model::kLevel,
                    Model::kTemplates, Model::kImage_px, Model::kMatches, Model::kRotation_deg});
  connect(ui_.iterations->selectionModel(), &QItemSelectionModel::currentRowChanged, this,
          [this](const QModelIndex& current) {
            if (!showing_ && current.isValid())
              view_.setCursor({IterationsModel::iterationOf(current.row()), Stage::kFinished});
          });
  hint_ = new EmptyHint(*ui_.iterations, IterationsModel::rowOf(0));
}

QVector<QPointF> IterationsPanel::pointsOf(IterationsModel::Column column) const {
  QVector<QPointF> points;
  for (int i = 0; i < IterationsModel::iterationOf(model_.rowCount()); ++i) {
    const double value = model_.number(i, column);
    if (!std::isnan(value)) points.append({static_cast<double>(i), value});
  }
  return points;
}

void IterationsPanel::showSnapshot() {
  showing_ = true;
  model_.setSnapshot(view_.snapshot());
  showing_ = false;
  hint_->setText(
      view_.snapshot()
          ? tr("The first iteration is listed here as soon as one of its stages is done.")
          : tr("Run the case to its end (F5), by an iteration (F6) or a stage (F7). Each iteration "
               "is a row; every view shows the selected one."));
  ui_.iterations->resizeColumnsToContents();
  ui_.plots->setVisible(model_.rowCount() > IterationsModel::rowOf(0));
  const int count = std::max(0, IterationsModel::iterationOf(model_.rowCount()));
  corrections_->setPoints(count, pointsOf(IterationsModel::kTranslation_mm),
                          pointsOf(IterationsModel::kRotation_deg));
  fit_->setPoints(count, pointsOf(IterationsModel::kInliers), pointsOf(IterationsModel::kRms_px));
}

void IterationsPanel::showCursor() {
  const int iteration = view_.cursor().iteration;
  followRow(*ui_.iterations, model_.index(IterationsModel::rowOf(iteration), 0), showing_);
  corrections_->setMarked(iteration);
  fit_->setMarked(iteration);
}

}  // namespace boresight::ui
