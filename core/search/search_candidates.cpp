// SPDX-License-Identifier: Apache-2.0
#include "core/search/search_candidates.h"

#include <algorithm>

namespace boresight {

/// How far the outline's places are apart, roughly.
bool CandidateList::same(const SearchCandidate& one, const SearchCandidate& other) const {
  const Eigen::Quaterniond between =
      one.camera_from_station.rotation * other.camera_from_station.rotation.conjugate();
  // Of a rotation by twice this length; beyond a right angle it is merely large.
  const double roll = 2.0 * between.vec().dot(axis_);
  const double turn2 = 4.0 * between.vec().squaredNorm();
  // A tilt moves the outline by less than a turn does.
  const double tilt2 = 0.25 * std::max(turn2 - roll * roll, 0.0);
  const double slide_x = one.slide_x_px - other.slide_x_px;
  const double slide_y = one.slide_y_px - other.slide_y_px;
  const double turned2 = radius_px_ * radius_px_ * (roll * roll + tilt2);
  const double scaled = radius_px_ * (one.depth_ratio - other.depth_ratio) / one.depth_ratio;
  return slide_x * slide_x + slide_y * slide_y + turned2 + scaled * scaled < apart_px_ * apart_px_;
}

void CandidateList::insert(const SearchCandidate& candidate) {
  int kept = 0;
  for (int i = 0; i < count_; ++i) {
    const SearchCandidate& other = candidates_[static_cast<std::size_t>(i)];
    const bool near = same(candidate, other);
    if (near && other.distance_px <= candidate.distance_px) return;
    if (!near) candidates_[static_cast<std::size_t>(kept++)] = other;
  }
  count_ = kept;
  int place = count_;
  while (place > 0 &&
         candidates_[static_cast<std::size_t>(place - 1)].distance_px > candidate.distance_px)
    --place;
  if (place >= kCapacity) return;
  count_ = std::min(count_ + 1, kCapacity);
  for (int i = count_ - 1; i > place; --i)
    candidates_[static_cast<std::size_t>(i)] = candidates_[static_cast<std::size_t>(i - 1)];
  candidates_[static_cast<std::size_t>(place)] = candidate;
}

}  // namespace boresight
