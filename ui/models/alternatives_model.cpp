// SPDX-License-Identifier: Apache-2.0
#include "ui/models/alternatives_model.h"

#include <utility>

#include <QFont>

#include "core/base/math.h"
#include "core/localizer/acceptance.h"
#include "sessions/text/units.h"
#include "ui/models/number_text.h"

namespace boresight::ui {

using sessions::Alternative;
using sessions::AlternativeKind;
using sessions::kUnknown;

namespace {

QString tr(const char* text) { return AlternativesModel::tr(text); }

QString signedText(double value, int decimals) {
  return QLatin1String(value < 0.0 ? "" : "+") + numberText(value, decimals);
}

QString endedText(const Alternative& one) {
  if (one.chosen) return tr("chosen");
  return one.has_pose ? tr("not chosen") : tr("no pose");
}

std::vector<TableColumn<Alternative>> alternativeColumns() {
  using Row = const Alternative&;
  const auto ofOthers = [](Row one, int count) {
    return one.kind == AlternativeKind::kRolled ? count : kUnknown;
  };
  return {
      {tr("Pose"),
       tr("A competing pose: it shows about the same edges as the result. A candidate: a pose that "
          "the search found. A rolled hypothesis: the render turned about "
          "the view."),
       -1, alternativeTitle},
      {tr("Iteration"),
       tr("The iteration that weighed it, counted from 1 over all attempts; competing poses "
          "are compared with the result."),
       -1,
       [](Row one) {
         if (one.kind == AlternativeKind::kCandidate) return tr("search");
         return one.iteration < 0 ? tr("result") : QString::number(one.iteration + 1);
       }},
      {tr("Ended"), tr("Whether the run went on with it."), -1, endedText},
      {tr("Behind, nats"),
       tr("Evidence of the result beyond that of a competing pose, in nats; below %1 the run is "
          "ambiguous, below zero the competing pose is the better one.")
           .arg(kLeastMargin_nats),
       0, [](Row one) { return one.margin_nats; }},
      {tr("Similarity"),
       tr("Share of the rendered edges that a competing pose has in common with the result."), 2,
       [](Row one) { return one.similarity; }},
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

QString alternativeTitle(const Alternative& one) {
  if (one.kind == AlternativeKind::kCompeting) return tr("Competing pose %1").arg(one.number);
  if (one.kind == AlternativeKind::kCandidate) return tr("Candidate %1").arg(one.number);
  return tr("Rolled by %1 deg").arg(signedText(one.roll_rad / kDegree_rad, 1));
}

QString chosenTitle(const Alternative& one) {
  switch (one.kind) {
    case AlternativeKind::kCompeting:
      return tr("Result of the run");
    case AlternativeKind::kCandidate:
      return tr("Chosen candidate");
    case AlternativeKind::kRolled:
      return tr("Chosen roll");
  }
  return {};
}

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

}  // namespace boresight::ui
