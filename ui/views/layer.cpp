// SPDX-License-Identifier: Apache-2.0
#include "ui/views/layer.h"

#include <array>
#include <utility>

#include "sessions/run/match_details.h"
#include "ui/views/view_transform.h"

namespace boresight::ui {
namespace {

/// What a layer looks like at first.
LayerStyle shown(const QColor& color, double opacity) { return {true, color, opacity}; }
LayerStyle hidden(const QColor& color, double opacity) { return {false, color, opacity}; }

/// Colours that differ in lightness too, as red and green must not be the only difference.
const std::array<LayerInfo, kLayerCount>& infos() {
  static const std::array<LayerInfo, kLayerCount> layer_infos = {{
      {LayerId::kIgnoreMask, "Ignore mask", "G", "Ignored pixels",
       shown(QColor(200, 60, 200), 0.35)},
      {LayerId::kTestEdges, "Test edges", "E", "Canny edges of the image, as used by the algorithm",
       hidden(QColor(255, 255, 255), 0.8)},
      {LayerId::kMask, "Rendered mask", "K", "Pixels of the rendered station",
       hidden(QColor(90, 200, 255), 0.25)},
      {LayerId::kSeedEdges, "Seed edges", "S", "Salient edges rendered from the seed",
       shown(QColor(255, 70, 60), 0.9)},
      {LayerId::kTruthEdges, "Truth edges", "T", "Salient edges rendered from the true pose",
       hidden(QColor(70, 140, 255), 0.9)},
      {LayerId::kIterationEdges, "Iteration edges", "I",
       "Salient edges rendered by the shown iteration", shown(QColor(80, 235, 90), 0.9)},
      {LayerId::kAgreement, "Agreement", "A",
       "Edges in both, only in the render, only in the image", hidden(QColor(255, 220, 60), 0.9)},
      {LayerId::kNudgedEdges, "Nudged edges", "N", "Salient edges of the pose being nudged",
       shown(QColor(255, 160, 30), 1.0)},
      {LayerId::kAnnotationBand, "Annotation's band", "U",
       "Region of the salient edges for 95 % of the poses within the annotations' covariance",
       hidden(kAnnotatedColor, 0.6)},
      {LayerId::kAnnotationEdges, "Annotation's edges", "O",
       "Salient edges rendered from the annotated pose; while shown, Ctrl+click picks the station "
       "on them",
       shown(kAnnotatedColor, 0.6)},
      {LayerId::kChosenEdges, "Chosen pose's edges", "F",
       "Salient edges of the chosen pose, while another hypothesis is shown",
       shown(QColor(255, 250, 170), 0.9)},
      {LayerId::kHypothesisEdges, "Hypothesis' edges", "H",
       "Salient edges of the hypothesis selected under Hypotheses",
       shown(QColor(255, 60, 230), 0.9)},
      {LayerId::kWindows, "Search windows", "W", "Search window of each template",
       hidden(QColor(180, 180, 255), 0.6)},
      {LayerId::kTemplates, "Templates", "P", "Positions of the templates in the render",
       hidden(QColor(255, 235, 120), 0.9)},
      {LayerId::kMatches, "Matches", "M",
       "From predicted to found position of a template; outliers are dashed",
       shown(QColor(120, 255, 240), 0.9)},
      {LayerId::kResiduals, "Residuals", "R",
       "Residual of each match in the solved pose, magnified", hidden(QColor(255, 120, 200), 0.9)},
      {LayerId::kAnnotationResiduals, "Annotations' residuals", "X",
       "From projected to annotated position, magnified; dashed while the pose is out of date",
       shown(QColor(255, 120, 200), 0.9)},
      {LayerId::kProposals, "Proposed annotations", "Y", "Projected landmarks; a click accepts one",
       shown(QColor(140, 230, 255), 0.9)},
      {LayerId::kPoints, "Annotations", "D", "Points and lines annotated by hand",
       shown(QColor(255, 210, 0), 1.0)},
  }};
  return layer_infos;
}

}  // namespace

const LayerInfo& layerInfo(LayerId id) { return infos()[static_cast<std::size_t>(id)]; }

namespace {

const QColor kSelected(255, 255, 255);
const QColor kOutlier(255, 150, 60);

LayerBits layerBits(std::shared_ptr<const void> owner, const BitImage& bits, int level) {
  LayerBits result;
  result.owner = std::move(owner);
  result.bits = bits;
  result.level = level;
  return result;
}

QRectF windowArea(const SearchWindow& window, int level) {
  const Eigen::Vector2d first =
      sessions::fullImagePixel(window.x_min - 0.5, window.y_min - 0.5, level);
  const Eigen::Vector2d last =
      sessions::fullImagePixel(window.x_max + 0.5, window.y_max + 0.5, level);
  return {pointOf(first), pointOf(last)};
}

Mark rectangle(const QRectF& area, std::size_t index, int selected_template) {
  Mark mark;
  mark.shape = MarkShape::kRectangle;
  mark.area = area;
  mark.item = static_cast<int>(index);
  if (mark.item == selected_template) mark.color = kSelected;
  return mark;
}

Mark arrow(const Eigen::Vector2d& from, const Eigen::Vector2d& to, int item, bool inlier) {
  Mark mark;
  mark.shape = MarkShape::kArrow;
  mark.at = pointOf(from);
  mark.to = pointOf(to);
  mark.item = item;
  mark.dashed = !inlier;
  if (!inlier) mark.color = kOutlier;
  return mark;
}

}  // namespace

std::vector<LayerBits> bitsOf(const std::shared_ptr<const sessions::RenderTrace>& render,
                              bool mask) {
  if (!render) return {};
  return {layerBits(render, mask ? render->mask.view() : render->edges.view(), 0)};
}

std::vector<LayerBits> testEdgeBits(const std::shared_ptr<const sessions::EdgeMapTrace>& edges,
                                    int level) {
  if (!edges) return {};
  const sessions::BitMap& map = edges->level[static_cast<std::size_t>(level)];
  if (map.words.empty()) return {};
  return {layerBits(edges, map.view(), level)};
}

std::vector<LayerBits> ignoreBits(const std::shared_ptr<const sessions::LoadedCase>& loaded_case) {
  if (!loaded_case || !loaded_case->ignore) return {};
  return {layerBits(loaded_case, loaded_case->ignore_bits, 0)};
}

std::vector<LayerBits> iterationBits(
    const std::shared_ptr<const sessions::IterationTrace>& iteration, bool mask) {
  if (!iteration || iteration->render.edges.words.empty()) return {};
  return {layerBits(iteration,
                    mask ? iteration->render.mask.view() : iteration->render.edges.view(),
                    iteration->level)};
}

std::vector<LayerBits> agreementBits(const std::shared_ptr<const sessions::AgreementMaps>& maps,
                                     int level) {
  if (!maps || maps->both.words.empty()) return {};
  std::vector<LayerBits> bits = {layerBits(maps, maps->only_image.view(), level),
                                 layerBits(maps, maps->only_rendered.view(), level),
                                 layerBits(maps, maps->both.view(), level)};
  bits[0].color = QColor(90, 160, 255);
  bits[1].color = QColor(255, 110, 80);
  return bits;
}

std::vector<Mark> windowMarks(const sessions::IterationTrace& iteration, int selected_template) {
  std::vector<Mark> marks;
  for (std::size_t i = 0; i < iteration.matches.size(); ++i) {
    const SearchWindow& window = iteration.matches[i].window;
    if (!window.empty())
      marks.push_back(rectangle(windowArea(window, iteration.level), i, selected_template));
  }
  return marks;
}

std::vector<Mark> templateMarks(const sessions::IterationTrace& iteration, int selected_template) {
  std::vector<Mark> marks;
  const double half = 0.5 * iteration.template_side_px;
  for (std::size_t i = 0; i < iteration.templates.size(); ++i) {
    // A template of even side spans centre - side/2 ... centre + side/2 - 1.
    const double x = iteration.templates[i].center_x - 0.5;
    const double y = iteration.templates[i].center_y - 0.5;
    const QRectF area(pointOf(sessions::fullImagePixel(x - half, y - half, iteration.level)),
                      pointOf(sessions::fullImagePixel(x + half, y + half, iteration.level)));
    marks.push_back(rectangle(area, i, selected_template));
  }
  return marks;
}

std::vector<Mark> matchMarks(const sessions::IterationTrace& iteration, int selected_template) {
  std::vector<Mark> marks;
  for (const sessions::MatchDetails& match : sessions::matchDetails(iteration)) {
    if (!match.searched) continue;
    Mark& mark =
        marks.emplace_back(arrow(match.predicted_px, match.found_px, match.index, match.inlier));
    if (mark.item != selected_template) continue;
    mark.color = kSelected;
    mark.label = QString::number(mark.item);
  }
  return marks;
}

std::vector<Mark> residualMarks(const sessions::IterationTrace& iteration, const Camera& camera) {
  std::vector<Mark> marks;
  for (const sessions::ResidualVector& vector : sessions::residualVectors(iteration, camera))
    marks.push_back(
        arrow(vector.projected,
              vector.projected + kResidualMagnification * (vector.found - vector.projected),
              vector.template_index, vector.inlier));
  return marks;
}

}  // namespace boresight::ui
