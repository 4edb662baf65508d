// SPDX-License-Identifier: Apache-2.0
#include "ui/models/templates_model.h"

namespace boresight::ui {

using sessions::MatchDetails;

namespace {

std::vector<TableColumn<MatchDetails>> templateColumns() {
  using Row = const MatchDetails&;
  constexpr auto tr = [](const char* text) { return TemplatesModel::tr(text); };
  return {
      {tr("Template"), tr("Number of the template, from 1."), 0,
       [](Row one) { return one.index + 1; }},
      {tr("x, px"),
       tr("Predicted place of its centre, pixels of the full image to the right of the centre of "
          "the top-left pixel."),
       1, [](Row one) { return one.predicted_px.x(); }},
      {tr("y, px"),
       tr("Predicted place of its centre, pixels of the full image below the centre of the "
          "top-left pixel."),
       1, [](Row one) { return one.predicted_px.y(); }},
      {tr("Depth, m"), tr("Distance of its point from the camera along the view axis, in metres."),
       3, [](Row one) { return one.depth_m; }},
      {tr("Distinctness"),
       tr("How many edge pixels hold the template in its weakest direction; 0 slides along a "
          "straight edge."),
       1, [](Row one) { return one.distinctness; }},
      {tr("dx, px"), tr("From the predicted to the found place, in pixels of the full image."), 2,
       [](Row one) { return one.moved_px().x(); }},
      {tr("dy, px"), tr("From the predicted to the found place, in pixels of the full image."), 2,
       [](Row one) { return one.moved_px().y(); }},
      {tr("Score S"),
       tr("Weighted Hamming similarity at the found place, S+/c+ plus S-/c-; 2 is perfect."), 3,
       [](Row one) { return one.score; }},
      {tr("S+/c+"), tr("Share of the template's edge pixels that meet an edge of the image."), 3,
       [](Row one) { return one.edge_share; }},
      {tr("S-/c-"), tr("Share of the template's empty pixels inside its mask that meet none."), 3,
       [](Row one) { return one.empty_share; }},
      {tr("Margin, %"),
       tr("By how much the best score exceeds the second peak's, in per cent of the best; a low "
          "one may be the wrong place."),
       1, [](Row one) { return 100.0 * one.margin; }},
      {tr("Residual, px"),
       tr("Distance of the found place from where the solved pose puts the point, in pixels of the "
          "full image."),
       2, [](Row one) { return one.residual_px; }},
      {tr("Verdict"), tr("Whether the match agrees with the solved pose within the threshold."), -1,
       [](Row one) { return TemplatesModel::verdictOf(one); },
       [](Row one) {
         return one.inlier ? 0 : one.solved ? 1 : one.searched ? 2 : 3;
       }},
      {tr("Border"),
       tr("The peak lies on the border of the search window: the true place may lie beyond, and "
          "the seed's uncertainty may be stated too small."),
       -1, [](Row one) { return one.at_border ? TemplatesModel::tr("at border") : QString(); },
       [](Row one) { return one.at_border ? 0 : 1; }},
  };
}

}  // namespace

TemplatesModel::TemplatesModel(QObject* parent) : RowsModel(templateColumns(), parent) {}

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
  const MatchDetails& one = at(row);
  switch (show) {
    case Show::kAll:
      return true;
    case Show::kInliers:
      return one.inlier;
    case Show::kOutliers:
      return one.solved && !one.inlier;
    case Show::kLowMargin:
      return one.hasLowMargin();
    case Show::kAtBorder:
      return one.at_border;
    case Show::kNotSearched:
      return !one.searched;
  }
  return true;
}

}  // namespace boresight::ui
