// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <cstdint>
#include <optional>

#include "core/geometry/camera.h"
#include "core/geometry/pose.h"
#include "core/refine/edge_refinement.h"

namespace boresight {

/// Places along the rendered edges of a refined pose in one view: how far another pose moves these
/// edges along their normals. A motion along the edges, such as the turn of a can about its axis,
/// shows in nothing else.
class EdgePlaces {
 public:
  static constexpr int kMost = 128;   ///< places kept, scattered over the samples
  static constexpr int kLeast = 20;   ///< fewer places measure nothing
  static constexpr double kOf = 0.8;  ///< share of the places that moves by at most the motion

  EdgePlaces() = default;  ///< without places
  /// The samples of a refinement. `camera` is the image's; `camera_from_first` leads from the
  /// camera that poses refer to.
  EdgePlaces(const RefinementResult& refined, const Camera& camera,
             const Pose& camera_from_first = Pose());

  /// Motion of the places along their normals to another pose.
  struct Motion {
    double quantile_px = 0.0;  ///< of 80 % of the places at most
    double rms_px = 0.0;       ///< a few places that move far show a turn as well
  };
  /// None when there are too few places. A place that the other pose does not show has moved
  /// without bound.
  std::optional<Motion> motionTo(const Pose& camera_from_station) const;

 private:
  struct Place {
    Eigen::Vector3f point_in_station_m;
    Eigen::Vector2f pixel;   ///< at the refined pose
    Eigen::Vector2f normal;  ///< in the image
  };
  std::array<Place, kMost> places_;
  int count_ = 0;
  Camera camera_;
  Pose camera_from_first_;
};

}  // namespace boresight
