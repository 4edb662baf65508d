// SPDX-License-Identifier: Apache-2.0
#include "sessions/trace/score_map.h"

#include <algorithm>
#include <cstddef>
#include <span>

namespace boresight::sessions {
namespace {

/// The match, if this template was searched and everything to search it again is there.
const Match* searchedMatch(const EdgeMapTrace& edges, const IterationTrace& iteration, int index) {
  const bool exists = index >= 0 && static_cast<std::size_t>(index) < iteration.matches.size() &&
                      static_cast<std::size_t>(index) < iteration.templates.size();
  const bool has_level = iteration.level >= 0 &&
                         static_cast<std::size_t>(iteration.level) < edges.level.size() &&
                         !edges.level[static_cast<std::size_t>(iteration.level)].words.empty();
  if (!exists || !has_level || iteration.render.edges.words.empty()) return nullptr;
  const Match& match = iteration.matches[static_cast<std::size_t>(index)];
  return match.searched && !match.window.empty() ? &match : nullptr;
}

void measureRange(ScoreMap& map) {
  const auto score = [&map](const WhsCounts& counts) { return whsScore(counts, map.norms); };
  map.lowest = map.highest = score(map.counts.front());
  for (const WhsCounts& counts : map.counts) {
    map.lowest = std::min(map.lowest, score(counts));
    map.highest = std::max(map.highest, score(counts));
  }
}

}  // namespace

const WhsCounts& ScoreMap::countsAt(int x, int y) const {
  return counts[static_cast<std::size_t>(y - window.y_min) *
                    static_cast<std::size_t>(window.width()) +
                static_cast<std::size_t>(x - window.x_min)];
}

std::optional<ScoreMap> scoreMap(const EdgeMapTrace& edges, const IterationTrace& iteration,
                                 int template_index, const std::stop_token& stop) {
  const Match* match = searchedMatch(edges, iteration, template_index);
  if (match == nullptr) return std::nullopt;
  const Template& item = iteration.templates[static_cast<std::size_t>(template_index)];
  const BitImage edges_of_render = iteration.render.edges.view();
  const BitImage mask = iteration.render.mask.view();
  const TemplateView view{&edges_of_render, &mask, item.center_x, item.center_y,
                          iteration.template_side_px};
  const BitImage test_edges = edges.level[static_cast<std::size_t>(iteration.level)].view();
  ScoreMap map;
  map.window = match->window;
  map.level = iteration.level;
  map.norms = match->norms;
  const auto width = static_cast<std::size_t>(map.window.width());
  map.counts.resize(width * static_cast<std::size_t>(map.window.height()));
  SearchWindow row = map.window;
  for (int y = map.window.y_min; y <= map.window.y_max; ++y) {
    if (stop.stop_requested()) return std::nullopt;
    row.y_min = row.y_max = y;
    const std::size_t begin = static_cast<std::size_t>(y - map.window.y_min) * width;
    whsScoreMap(view, test_edges, row, std::span(map.counts).subspan(begin, width));
  }
  measureRange(map);
  return map;
}

}  // namespace boresight::sessions
