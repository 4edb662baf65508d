// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <span>

#include "core/base/fixed_list.h"
#include "core/geometry/pose.h"

namespace boresight {

/// A pose of the whole-object search: the seed turned, moved in depth and slid across the view.
struct SearchCandidate {
  Pose camera_from_station;  ///< the pose
  double distance_px = 0.0;  ///< mean directed distance of its outline, px of the search's image
  double tilt_x_rad = 0.0;   ///< rotation vector of the tilt: about the view's x axis
  double tilt_y_rad = 0.0;   ///< the same about its y axis
  double roll_rad = 0.0;     ///< turn after the tilt, about the view's axis
  double depth_ratio = 1.0;  ///< of the depth, over the seed's
  double slide_x_px = 0.0;   ///< in the search's image
  double slide_y_px = 0.0;   ///< in the search's image
};

/// The best candidates so far that are mutually distinct, best first.
class CandidateList {
 public:
  static constexpr int kCapacity = 32;  ///< candidates that are kept

  CandidateList() = default;
  /// `radius_px`: half the object's size; `apart_px`: nearer candidates count as the same; px of
  /// the search. `axis`: the view's axis in the camera's frame.
  CandidateList(double radius_px, double apart_px, const Eigen::Vector3d& axis)
      : radius_px_(radius_px), apart_px_(apart_px), axis_(axis) {}

  /// Whether a candidate of that distance would be kept if it is apart from the others.
  bool accepts(double distance_px) const {
    return candidates_.size() < kCapacity || distance_px < candidates_[kCapacity - 1].distance_px;
  }
  /// Keeps a candidate unless a better one is near; worse ones near it are dropped.
  void insert(const SearchCandidate& candidate);
  /// The candidates, the best first.
  std::span<const SearchCandidate> candidates() const { return candidates_.items(); }

 private:
  bool same(const SearchCandidate& first, const SearchCandidate& second) const;

  double radius_px_ = 1.0;
  double apart_px_ = 1.0;
  Eigen::Vector3d axis_ = Eigen::Vector3d::UnitZ();
  FixedList<SearchCandidate, kCapacity> candidates_;
};

}  // namespace boresight
