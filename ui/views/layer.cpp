// SPDX-License-Identifier: Apache-2.0
#include "ui/views/layer.h"

#include <array>
#include <utility>

#include "sessions/trace/match_details.h"
#include "sessions/trace/scene_render.h"
#include "ui/views/view_transform.h"

namespace boresight::ui {
namespace {

/// What a layer looks like at first.
LayerStyle shown(const QColor& color, double opacity) { return {true, color, opacity}; }
LayerStyle hidden(const QColor& color, double opacity) { return {false, color, opacity}; }

QColor colorOf(const LineToken& line) { return QColor(line.color); }

constexpr LineToken kNudgedLine = {0xE69F00, 2.2, 0, 0, true};
constexpr LineToken kHypothesisLine = {0xF0E442, 1.7, 4, 3, false};
constexpr LineToken kAnnotatedLine = {0xB278FF, 1.5, 0, 0, true};

/// Poses differ in pattern too: colour must not be the only difference.
const std::array<LayerInfo, kLayerCount>& infos() {
  static const std::array<LayerInfo, kLayerCount> layer_infos = {{
      {LayerId::kIgnoreMask, "Ignore mask", "G", "Ignored pixels",
       shown(QColor(200, 60, 200), 0.35)},
      {LayerId::kTestEdges, "Image edges", "E",
       "Canny edges of the image, as used by the algorithm", hidden(QColor(255, 255, 255), 0.8)},
      {LayerId::kMask, "Rendered mask", "K", "Pixels of the rendered station",
       hidden(QColor(90, 200, 255), 0.25)},
      {LayerId::kAgreement, "Agreement", "A",
       "Edges in both, only in the render, only in the image", hidden(QColor(255, 220, 60), 0.9)},
      {LayerId::kSeedEdges, "Seed", "S", "Salient edges rendered from the seed",
       shown(colorOf(kSeedLine), 1.0), kSeedLine},
      {LayerId::kIterationEdges, "Pose", "I",
       "Salient edges of the shown iteration: before its correction, from the stage Pose on after "
       "it",
       shown(colorOf(kPoseLine), 1.0), kPoseLine},
      {LayerId::kTruthEdges, "Truth", "T", "Salient edges rendered from the true pose",
       hidden(colorOf(kTruthLine), 1.0), kTruthLine},
      {LayerId::kNudgedEdges, "Nudged pose", "Shift+N", "Salient edges of the pose being nudged",
       shown(colorOf(kNudgedLine), 1.0), kNudgedLine},
      {LayerId::kAnnotationBand, "Annotation's band", "U",
       "Region of the salient edges for 95 % of the poses within the annotations' covariance",
       hidden(kAnnotatedColor, 0.6)},
      {LayerId::kAnnotationEdges, "Annotated pose", "O",
       "Salient edges rendered from the annotated pose; while shown, Ctrl+click picks the station "
       "on them",
       shown(kAnnotatedColor, 0.8), kAnnotatedLine},
      {LayerId::kChosenEdges, "Chosen pose", "F",
       "Salient edges of the chosen pose, while another hypothesis is shown",
       shown(colorOf(kPoseLine), 1.0), kPoseLine},
      {LayerId::kHypothesisEdges, "Hypothesis", "J",
       "Salient edges of the hypothesis selected under Hypotheses",
       shown(colorOf(kHypothesisLine), 1.0), kHypothesisLine},
      {LayerId::kWindows, "Chosen template", "W", "The chosen template and its search window",
       shown(colorOf(kTemplateLine), 1.0), kTemplateLine},
      {LayerId::kTemplates, "Templates", "P", "Positions of the templates in the render",
       hidden(QColor(255, 235, 120), 0.9)},
      {LayerId::kMatches, "Matches", "M",
       "From predicted to found position of a template; outliers are dashed",
       shown(colorOf(kInlierLine), 1.0), kInlierLine},
      {LayerId::kResiduals, "Residuals", "R",
       "Residual of each match in the solved pose, magnified", hidden(QColor(255, 120, 200), 0.9)},
      {LayerId::kAnnotationResiduals, "Annotations' residuals", "X",
       "From projected to annotated position, magnified; dashed while the pose is out of date",
       shown(QColor(255, 120, 200), 0.9)},
      {LayerId::kProposals, "Proposed annotations", "Y", "Projected landmarks; a click accepts one",
       shown(QColor(140, 230, 255), 0.9)},
      {LayerId::kPoints, "Annotations", "D", "Points and lines annotated by hand",
       shown(colorOf(kMarkLine), 1.0), kMarkLine},
  }};
  return layer_infos;
}

}  // namespace

const LayerInfo& layerInfo(LayerId id) { return infos()[static_cast<std::size_t>(id)]; }

LinesPtr linesOf(const sessions::RenderTrace& render, int level) {
  return std::make_shared<const sessions::EdgeLines>(sessions::edgeLines(render, level));
}

LinesPtr linesOf(const sessions::LoadedCase& loaded_case, const Pose& camera_from_station) {
  sessions::RenderTrace render;
  const Status status = sessions::renderScene(loaded_case.source.camera, loaded_case.scene.view(),
                                              camera_from_station, render);
  return status == Status::kOk ? linesOf(render, 0) : nullptr;
}

LineToken Layer::shownLine() const {
  if (line) return *line;
  LineToken own = layerInfo(id).line;
  own.color = style.color.rgb();
  return own;
}

namespace {

LayerBits layerBits(std::shared_ptr<const void> owner, const BitImage& bits, int level) {
  return {std::move(owner), bits, level, {}};
}

/// An area of a pyramid level on the full image.
QRectF areaOf(double left, double top, double right, double bottom, int level) {
  return {pointOf(atFullResolution({left, top}, level)),
          pointOf(atFullResolution({right, bottom}, level))};
}

QRectF templateArea(const sessions::IterationTrace& iteration, std::size_t index) {
  // A template of even side spans centre - side/2 ... centre + side/2 - 1.
  const double half = 0.5 * iteration.template_side_px;
  const double x = iteration.templates[index].center_x - 0.5;
  const double y = iteration.templates[index].center_y - 0.5;
  return areaOf(x - half, y - half, x + half, y + half, iteration.level);
}

Mark rectangle(const QRectF& area, int item) {
  Mark mark;
  mark.shape = MarkShape::kRectangle;
  mark.area = area;
  mark.item = item;
  return mark;
}

Mark rectangle(const QRectF& area, const LineToken& line) {
  Mark mark = rectangle(area, -1);
  mark.line = line;
  return mark;
}

Mark arrow(const Eigen::Vector2d& from, const Eigen::Vector2d& to, int item, bool inlier) {
  Mark mark;
  mark.shape = MarkShape::kArrow;
  mark.at = pointOf(from);
  mark.to = pointOf(to);
  mark.item = item;
  mark.line = inlier ? kInlierLine : kOutlierLine;
  mark.dashed = !inlier;
  if (!inlier) mark.color = colorOf(kOutlierLine);
  return mark;
}

}  // namespace

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

std::vector<LayerBits> maskBits(const std::shared_ptr<const sessions::IterationTrace>& iteration) {
  if (!iteration || iteration->render.mask.words.empty()) return {};
  return {layerBits(iteration, iteration->render.mask.view(), iteration->level)};
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

std::vector<Mark> chosenMarks(const sessions::IterationTrace& iteration, int selected_template,
                              bool searched) {
  const auto index = static_cast<std::size_t>(selected_template);
  if (selected_template < 0 || index >= iteration.templates.size()) return {};
  std::vector<Mark> marks = {rectangle(templateArea(iteration, index), kTemplateLine)};
  if (!searched || index >= iteration.matches.size()) return marks;
  const SearchWindow& window = iteration.matches[index].window;
  if (window.empty()) return marks;
  marks.push_back(rectangle(areaOf(window.x_min - 0.5, window.y_min - 0.5, window.x_max + 0.5,
                                   window.y_max + 0.5, iteration.level),
                            kWindowLine));
  return marks;
}

std::vector<Mark> templateMarks(const sessions::IterationTrace& iteration, int selected_template) {
  std::vector<Mark> marks;
  for (std::size_t i = 0; i < iteration.templates.size(); ++i) {
    Mark& mark = marks.emplace_back(rectangle(templateArea(iteration, i), static_cast<int>(i)));
    if (mark.item == selected_template) mark.color = colorOf(kTemplateLine);
  }
  return marks;
}

std::vector<Mark> matchMarks(const sessions::IterationTrace& iteration, int selected_template) {
  std::vector<Mark> marks;
  for (const sessions::MatchDetails& match : sessions::matchDetails(iteration)) {
    if (!match.searched) continue;
    Mark& mark =
        marks.emplace_back(arrow(match.predicted_px, match.found_px, match.index, match.inlier));
    if (mark.item == selected_template) mark.label = QString::number(mark.item);
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
