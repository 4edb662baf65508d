// SPDX-License-Identifier: Apache-2.0
#include "ui/panels/diagnose/match_view.h"

#include <array>
#include <cmath>

#include <QtWidgets>

#include "core/base/math.h"
#include "ui/models/text.h"

namespace boresight::ui {

using sessions::MatchDetails;

namespace {

std::vector<TableColumn<MatchDetails>> templateColumns() {
  using Row = const MatchDetails&;
  constexpr auto tr = [](const char* text) { return TemplatesModel::tr(text); };
  return {
      {tr("Template"), tr("Number of the template, from 1."), 0,
       [](Row row) { return row.index + 1; }},
      {tr("x, px"),
       tr("Predicted position of its centre, pixels of the full image to the right of the centre "
          "of the top-left pixel."),
       1, [](Row row) { return row.predicted_px.x(); }},
      {tr("y, px"),
       tr("Predicted position of its centre, pixels of the full image below the centre of the "
          "top-left pixel."),
       1, [](Row row) { return row.predicted_px.y(); }},
      {tr("Depth, m"), tr("Distance of its point from the camera along the view axis, in metres."),
       3, [](Row row) { return row.depth_m; }},
      {tr("Distinctness"),
       tr("Number of edge pixels that constrain the template in its weakest direction; 0: it "
          "slides along a straight edge."),
       1, [](Row row) { return row.distinctness; }},
      {tr("dx, px"), tr("From the predicted to the found position, in pixels of the full image."),
       2, [](Row row) { return row.moved_px().x(); }},
      {tr("dy, px"), tr("From the predicted to the found position, in pixels of the full image."),
       2, [](Row row) { return row.moved_px().y(); }},
      {tr("Score S"),
       tr("Weighted Hamming similarity at the found position, S+/c+ plus S-/c-; 2 is perfect."), 3,
       [](Row row) { return row.score; }},
      {tr("S+/c+"), tr("Share of the template's edge pixels that meet an edge of the image."), 3,
       [](Row row) { return row.edge_share; }},
      {tr("S-/c-"), tr("Share of the template's empty pixels inside its mask that meet no edge."),
       3, [](Row row) { return row.empty_share; }},
      {tr("Margin, %"),
       tr("Margin of the best score over the second peak, in per cent of the best; a small margin "
          "may be a wrong position."),
       1, [](Row row) { return 100.0 * row.margin; }},
      {tr("Residual, px"),
       tr("Distance of the found position from the point's projection in the solved pose, in "
          "pixels of the full image."),
       2, [](Row row) { return row.residual_px; }},
      {tr("Verdict"), tr("Whether the match agrees with the solved pose within the threshold."), -1,
       [](Row row) { return TemplatesModel::verdictOf(row); },
       [](Row row) {
         return row.inlier ? 0 : row.solved ? 1 : row.searched ? 2 : 3;
       }},
      {tr("Border"),
       tr("The peak lies on the border of the search window: the true position may lie outside; "
          "the stated uncertainty may be too small."),
       -1, [](Row row) { return row.at_border ? TemplatesModel::tr("at border") : QString(); },
       [](Row row) { return row.at_border ? 0 : 1; }},
  };
}

QString pairText(const Eigen::Vector2d& pixel, int decimals) {
  return QStringLiteral("%1, %2").arg(numberText(pixel.x(), decimals),
                                      numberText(pixel.y(), decimals));
}

/// The score next to that of the second peak.
QString scoreText(const MatchDetails& details) {
  const QString score = numberText(details.score, 3);
  if (std::isnan(details.margin)) return MatchView::tr("%1, no second peak").arg(score);
  const QString text =
      MatchView::tr("%1, second peak %2, margin %3 %")
          .arg(score, numberText(details.second_score, 3), numberText(100.0 * details.margin, 1));
  return details.hasLowMargin() ? text + MatchView::tr(" (low)") : text;
}

}  // namespace

TemplatesModel::TemplatesModel() : RowsModel(templateColumns()) {}

void TemplatesModel::setIteration(const sessions::IterationTrace* iteration) {
  reached_match_ = iteration && iteration->reached >= Stage::kMatch;
  setRows(iteration ? sessions::matchDetails(*iteration) : std::vector<MatchDetails>(), false);
}

QString TemplatesModel::verdictOf(const MatchDetails& details) {
  if (details.inlier) return tr("inlier");
  if (details.solved) return tr("outlier");
  return details.searched ? tr("found") : tr("not searched");
}

QVariant TemplatesModel::look(const MatchDetails& /*row*/, int column, int role) const {
  const bool unknown = column == kVerdict && role == Qt::DisplayRole && !reached_match_;
  return unknown ? QString() : QVariant();
}

QStringList TemplatesModel::showNames() {
  return {tr("All"),
          tr("Inliers"),
          tr("Outliers"),
          tr("Low margin (under %1 %)").arg(100.0 * sessions::kLowMargin),
          tr("At the window's border"),
          tr("Not searched")};
}

bool TemplatesModel::isShown(int row, Show show) const {
  const MatchDetails& details = at(row);
  const std::array<bool, 6> holds = {true,
                                     details.inlier,
                                     details.solved && !details.inlier,
                                     details.hasLowMargin(),
                                     details.at_border,
                                     !details.searched};
  return holds[static_cast<std::size_t>(show)];
}

MatchView::MatchView(QWidget* parent) : QWidget(parent) { ui_.setupUi(this); }

void MatchView::showNote(const QString& note) {
  runner_.cancel(scoring_);
  for (PixelPicture* picture : {ui_.templatePicture, ui_.foundPicture, ui_.agreementPicture})
    picture->setPicture({}, {});
  ui_.places->clear();
  ui_.scores->clear();
  ui_.map->setNote(note);
}

void MatchView::showMatch(std::shared_ptr<const sessions::EdgeMapTrace> edges,
                          std::shared_ptr<const sessions::IterationTrace> iteration,
                          int template_index) {
  runner_.cancel(scoring_);
  const auto index = static_cast<std::size_t>(template_index);
  const bool searched = index < iteration->matches.size() && iteration->matches[index].searched;
  const Match* match = searched ? &iteration->matches[index] : nullptr;
  showPictures(*edges, *iteration, index, match);
  showFigures(*iteration, sessions::matchDetails(*iteration)[index]);
  if (!searched) {
    ui_.map->setNote(
        iteration->reached < Stage::kMatch
            ? tr("The templates have not been searched yet.")
            : tr("This template was not searched: no part of its window lies far enough "
                 "inside the image."));
    return;
  }
  ui_.map->setNote(tr("Computing the score map ..."));
  const Template& item = iteration->templates[index];
  const ScoreMapView::Marks marks = {item.center_x, item.center_y, match->peak};
  runner_.replace(
      scoring_,
      [edges, iteration, template_index](const std::stop_token& stop) {
        return sessions::scoreMap(*edges, *iteration, template_index, stop);
      },
      [this, marks](std::optional<sessions::ScoreMap> map) {
        if (map)
          ui_.map->setMap(std::make_shared<const sessions::ScoreMap>(std::move(*map)), marks);
        else
          ui_.map->setNote(tr("The run's record has no data for the score map."));
      },
      [this](const QString& message) { ui_.map->setNote(message); });
}

void MatchView::showPictures(const sessions::EdgeMapTrace& edges,
                             const sessions::IterationTrace& iteration, std::size_t index,
                             const Match* match) {
  const Template& item = iteration.templates[index];
  const PatchPlace place{item.center_x, item.center_y, iteration.template_side_px};
  const BitImage rendered = iteration.render.edges.view();
  const BitImage mask = iteration.render.mask.view();
  ui_.templatePicture->setPicture(
      templatePicture(rendered, mask, place),
      tr("%1 x %1 px, level %2").arg(iteration.template_side_px).arg(iteration.level));
  if (match == nullptr) {
    for (PixelPicture* picture : {ui_.foundPicture, ui_.agreementPicture})
      picture->setPicture({}, tr("not searched"));
    return;
  }
  const BitImage seen = edges.level[static_cast<std::size_t>(iteration.level)].view();
  const PatchPlace there{match->peak.x, match->peak.y, iteration.template_side_px};
  ui_.foundPicture->setPicture(seenPicture(seen, there), tr("edges of the image"));
  ui_.agreementPicture->setPicture(agreementPicture(rendered, mask, place, seen, there),
                                   colorText(patch_colors::kEdge, tr("both")) +
                                       colorText(patch_colors::kOnlyRendered, tr("render")) +
                                       colorText(patch_colors::kOnlySeen, tr("image")));
}

void MatchView::showFigures(const sessions::IterationTrace& iteration,
                            const MatchDetails& details) {
  const Eigen::Vector3d point_mm = 1e3 * details.point_in_station_m;
  const QString border = details.at_border ? tr(", at the window's border") : QString();
  QVector<QStringList> places = {
      {tr("Template %1").arg(details.index + 1), TemplatesModel::verdictOf(details) + border},
      {tr("Point (station frame)"),
       tr("%1, %2, %3 mm; depth %4 m")
           .arg(numberText(point_mm.x(), 2), numberText(point_mm.y(), 2),
                numberText(point_mm.z(), 2), numberText(details.depth_m, 3))},
      {tr("Predicted at"), tr("%1 px").arg(pairText(details.predicted_px, 1))}};
  QVector<QStringList> scores;
  if (details.searched) {
    const Match& match = iteration.matches[static_cast<std::size_t>(details.index)];
    const auto count = [&iteration](int part, int whole, double share) {
      if (!iteration.recorded_scores.empty()) return tr("not in the onboard record");
      return tr("%1 = %2 of %3 px").arg(numberText(share, 3)).arg(part).arg(whole);
    };
    places.append(
        {tr("Found at"), tr("%1 px, moved by %2 px")
                             .arg(pairText(details.found_px, 2), pairText(details.moved_px(), 2))});
    scores = {{tr("Score S"), scoreText(details)},
              {tr("S+/c+, edges"),
               count(match.peak.counts.edge_hits, match.norms.edges, details.edge_share)},
              {tr("S-/c-, empty"),
               count(match.peak.counts.empty_hits, match.norms.empties, details.empty_share)}};
  }
  if (details.solved)
    scores.append({tr("Residual"), tr("%1 px, threshold %2 px")
                                       .arg(numberText(details.residual_px, 2),
                                            numberText(iteration.threshold_px, 2))});
  ui_.places->setText(htmlTable(places));
  ui_.scores->setText(htmlTable(scores));
}

}  // namespace boresight::ui
