// SPDX-License-Identifier: Apache-2.0
#include "ui/models/alternatives_model.h"

#include <array>
#include <limits>
#include <utility>

#include <QFont>

#include "core/base/math.h"
#include "ui/models/column_info.h"
#include "ui/models/number_text.h"

namespace boresight::ui {

using sessions::Alternative;
using sessions::AlternativeKind;

namespace {

constexpr double kUnknown = std::numeric_limits<double>::quiet_NaN();

constexpr const char* kContext = "boresight::ui::AlternativesModel";

constexpr std::array<ColumnInfo, AlternativesModel::kColumnCount> kColumns = {{
    {QT_TRANSLATE_NOOP("boresight::ui::AlternativesModel", "Pose"),
     QT_TRANSLATE_NOOP("boresight::ui::AlternativesModel",
                       "A rival: a pose under which the model's edges look like those of the "
                       "result. A restart of the wide search: the seed turned, and moved in depth. "
                       "A rolled hypothesis: the render turned about the view."),
     -1},
    {QT_TRANSLATE_NOOP("boresight::ui::AlternativesModel", "Iteration"),
     QT_TRANSLATE_NOOP("boresight::ui::AlternativesModel",
                       "The iteration that weighed it, counted from 1 over all attempts; rivals "
                       "are weighed against the result."),
     -1},
    {QT_TRANSLATE_NOOP("boresight::ui::AlternativesModel", "Ended"),
     QT_TRANSLATE_NOOP("boresight::ui::AlternativesModel",
                       "What became of it; a rival that converged is a pose that the image "
                       "supports."),
     -1},
    {QT_TRANSLATE_NOOP("boresight::ui::AlternativesModel", "Behind, nats"),
     QT_TRANSLATE_NOOP("boresight::ui::AlternativesModel",
                       "Evidence of the result beyond that of a rival that converged, in nats; "
                       "below ambiguity.min_margin_nats the run is ambiguous, below zero the rival "
                       "is the better one."),
     0},
    {QT_TRANSLATE_NOOP("boresight::ui::AlternativesModel", "Similarity"),
     QT_TRANSLATE_NOOP("boresight::ui::AlternativesModel",
                       "How much the model's edges look like themselves where the rival puts them; "
                       "1: the same."),
     2},
    {QT_TRANSLATE_NOOP("boresight::ui::AlternativesModel", "Evidence, nats"),
     QT_TRANSLATE_NOOP("boresight::ui::AlternativesModel",
                       "How improbable a restart's inliers and met edges are by chance, in nats."),
     0},
    {QT_TRANSLATE_NOOP("boresight::ui::AlternativesModel", "Edge support"),
     QT_TRANSLATE_NOOP("boresight::ui::AlternativesModel",
                       "Share of a restart's rendered edges that the image has, beyond chance."),
     2},
    {QT_TRANSLATE_NOOP("boresight::ui::AlternativesModel", "Inliers"),
     QT_TRANSLATE_NOOP("boresight::ui::AlternativesModel", "Matches that agree with its pose."), 0},
    {QT_TRANSLATE_NOOP("boresight::ui::AlternativesModel", "Matches"),
     QT_TRANSLATE_NOOP("boresight::ui::AlternativesModel", "Templates that could be searched."), 0},
    {QT_TRANSLATE_NOOP("boresight::ui::AlternativesModel", "Apart, mm"),
     QT_TRANSLATE_NOOP("boresight::ui::AlternativesModel",
                       "How far the station's origin lies from where the chosen pose puts it, mm."),
     2},
    {QT_TRANSLATE_NOOP("boresight::ui::AlternativesModel", "Apart, deg"),
     QT_TRANSLATE_NOOP("boresight::ui::AlternativesModel",
                       "How far it is turned from the chosen pose, in degrees."),
     2},
}};

const ColumnInfo& columnInfo(int column) { return kColumns[static_cast<std::size_t>(column)]; }

QString tr(const char* text) { return AlternativesModel::tr(text); }

QString signedText(double value, int decimals) {
  return QLatin1String(value < 0.0 ? "" : "+") + numberText(value, decimals);
}

QString endedText(const Alternative& one) {
  if (one.chosen) return tr("chosen");
  if (one.kind != AlternativeKind::kRival)
    return one.ended == LocalizationStatus::kRunning ? tr("passed over") : tr("no pose");
  if (one.ended == LocalizationStatus::kRunning) return tr("not tried");
  return QString::fromLatin1(localizationStatusText(one.ended))
      .replace(QLatin1Char('_'), QLatin1Char(' '));
}

}  // namespace

QString alternativeTitle(const Alternative& one) {
  if (one.kind == AlternativeKind::kRival) return tr("Rival %1").arg(one.number);
  const QString turn = signedText(one.roll_rad / kDegree_rad, 1);
  if (one.kind == AlternativeKind::kRolled) return tr("Rolled by %1 deg").arg(turn);
  const QString text = tr("Restart %1 deg").arg(turn);
  if (one.depth_offset_m == 0.0) return text;
  return tr("%1, %2 mm").arg(text, signedText(1e3 * one.depth_offset_m, 0));
}

QString chosenTitle(const Alternative& one) {
  switch (one.kind) {
    case AlternativeKind::kRival:
      return tr("Result of the run");
    case AlternativeKind::kRestart:
      return tr("Chosen restart");
    case AlternativeKind::kRolled:
      return tr("Chosen roll");
  }
  return {};
}

AlternativesModel::AlternativesModel(QObject* parent) : QAbstractTableModel(parent) {}

void AlternativesModel::setAlternatives(std::vector<Alternative> alternatives) {
  beginResetModel();
  alternatives_ = std::move(alternatives);
  endResetModel();
}

int AlternativesModel::firstRowOf(int iteration) const {
  for (std::size_t i = 0; i < alternatives_.size(); ++i)
    if (iteration >= 0 && alternatives_[i].iteration == iteration) return static_cast<int>(i);
  return -1;
}

int AlternativesModel::rowCount(const QModelIndex& parent) const {
  return parent.isValid() ? 0 : static_cast<int>(alternatives_.size());
}

int AlternativesModel::columnCount(const QModelIndex& parent) const {
  return parent.isValid() ? 0 : kColumnCount;
}

double AlternativesModel::number(const Alternative& one, Column column) {
  const bool rival = one.kind == AlternativeKind::kRival;
  switch (column) {
    case kMargin_nats:
      return one.margin_nats;
    case kSimilarity:
      return one.similarity;
    case kEvidence_nats:
      return one.evidence_nats;
    case kSupport:
      return one.support;
    case kInliers:
      return rival ? kUnknown : one.inliers;
    case kMatches:
      return rival ? kUnknown : one.matches;
    case kApart_mm:
      return 1e3 * one.apart_m;
    case kApart_deg:
      return one.apart_rad / kDegree_rad;
    case kPose:
    case kIteration:
    case kEnded:
    case kColumnCount:
      break;
  }
  return kUnknown;
}

QString AlternativesModel::text(const Alternative& one, Column column) {
  switch (column) {
    case kPose:
      return alternativeTitle(one);
    case kIteration:
      return one.iteration < 0 ? tr("result") : QString::number(one.iteration + 1);
    case kEnded:
      return endedText(one);
    default:
      return numberText(number(one, column), columnInfo(column).decimals);
  }
}

QVariant AlternativesModel::data(const QModelIndex& index, int role) const {
  if (!index.isValid() || index.row() >= rowCount()) return {};
  const auto column = static_cast<Column>(index.column());
  const Alternative& one = alternative(index.row());
  switch (role) {
    case Qt::DisplayRole:
      return text(one, column);
    case kNumberRole:
      return number(one, column);
    case Qt::FontRole: {
      if (!one.chosen) return {};
      QFont bold;
      bold.setBold(true);
      return bold;
    }
    default:
      return columnCell(kContext, columnInfo(column), role);
  }
}

QVariant AlternativesModel::headerData(int section, Qt::Orientation orientation, int role) const {
  return columnHeader(kContext, kColumns, section, orientation, role);
}

}  // namespace boresight::ui
