// SPDX-License-Identifier: Apache-2.0
#include "sessions/trace/match_details.h"

#include <algorithm>
#include <cstddef>

#include "core/accept/edge_support.h"

namespace boresight::sessions {
namespace {

MatchDetails describeTemplate(const Template& item, std::int32_t index, int level) {
  return {.index = index,
          .depth_m = static_cast<double>(item.depth_m),
          .distinctness = static_cast<double>(item.distinctness),
          .point_in_station_m = item.point_in_station_m,
          .predicted_px = atFullResolution({item.center_x, item.center_y}, level)};
}

void describeMatch(const Match& match, int level, MatchDetails& details) {
  details.searched = match.searched;
  if (!match.searched) return;
  details.at_border = match.at_border;
  details.found_px = atFullResolution({match.x, match.y}, level);
  details.edge_share = shareOf(match.peak.counts.edge_hits, match.norms.edges);
  details.empty_share = shareOf(match.peak.counts.empty_hits, match.norms.empties);
  details.score = whsScore(match.peak.counts, match.norms);
  if (!match.peak.has_second) return;
  details.second_score = whsScore(match.peak.second_counts, match.norms);
  const std::int64_t best = whsComparable(match.peak.counts, match.norms);
  const std::int64_t second = whsComparable(match.peak.second_counts, match.norms);
  details.margin = best > 0 ? static_cast<double>(best - second) / static_cast<double>(best) : 0.0;
}

/// An onboard record has scores without what they are made of.
void describeScore(const RecordedScore& recorded, MatchDetails& details) {
  details.edge_share = details.empty_share = details.second_score = details.margin = kUnknown;
  details.score = recorded.score;
  if (!recorded.second_score) return;
  details.second_score = *recorded.second_score;
  details.margin =
      details.score > 0.0 ? (details.score - details.second_score) / details.score : 0.0;
}

}  // namespace

std::vector<MatchDetails> matchDetails(const IterationTrace& iteration) {
  std::vector<MatchDetails> all;
  all.reserve(iteration.templates.size());
  for (std::size_t i = 0; i < iteration.templates.size(); ++i) {
    all.push_back(
        describeTemplate(iteration.templates[i], static_cast<std::int32_t>(i), iteration.level));
    if (i < iteration.matches.size())
      describeMatch(iteration.matches[i], iteration.level, all.back());
    if (all.back().searched && i < iteration.recorded_scores.size())
      describeScore(iteration.recorded_scores[i], all.back());
  }
  if (iteration.reached < Stage::kPose) return all;
  const std::size_t solved = std::min({iteration.template_of.size(), iteration.pnp.inlier.size(),
                                       iteration.pnp.residual_px.size()});
  for (std::size_t i = 0; i < solved; ++i) {
    const auto index = static_cast<std::size_t>(iteration.template_of[i]);
    if (index >= all.size()) continue;
    all[index].solved = true;
    all[index].inlier = iteration.pnp.inlier[i] != 0;
    all[index].residual_px = iteration.pnp.residual_px[i];
  }
  return all;
}

}  // namespace boresight::sessions
