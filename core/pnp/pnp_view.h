// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <cstdint>
#include <span>

#include "core/geometry/camera.h"
#include "core/geometry/pose.h"

namespace boresight {

inline constexpr int kMaxPnpViews = 8;

/// One of up to kMaxPnpViews cameras that are rigidly linked; the pose sought is that of the first
/// camera. The correspondences of all views form one list, view by view.
struct PnpView {
  const Camera* camera = nullptr;  ///< prepared; not owned
  Pose camera_from_first;          ///< not used in the first view
  std::int32_t end = 0;  ///< end of its correspondences, which begin at the previous view's end
};

/// The pose of one of the views, given the first view's pose; that of the first keeps its bits.
inline Pose poseOfView(std::span<const PnpView> views, std::size_t view,
                       const Pose& first_from_station) {
  return view == 0 ? first_from_station : views[view].camera_from_first * first_from_station;
}

/// The view that a correspondence belongs to.
inline std::size_t viewOf(std::span<const PnpView> views, std::size_t correspondence) {
  std::size_t view = 0;
  while (view + 1 < views.size() && correspondence >= static_cast<std::size_t>(views[view].end))
    ++view;
  return view;
}

}  // namespace boresight
