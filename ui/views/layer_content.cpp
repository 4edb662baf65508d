// SPDX-License-Identifier: Apache-2.0
#include "ui/views/layer_content.h"

#include <utility>

#include "sessions/run/match_details.h"

namespace boresight::ui {
namespace {

const QColor kSelected(255, 255, 255);
const QColor kOutlier(255, 150, 60);

QPointF point(const Eigen::Vector2d& pixel) { return {pixel.x(), pixel.y()}; }

LayerBits layerBits(std::shared_ptr<const void> owner, const BitImage& bits, int level) {
  LayerBits made;
  made.owner = std::move(owner);
  made.bits = bits;
  made.level = level;
  return made;
}

QRectF windowArea(const SearchWindow& window, int level) {
  const Eigen::Vector2d first =
      sessions::fullImagePixel(window.x_min - 0.5, window.y_min - 0.5, level);
  const Eigen::Vector2d last =
      sessions::fullImagePixel(window.x_max + 0.5, window.y_max + 0.5, level);
  return {point(first), point(last)};
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

std::vector<LayerBits> ignoreBits(const std::shared_ptr<const sessions::LoadedCase>& one) {
  if (!one || !one->ignore) return {};
  return {layerBits(one, one->ignore_bits, 0)};
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
  std::vector<LayerBits> made = {layerBits(maps, maps->only_image.view(), level),
                                 layerBits(maps, maps->only_rendered.view(), level),
                                 layerBits(maps, maps->both.view(), level)};
  made[0].color = QColor(90, 160, 255);
  made[1].color = QColor(255, 110, 80);
  return made;
}

std::vector<Mark> windowMarks(const sessions::IterationTrace& iteration, int selected_template) {
  std::vector<Mark> marks;
  for (std::size_t i = 0; i < iteration.matches.size(); ++i) {
    const SearchWindow& window = iteration.matches[i].window;
    if (window.empty()) continue;
    Mark mark;
    mark.shape = MarkShape::kRectangle;
    mark.area = windowArea(window, iteration.level);
    mark.item = static_cast<int>(i);
    if (mark.item == selected_template) mark.color = kSelected;
    marks.push_back(std::move(mark));
  }
  return marks;
}

std::vector<Mark> templateMarks(const sessions::IterationTrace& iteration, int selected_template) {
  std::vector<Mark> marks;
  const double half = 0.5 * iteration.template_side_px;
  for (std::size_t i = 0; i < iteration.templates.size(); ++i) {
    const Template& one = iteration.templates[i];
    Mark mark;
    mark.shape = MarkShape::kRectangle;
    // A template of even side spans centre - side/2 ... centre + side/2 - 1.
    mark.area = QRectF(point(sessions::fullImagePixel(one.center_x - half - 0.5,
                                                      one.center_y - half - 0.5, iteration.level)),
                       point(sessions::fullImagePixel(one.center_x + half - 0.5,
                                                      one.center_y + half - 0.5, iteration.level)));
    mark.item = static_cast<int>(i);
    if (mark.item == selected_template) mark.color = kSelected;
    marks.push_back(std::move(mark));
  }
  return marks;
}

std::vector<Mark> matchMarks(const sessions::IterationTrace& iteration, int selected_template) {
  std::vector<Mark> marks;
  for (const sessions::MatchDetails& match : sessions::matchDetails(iteration)) {
    if (!match.searched) continue;
    Mark mark;
    mark.shape = MarkShape::kArrow;
    mark.at = point(match.predicted_px);
    mark.to = point(match.found_px);
    mark.item = match.index;
    mark.dashed = !match.inlier;
    if (!match.inlier) mark.color = kOutlier;
    if (mark.item == selected_template) {
      mark.color = kSelected;
      mark.label = QString::number(mark.item);
    }
    marks.push_back(std::move(mark));
  }
  return marks;
}

std::vector<Mark> residualMarks(const sessions::IterationTrace& iteration, const Camera& camera) {
  std::vector<Mark> marks;
  for (const sessions::ResidualVector& vector : sessions::residualVectors(iteration, camera)) {
    Mark mark;
    mark.shape = MarkShape::kArrow;
    mark.at = point(vector.projected);
    mark.to = point(vector.projected + kResidualMagnification * (vector.found - vector.projected));
    mark.item = vector.template_index;
    mark.dashed = !vector.inlier;
    if (!vector.inlier) mark.color = kOutlier;
    marks.push_back(std::move(mark));
  }
  return marks;
}

}  // namespace boresight::ui
