// SPDX-License-Identifier: Apache-2.0
#include "core/search/search_candidates.h"

#include <algorithm>

namespace boresight {

/// Approximate distance between the outlines of two candidates.
bool CandidateList::same(const SearchCandidate& first, const SearchCandidate& second) const {
  const Eigen::Quaterniond between =
      first.camera_from_station.rotation * second.camera_from_station.rotation.conjugate();
  // Of a rotation by twice this length; beyond a right angle it is merely large.
  const double roll = 2.0 * between.vec().dot(axis_);
  const double turn2 = 4.0 * between.vec().squaredNorm();
  // A tilt moves the outline by less than a turn does.
  const double tilt2 = 0.25 * std::max(turn2 - roll * roll, 0.0);
  const double slide_x = first.slide_x_px - second.slide_x_px;
  const double slide_y = first.slide_y_px - second.slide_y_px;
  const double turned2 = radius_px_ * radius_px_ * (roll * roll + tilt2);
  const double scaled = radius_px_ * (first.depth_ratio - second.depth_ratio) / first.depth_ratio;
  return slide_x * slide_x + slide_y * slide_y + turned2 + scaled * scaled < apart_px_ * apart_px_;
}

void CandidateList::insert(const SearchCandidate& candidate) {
  int kept = 0;
  for (int i = 0; i < candidates_.size(); ++i) {
    const bool near = same(candidate, candidates_[i]);
    if (near && candidates_[i].distance_px <= candidate.distance_px) return;
    if (!near) candidates_[kept++] = candidates_[i];
  }
  candidates_.keepFirst(kept);
  int place = kept;
  while (place > 0 && candidates_[place - 1].distance_px > candidate.distance_px) --place;
  candidates_.insert(place, candidate);
}

}  // namespace boresight
