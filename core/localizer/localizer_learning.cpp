// SPDX-License-Identifier: Apache-2.0
// What matches say about the templates that they are of.
#include "core/localizer/localizer.h"

namespace boresight {
namespace {

double marginOf(const Match& match) {
  if (!match.peak.has_second) return 2.0;
  return whsScore(match.peak.counts, match.norms) - whsScore(match.peak.second_counts, match.norms);
}

}  // namespace

/// Takes matches that could as well lie elsewhere out of the pose, unless too few would be left:
/// where nothing is distinct it is for RANSAC to tell what agrees.
void Localizer::dropIndistinct() {
  MatchSet& made = buffers_[static_cast<std::size_t>(current_)].matches;
  const auto matches = made.matches.first(static_cast<std::size_t>(made.count));
  std::int32_t left = 0;
  for (Match& match : matches) {
    match.dropped = match.searched && marginOf(match) < options_.templates.min_margin;
    if (match.searched && !match.dropped) ++left;
  }
  if (left >= 2 * options_.pnp.min_inliers && 4 * left >= made.searched) return;
  for (Match& match : matches) match.dropped = false;
}

/// Notes where templates were of no use: dropped, or against the pose of a majority.
void Localizer::learn() {
  const Iteration& now = buffers_[static_cast<std::size_t>(current_)];
  failed_count_ = 0;
  const auto note = [&](std::size_t index) {
    if (static_cast<std::size_t>(failed_count_) >= failed_in_station_m_.size()) return;
    failed_in_station_m_[static_cast<std::size_t>(failed_count_)] =
        now.templates.templates[index].point_in_station_m;
    ++failed_count_;
  };
  for (std::size_t i = 0; i < static_cast<std::size_t>(now.matches.count); ++i) {
    if (now.matches.matches[i].dropped) note(i);
  }
  if (2 * now.pnp.inlier_count < now.correspondence_count) return;
  for (std::size_t i = 0; i < static_cast<std::size_t>(now.correspondence_count); ++i) {
    if (now.pnp.inlier[i] == 0) note(static_cast<std::size_t>(now.template_of[i]));
  }
}

}  // namespace boresight
