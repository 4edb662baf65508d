// SPDX-License-Identifier: Apache-2.0
#include "sessions/run/pose_follower.h"

#include <algorithm>

namespace boresight::sessions {
namespace {

/// Doublings after which any motion exceeds any uncertainty.
constexpr int kMostDoublings = 30;

bool exceeds(const DeclaredUncertainty& one, const DeclaredUncertainty& other) {
  return (one.translation_m.array() > other.translation_m.array()).any() ||
         (one.rotation_deg.array() > other.rotation_deg.array()).any();
}

}  // namespace

DeclaredUncertainty PoseFollower::uncertainty() const {
  if (!found_) return first_;
  if (lost_ == 0) return motion_;
  DeclaredUncertainty grown = motion_;
  const double factor = static_cast<double>(1 << std::min(lost_, kMostDoublings));
  grown.translation_m *= factor;
  grown.rotation_deg *= factor;
  return exceeds(grown, first_) ? first_ : grown;
}

void PoseFollower::take(const std::optional<Pose>& camera_from_station) {
  if (camera_from_station) {
    camera_from_station_ = *camera_from_station;
    found_ = true;
    lost_ = 0;
  } else {
    ++lost_;
  }
}

}  // namespace boresight::sessions
