// SPDX-License-Identifier: Apache-2.0
#include "ui/models/iterations_model.h"

#include <algorithm>
#include <array>
#include <limits>

#include <QCoreApplication>

#include "core/base/math.h"
#include "ui/models/column_info.h"
#include "ui/models/number_text.h"

namespace boresight::ui {

using sessions::IterationTrace;

namespace {

constexpr double kUnknown = std::numeric_limits<double>::quiet_NaN();

constexpr const char* kContext = "boresight::ui::IterationsModel";

constexpr std::array<ColumnInfo, IterationsModel::kColumnCount> kColumns = {{
    {QT_TRANSLATE_NOOP("boresight::ui::IterationsModel", "Iteration"),
     QT_TRANSLATE_NOOP("boresight::ui::IterationsModel",
                       "Attempt and iteration: 2.3 is the third iteration of the second attempt. "
                       "An attempt that fails starts anew from the seed."),
     -1},
    {QT_TRANSLATE_NOOP("boresight::ui::IterationsModel", "Kind"),
     QT_TRANSLATE_NOOP("boresight::ui::IterationsModel",
                       "match: templates are searched and a pose is solved from them; refine: the "
                       "pose moves until rendered edges meet the image's own; restarts: the best "
                       "of several turned or moved seeds goes on."),
     -1},
    {QT_TRANSLATE_NOOP("boresight::ui::IterationsModel", "Hypothesis"),
     QT_TRANSLATE_NOOP("boresight::ui::IterationsModel",
                       "Which render the iteration went on with: its turn in degrees, of restarts "
                       "also its step in depth in mm, and how many there were. Point at a cell for "
                       "all of them."),
     -1},
    {QT_TRANSLATE_NOOP("boresight::ui::IterationsModel", "Level"),
     QT_TRANSLATE_NOOP("boresight::ui::IterationsModel",
                       "Level of the image pyramid: 0 is the full image, each further one has half "
                       "its size."),
     0},
    {QT_TRANSLATE_NOOP("boresight::ui::IterationsModel", "Moved, mm"),
     QT_TRANSLATE_NOOP("boresight::ui::IterationsModel",
                       "How far this iteration moved the pose, in mm."),
     3},
    {QT_TRANSLATE_NOOP("boresight::ui::IterationsModel", "Turned, deg"),
     QT_TRANSLATE_NOOP("boresight::ui::IterationsModel",
                       "How far this iteration turned the pose, in degrees."),
     3},
    {QT_TRANSLATE_NOOP("boresight::ui::IterationsModel", "In image, px"),
     QT_TRANSLATE_NOOP("boresight::ui::IterationsModel",
                       "How far the correction moves the scene in the image: mean over the corners "
                       "of its box, in pixels of the full image."),
     2},
    {QT_TRANSLATE_NOOP("boresight::ui::IterationsModel", "Templates"),
     QT_TRANSLATE_NOOP("boresight::ui::IterationsModel",
                       "Templates cut from the render; of a refinement: places along the rendered "
                       "edges."),
     0},
    {QT_TRANSLATE_NOOP("boresight::ui::IterationsModel", "Matches"),
     QT_TRANSLATE_NOOP("boresight::ui::IterationsModel",
                       "Templates that could be searched in the image; of a refinement: places "
                       "where an image edge was found."),
     0},
    {QT_TRANSLATE_NOOP("boresight::ui::IterationsModel", "Inliers"),
     QT_TRANSLATE_NOOP("boresight::ui::IterationsModel",
                       "Matches that agree with the pose; of a refinement: places that were used."),
     0},
    {QT_TRANSLATE_NOOP("boresight::ui::IterationsModel", "Threshold, px"),
     QT_TRANSLATE_NOOP("boresight::ui::IterationsModel",
                       "Residual up to which a match is an inlier, in pixels of the full image; of "
                       "a refinement: how far an edge is looked for."),
     1},
    {QT_TRANSLATE_NOOP("boresight::ui::IterationsModel", "Best score"),
     QT_TRANSLATE_NOOP("boresight::ui::IterationsModel",
                       "Highest similarity S of a match; 2 is perfect."),
     3},
    {QT_TRANSLATE_NOOP("boresight::ui::IterationsModel", "Mean score"),
     QT_TRANSLATE_NOOP("boresight::ui::IterationsModel",
                       "Mean similarity S over the matches; 2 is perfect."),
     3},
    {QT_TRANSLATE_NOOP("boresight::ui::IterationsModel", "RMS, px"),
     QT_TRANSLATE_NOOP("boresight::ui::IterationsModel",
                       "Root mean square residual of the inliers, in pixels of the full image."),
     2},
    {QT_TRANSLATE_NOOP("boresight::ui::IterationsModel", "Render, ms"),
     QT_TRANSLATE_NOOP("boresight::ui::IterationsModel",
                       "Wall time of rendering the scene's edges, in ms."),
     0},
    {QT_TRANSLATE_NOOP("boresight::ui::IterationsModel", "Match, ms"),
     QT_TRANSLATE_NOOP("boresight::ui::IterationsModel",
                       "Wall time of choosing and searching templates, in ms."),
     0},
    {QT_TRANSLATE_NOOP("boresight::ui::IterationsModel", "Pose, ms"),
     QT_TRANSLATE_NOOP("boresight::ui::IterationsModel",
                       "Wall time of solving for the pose, or of refining it, in ms."),
     0},
    {QT_TRANSLATE_NOOP("boresight::ui::IterationsModel", "Status"),
     QT_TRANSLATE_NOOP("boresight::ui::IterationsModel",
                       "How the iteration ended, or the last stage of it that is complete."),
     -1},
}};

const ColumnInfo& columnInfo(int column) { return kColumns[static_cast<std::size_t>(column)]; }

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

/// "+40.0 deg", "+40.0 deg, -25 mm".
QString placeText(const HypothesisSummary& one) {
  const auto sign = [](double value) { return QLatin1String(value < 0.0 ? "" : "+"); };
  const double turn_deg = one.roll_rad / kDegree_rad;
  QString text = sign(turn_deg) + numberText(turn_deg, 1) + QStringLiteral(" deg");
  const double depth_mm = 1e3 * one.depth_offset_m;
  if (depth_mm != 0.0)
    text += QStringLiteral(", ") + sign(depth_mm) + numberText(depth_mm, 0) + QStringLiteral(" mm");
  return text;
}

double ofPose(const IterationTrace& one, double value) { return isSolved(one) ? value : kUnknown; }

double ofStage(const IterationTrace& one, Stage stage, double value) {
  return one.reached >= stage ? value : kUnknown;
}

double countOf(const IterationTrace& one, IterationsModel::Column column) {
  if (one.kind == IterationKind::kRefine) {
    const sessions::RefinementTrace& refinement = one.refinement;
    const int value = column == IterationsModel::kTemplates ? refinement.sample_count
                      : column == IterationsModel::kMatches ? refinement.found_count
                                                            : refinement.used_count;
    return ofStage(one, Stage::kRefine, value);
  }
  switch (column) {
    case IterationsModel::kTemplates:
      return ofStage(one, Stage::kTemplates, one.template_count);
    case IterationsModel::kMatches:
      return ofStage(one, Stage::kMatch, one.searched_count);
    default:
      return ofStage(one, Stage::kPose, one.support());
  }
}

double numberOf(const IterationTrace& one, IterationsModel::Column column) {
  const bool matches = one.kind == IterationKind::kMatch;
  switch (column) {
    case IterationsModel::kLevel:
      return one.level;
    case IterationsModel::kTranslation_mm:
      return ofPose(one, 1e3 * one.correction_translation_m);
    case IterationsModel::kRotation_deg:
      return ofPose(one, one.correction_rotation_rad / kDegree_rad);
    case IterationsModel::kImage_px:
      return ofPose(one, one.correction_image_px);
    case IterationsModel::kTemplates:
    case IterationsModel::kMatches:
    case IterationsModel::kInliers:
      return countOf(one, column);
    case IterationsModel::kThreshold_px:
      return one.threshold_px;
    case IterationsModel::kBestScore:
      return matches ? ofStage(one, Stage::kMatch, one.best_score) : kUnknown;
    case IterationsModel::kMeanScore:
      return matches ? ofStage(one, Stage::kMatch, one.mean_score) : kUnknown;
    case IterationsModel::kRms_px:
      return ofPose(one, one.rms_px());
    case IterationsModel::kRendering_ms:
      return 1e3 * one.seconds.rendering;
    case IterationsModel::kMatching_ms:
      return matches ? ofStage(one, Stage::kTemplates, 1e3 * one.seconds.matching) : kUnknown;
    case IterationsModel::kPose_ms:
      return ofStage(one, Stage::kPose, 1e3 * (one.seconds.pose + one.seconds.refinement));
    case IterationsModel::kNumber:
    case IterationsModel::kKind:
    case IterationsModel::kHypothesis:
    case IterationsModel::kStatus:
    case IterationsModel::kColumnCount:
      break;
  }
  return kUnknown;
}

}  // namespace

IterationsModel::IterationsModel(QObject* parent) : QAbstractTableModel(parent) {}

int IterationsModel::iterationCount() const {
  return snapshot_ ? static_cast<int>(snapshot_->iterations.size()) : 0;
}

const IterationTrace& IterationsModel::iteration(int index) const {
  return *snapshot_->iterations[static_cast<std::size_t>(index)];
}

/// All iterations but the last one are the same records, and none was lost.
bool IterationsModel::continues(const sessions::LocalizationTrace& next) const {
  if (!snapshot_ || snapshot_->iterations.empty()) return false;
  const auto& before = snapshot_->iterations;
  const auto& after = next.iterations;
  if (after.size() < before.size()) return false;
  return std::equal(before.begin(), before.end() - 1, after.begin());
}

void IterationsModel::setSnapshot(SnapshotPtr snapshot) {
  if (!snapshot || !continues(*snapshot)) {
    beginResetModel();
    snapshot_ = std::move(snapshot);
    endResetModel();
    return;
  }
  const int before = iterationCount();
  const int after = static_cast<int>(snapshot->iterations.size());
  if (after > before) beginInsertRows({}, rowOf(before), rowOf(after - 1));
  snapshot_ = std::move(snapshot);
  if (after > before) endInsertRows();
  const int changed = rowOf(before - 1);
  Q_EMIT dataChanged(index(changed, 0), index(changed, kColumnCount - 1));
}

int IterationsModel::rowCount(const QModelIndex& parent) const {
  return parent.isValid() || !snapshot_ ? 0 : iterationCount() + 1;
}

int IterationsModel::columnCount(const QModelIndex& parent) const {
  return parent.isValid() ? 0 : kColumnCount;
}

QString IterationsModel::iterationName(int index) const {
  if (index < 0 || index >= iterationCount()) return tr("seed");
  const int attempt = iteration(index).attempt;
  int first = index;
  while (first > 0 && iteration(first - 1).attempt == attempt) --first;
  return QStringLiteral("%1.%2").arg(attempt + 1).arg(index - first + 1);
}

double IterationsModel::number(int index, Column column) const {
  if (index < 0 || index >= iterationCount()) return kUnknown;
  return numberOf(iteration(index), column);
}

QString IterationsModel::statusOf(int index) const {
  const IterationTrace& one = iteration(index);
  const bool last = index + 1 == iterationCount();
  if (last && snapshot_->last_under_way)
    return tr("%1 done").arg(QString::fromLatin1(stageText(one.reached)));
  // The end of the run is not noted in the iteration that brought it.
  const LocalizationStatus status =
      last && one.status == LocalizationStatus::kRunning ? snapshot_->status : one.status;
  if (status == LocalizationStatus::kRunning) return last ? tr("halted") : tr("went on");
  return QString::fromLatin1(localizationStatusText(status))
      .replace(QLatin1Char('_'), QLatin1Char(' '));
}

QString IterationsModel::text(int index, Column column) const {
  if (index < 0) return column == kNumber ? iterationName(index) : QString();
  switch (column) {
    case kNumber:
      return iterationName(index);
    case kKind:
      if (iteration(index).wide) return tr("restarts");
      return iteration(index).kind == IterationKind::kRefine ? tr("refine") : tr("match");
    case kHypothesis:
      return hypothesisText(index);
    case kStatus:
      return statusOf(index);
    default:
      return numberText(number(index, column), columnInfo(column).decimals);
  }
}

QString IterationsModel::hypothesisText(int index) const {
  const IterationTrace& one = iteration(index);
  const HypothesisSummary* chosen = chosenOf(one);
  if (chosen == nullptr) return {};
  return tr("%1 (of %2)").arg(placeText(*chosen)).arg(one.hypotheses.size());
}

/// One line per hypothesis, the one chosen marked.
QString IterationsModel::hypothesesList(int index) const {
  const IterationTrace& one = iteration(index);
  if (chosenOf(one) == nullptr) return {};
  QStringList lines;
  for (std::size_t i = 0; i < one.hypotheses.size(); ++i) {
    const HypothesisSummary& each = one.hypotheses[i];
    QString line =
        tr("%1: %2 of %3 inliers").arg(placeText(each)).arg(each.inliers).arg(each.matches);
    if (one.wide)
      line += tr(", evidence %1, edge support %2")
                  .arg(numberText(each.evidence(), 0), numberText(each.support, 2));
    if (!each.solved) line += tr(", no pose");
    if (static_cast<int>(i) == one.chosen_hypothesis) line += tr(" (chosen)");
    lines << line;
  }
  return lines.join(QLatin1Char('\n'));
}

QVariant IterationsModel::data(const QModelIndex& index, int role) const {
  if (!index.isValid() || index.row() >= rowCount()) return {};
  const auto column = static_cast<Column>(index.column());
  const int shown = iterationOf(index.row());
  switch (role) {
    case Qt::DisplayRole:
      return text(shown, column);
    case kNumberRole:
      return number(shown, column);
    case Qt::ToolTipRole:
      if (column == kHypothesis && shown >= 0) return hypothesesList(shown);
      return columnCell(kContext, columnInfo(column), role);
    default:
      return columnCell(kContext, columnInfo(column), role);
  }
}

QVariant IterationsModel::headerData(int section, Qt::Orientation orientation, int role) const {
  return columnHeader(kContext, kColumns, section, orientation, role);
}

}  // namespace boresight::ui
