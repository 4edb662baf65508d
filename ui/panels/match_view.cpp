// SPDX-License-Identifier: Apache-2.0
#include "ui/panels/match_view.h"

#include <cmath>

#include <QtWidgets>

#include "core/base/math.h"
#include "ui/models/number_text.h"
#include "ui/models/templates_model.h"
#include "ui/panels/pixel_picture.h"
#include "ui/panels/score_map_view.h"

namespace boresight::ui {

using sessions::MatchDetails;

namespace {

QString rowText(const QString& name, const QString& value) {
  return QStringLiteral("<tr><td style='padding-right:12px'>%1:</td><td>%2</td></tr>")
      .arg(name.toHtmlEscaped(), value.toHtmlEscaped());
}

QString pairText(const Eigen::Vector2d& pixel, int decimals) {
  return QStringLiteral("%1, %2").arg(numberText(pixel.x(), decimals),
                                      numberText(pixel.y(), decimals));
}

/// The score beside the second peak's.
QString scoreText(const MatchDetails& details) {
  const QString score = numberText(details.score, 3);
  if (std::isnan(details.margin)) return MatchView::tr("%1, no second peak").arg(score);
  const QString text =
      MatchView::tr("%1, second peak %2, margin %3 %")
          .arg(score, numberText(details.second_score, 3), numberText(100.0 * details.margin, 1));
  return details.hasLowMargin() ? text + MatchView::tr(" (low)") : text;
}

QString countText(int part, int whole, double share) {
  return MatchView::tr("%1 = %2 of %3 px").arg(numberText(share, 3)).arg(part).arg(whole);
}

}  // namespace

MatchView::MatchView(QWidget* parent) : QWidget(parent) {
  auto* column = new QVBoxLayout(this);
  column->setContentsMargins(0, 0, 0, 0);
  auto* pictures = new QHBoxLayout;
  template_ = new PixelPicture(tr("Template"), this);
  found_ = new PixelPicture(tr("Found"), this);
  agreement_ = new PixelPicture(tr("Agreement"), this);
  template_->setToolTip(tr("Rendered edges (white) on the station's surface (gray)."));
  found_->setToolTip(tr("The image's edges where the template was found."));
  agreement_->setToolTip(
      tr("White: rendered and seen. Orange: rendered, not seen (lowers S+). "
         "Blue: seen, not rendered (lowers S-)."));
  for (PixelPicture* picture : {template_, found_}) pictures->addWidget(picture, 3);
  pictures->addWidget(agreement_, 4);  // its legend is long
  map_ = new ScoreMapView(this);
  pictures->addWidget(map_, 4);
  column->addLayout(pictures, 1);
  auto* figures = new QHBoxLayout;
  places_ = addFigures(*figures, QStringLiteral("places"));
  scores_ = addFigures(*figures, QStringLiteral("scores"));
  column->addLayout(figures);
  connect(&mapper_, &ScoreMapper::ready, this, &MatchView::showMap);
}

QLabel* MatchView::addFigures(QHBoxLayout& row, const QString& name) {
  auto* label = new QLabel(this);
  label->setObjectName(name);
  label->setTextFormat(Qt::RichText);
  label->setWordWrap(true);
  label->setAlignment(Qt::AlignLeft | Qt::AlignTop);
  label->setTextInteractionFlags(Qt::TextSelectableByMouse | Qt::TextSelectableByKeyboard);
  row.addWidget(label, 1);
  return label;
}

void MatchView::showNote(const QString& note) {
  mapper_.cancel();
  computing_ = false;
  shown_ = {};
  for (PixelPicture* picture : {template_, found_, agreement_}) {
    picture->setPicture({});
    picture->setNote({});
  }
  places_->clear();
  scores_->clear();
  map_->setNote(note);
}

void MatchView::showMatch(const ScoreMapper::Request& request) {
  shown_ = request;
  const sessions::IterationTrace& iteration = *request.iteration;
  const auto index = static_cast<std::size_t>(request.template_index);
  const bool searched = index < iteration.matches.size() && iteration.matches[index].searched;
  const Match* match = searched ? &iteration.matches[index] : nullptr;
  showPictures(*request.edges, iteration, index, match);
  showFigures(iteration, sessions::matchDetails(iteration)[index]);
  if (!searched) {
    mapper_.cancel();
    computing_ = false;
    map_->setNote(iteration.reached < Stage::kMatch
                      ? tr("The templates have not been searched yet.")
                      : tr("This template was not searched: no part of its window lies far enough "
                           "inside the image."));
    return;
  }
  computing_ = true;
  map_->setNote(tr("Computing the score map ..."));
  if (const ScoreMapper::MapPtr known = mapper_.request(request)) showMap(known);
}

void MatchView::showMap(const ScoreMapper::MapPtr& map) {
  computing_ = false;
  if (!map) {
    map_->setNote(tr("The run's record does not hold what the score map needs."));
    return;
  }
  const auto index = static_cast<std::size_t>(shown_.template_index);
  const Template& item = shown_.iteration->templates[index];
  map_->setMap(map, {item.center_x, item.center_y, shown_.iteration->matches[index].peak});
}

void MatchView::showPictures(const sessions::EdgeMapTrace& edges,
                             const sessions::IterationTrace& iteration, std::size_t index,
                             const Match* match) {
  const Template& item = iteration.templates[index];
  const PatchPlace place{item.center_x, item.center_y, iteration.template_side_px};
  const BitImage rendered = iteration.render.edges.view();
  const BitImage mask = iteration.render.mask.view();
  template_->setPicture(templatePicture(rendered, mask, place));
  template_->setNote(
      tr("%1 x %1 px, level %2").arg(iteration.template_side_px).arg(iteration.level));
  if (match == nullptr) {
    for (PixelPicture* picture : {found_, agreement_}) {
      picture->setPicture({});
      picture->setNote(tr("not searched"));
    }
    return;
  }
  const BitImage seen = edges.level[static_cast<std::size_t>(iteration.level)].view();
  const PatchPlace there{match->peak.x, match->peak.y, iteration.template_side_px};
  found_->setPicture(seenPicture(seen, there));
  found_->setNote(tr("edges of the image"));
  agreement_->setPicture(agreementPicture(rendered, mask, place, seen, there));
  agreement_->setLegend({{patch_colors::kEdge, tr("both")},
                         {patch_colors::kOnlyRendered, tr("render")},
                         {patch_colors::kOnlySeen, tr("image")}});
}

void MatchView::showFigures(const sessions::IterationTrace& iteration,
                            const MatchDetails& details) {
  const QString begin = QStringLiteral("<table>"), end = QStringLiteral("</table>");
  const Eigen::Vector3d point_mm = 1e3 * details.point_in_station_m;
  QString places = rowText(tr("Template %1").arg(details.index + 1),
                           TemplatesModel::verdictOf(details) +
                               (details.at_border ? tr(", at the window's border") : QString()));
  places += rowText(tr("Point (station frame)"),
                    tr("%1, %2, %3 mm; depth %4 m")
                        .arg(numberText(point_mm.x(), 2), numberText(point_mm.y(), 2),
                             numberText(point_mm.z(), 2), numberText(details.depth_m, 3)));
  places += rowText(tr("Predicted at"), tr("%1 px").arg(pairText(details.predicted_px, 1)));
  QString scores;
  if (details.searched) {
    const Match& match = iteration.matches[static_cast<std::size_t>(details.index)];
    places += rowText(tr("Found at"),
                      tr("%1 px, moved by %2 px")
                          .arg(pairText(details.found_px, 2), pairText(details.moved_px(), 2)));
    scores += rowText(tr("Score S"), scoreText(details));
    const bool counted = iteration.recorded_scores.empty();
    const QString unknown = tr("not in the onboard record");
    scores += rowText(tr("S+/c+, edges"), counted ? countText(match.peak.counts.edge_hits,
                                                              match.norms.edges, details.edge_share)
                                                  : unknown);
    scores += rowText(
        tr("S-/c-, empty"),
        counted ? countText(match.peak.counts.empty_hits, match.norms.empties, details.empty_share)
                : unknown);
  }
  if (details.solved)
    scores += rowText(tr("Residual"), tr("%1 px, threshold %2 px")
                                          .arg(numberText(details.residual_px, 2),
                                               numberText(iteration.threshold_px, 2)));
  places_->setText(begin + places + end);
  scores_->setText(begin + scores + end);
}

}  // namespace boresight::ui
