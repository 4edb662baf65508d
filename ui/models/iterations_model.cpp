// SPDX-License-Identifier: Apache-2.0
#include "ui/models/iterations_model.h"

#include <algorithm>

#include "core/base/math.h"
#include "sessions/text/units.h"
#include "ui/models/number_text.h"

namespace boresight::ui {

using sessions::IterationTrace;
using sessions::kUnknown;

namespace {

/// Whether a pose came out of the iteration.
bool isSolved(const IterationTrace& one) {
  return one.reached >= Stage::kPose && one.status != LocalizationStatus::kPnpFailed &&
         one.status != LocalizationStatus::kFault;
}

const HypothesisSummary* chosenOf(const IterationTrace& one) {
  const auto chosen = static_cast<std::size_t>(one.chosen_hypothesis);
  if (one.kind == IterationKind::kRefine || chosen >= one.hypotheses.size()) return nullptr;
  return &one.hypotheses[chosen];
}

/// "+40.0 deg".
QString placeText(const HypothesisSummary& one) {
  const double turn_deg = one.roll_rad / kDegree_rad;
  return QLatin1String(turn_deg < 0.0 ? "" : "+") + numberText(turn_deg, 1) +
         QStringLiteral(" deg");
}

double ofPose(const IterationTrace& one, double value) { return isSolved(one) ? value : kUnknown; }

double ofStage(const IterationTrace& one, Stage stage, double value) {
  return one.reached >= stage ? value : kUnknown;
}

/// Counts of a refinement are of places along edges.
double countOf(const IterationTrace& one, Stage stage, int of_match, int of_refinement) {
  const bool refines = one.kind == IterationKind::kRefine;
  return ofStage(one, refines ? Stage::kRefine : stage, refines ? of_refinement : of_match);
}

double ofMatch(const IterationTrace& one, Stage stage, double value) {
  return one.kind == IterationKind::kMatch ? ofStage(one, stage, value) : kUnknown;
}

QString hypothesisText(const IterationTrace& one) {
  const HypothesisSummary* chosen = chosenOf(one);
  if (chosen == nullptr) return {};
  return IterationsModel::tr("%1 (of %2)").arg(placeText(*chosen)).arg(one.hypotheses.size());
}

/// One line per hypothesis, the one chosen marked.
QString hypothesesList(const IterationTrace& one) {
  constexpr auto tr = [](const char* text) { return IterationsModel::tr(text); };
  if (chosenOf(one) == nullptr) return {};
  QStringList lines;
  for (std::size_t i = 0; i < one.hypotheses.size(); ++i) {
    const HypothesisSummary& each = one.hypotheses[i];
    QString line =
        tr("%1: %2 of %3 inliers").arg(placeText(each)).arg(each.inliers).arg(each.matches);
    if (!each.solved) line += tr(", no pose");
    if (static_cast<int>(i) == one.chosen_hypothesis) line += tr(" (chosen)");
    lines << line;
  }
  return lines.join(QLatin1Char('\n'));
}

QString kindText(const IterationTrace& one) {
  return one.kind == IterationKind::kRefine ? IterationsModel::tr("refine")
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
       tr("Attempt and iteration: 2.3 is the third iteration of the second attempt. An attempt "
          "that fails is followed by one from the seed."),
       -1, [](Line row) { return row.name; }},
      {tr("Kind"),
       tr("match: templates are searched and a pose is solved from them; refine: the pose moves "
          "until rendered edges meet the image's own."),
       -1, text(kindText)},
      {tr("Hypothesis"),
       tr("Which render the iteration went on with: its turn in degrees, and how many there were. "
          "Point at a cell for all of them."),
       -1, text(hypothesisText)},
      {tr("Level"),
       tr("Level of the image pyramid: 0 is the full image, each further one has half its size."),
       0, number([](Trace one) -> double { return one.level; })},
      {tr("Moved, mm"), tr("How far this iteration moved the pose, in mm."), 3,
       number([](Trace one) { return ofPose(one, 1e3 * one.correction_translation_m); })},
      {tr("Turned, deg"), tr("How far this iteration turned the pose, in degrees."), 3,
       number([](Trace one) { return ofPose(one, one.correction_rotation_rad / kDegree_rad); })},
      {tr("In image, px"),
       tr("How far the correction moves the scene in the image: mean over the corners of its box, "
          "in pixels of the full image."),
       2, number([](Trace one) { return ofPose(one, one.correction_image_px); })},
      {tr("Templates"),
       tr("Templates cut from the render; of a refinement: places along the rendered edges."), 0,
       number([](Trace one) {
         return countOf(one, Stage::kTemplates, one.template_count, one.refinement.sample_count);
       })},
      {tr("Matches"),
       tr("Templates that could be searched in the image; of a refinement: places where an image "
          "edge was found."),
       0, number([](Trace one) {
         return countOf(one, Stage::kMatch, one.searched_count, one.refinement.found_count);
       })},
      {tr("Inliers"),
       tr("Matches that agree with the pose; of a refinement: places that were used."), 0,
       number([](Trace one) {
         return countOf(one, Stage::kPose, one.support(), one.refinement.used_count);
       })},
      {tr("Threshold, px"),
       tr("Residual up to which a match is an inlier, in pixels of the full image; of a "
          "refinement: how far an edge is looked for."),
       1, number([](Trace one) { return one.threshold_px; })},
      {tr("Best score"), tr("Highest similarity S of a match; 2 is perfect."), 3,
       number([](Trace one) { return ofMatch(one, Stage::kMatch, one.best_score); })},
      {tr("Mean score"), tr("Mean similarity S over the matches; 2 is perfect."), 3,
       number([](Trace one) { return ofMatch(one, Stage::kMatch, one.mean_score); })},
      {tr("RMS, px"), tr("Root mean square residual of the inliers, in pixels of the full image."),
       2, number([](Trace one) { return ofPose(one, one.rms_px()); })},
      {tr("Render, ms"), tr("Wall time of rendering the scene's edges, in ms."), 0,
       number([](Trace one) { return 1e3 * one.seconds.rendering; })},
      {tr("Match, ms"), tr("Wall time of choosing and searching templates, in ms."), 0,
       number(
           [](Trace one) { return ofMatch(one, Stage::kTemplates, 1e3 * one.seconds.matching); })},
      {tr("Pose, ms"), tr("Wall time of solving for the pose, or of refining it, in ms."), 0,
       number([](Trace one) {
         return ofStage(one, Stage::kPose, 1e3 * (one.seconds.pose + one.seconds.refinement));
       })},
      {tr("Status"), tr("How the iteration ended, or the last stage of it that is complete."), -1,
       [](Line row) { return row.status; }},
  };
}

QString statusText(const sessions::LocalizationTrace& run, std::size_t index) {
  const IterationTrace& one = *run.iterations[index];
  const bool last = index + 1 == run.iterations.size();
  if (last && run.last_under_way)
    return IterationsModel::tr("%1 done").arg(QString::fromLatin1(stageText(one.reached)));
  // The end of the run is not noted in the iteration that brought it.
  const LocalizationStatus status =
      last && one.status == LocalizationStatus::kRunning ? run.status : one.status;
  if (status == LocalizationStatus::kRunning)
    return last ? IterationsModel::tr("halted") : IterationsModel::tr("went on");
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

IterationsModel::IterationsModel(QObject* parent) : RowsModel(iterationColumns(), parent) {}

void IterationsModel::setSnapshot(SnapshotPtr snapshot) {
  std::vector<IterationRow> rows;
  if (snapshot) rows.push_back({tr("seed"), nullptr, {}});
  int number = 0;
  for (std::size_t i = 0; snapshot && i < snapshot->iterations.size(); ++i) {
    const auto& one = snapshot->iterations[i];
    number = i > 0 && one->attempt == snapshot->iterations[i - 1]->attempt ? number + 1 : 1;
    rows.push_back(
        {QStringLiteral("%1.%2").arg(one->attempt + 1).arg(number), one, statusText(*snapshot, i)});
  }
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

}  // namespace boresight::ui
