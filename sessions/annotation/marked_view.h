// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <span>
#include <string>
#include <vector>

#include "core/geometry/camera.h"
#include "core/geometry/pose.h"
#include "sessions/annotation/marks.h"

namespace boresight::sessions {

/// The marks of one camera of a rig. A camera alone is a rig of its own, and so is a rig that did
/// not move between several images.
struct MarkedView {
  std::string name;  ///< for people
  Camera camera;     ///< after prepareCamera
  Pose camera_from_rig;
  Marks marks;
};

/// Which of the two kinds a mark is.
enum class MarkKind { kPoint, kLine };

/// A mark of one of the views.
struct MarkAddress {
  std::size_t view = 0;
  MarkKind kind = MarkKind::kPoint;
  std::size_t index = 0;  ///< among the view's points or lines

  bool operator==(const MarkAddress&) const = default;
};

/// Every mark that takes part in solving, view by view, points first.
std::vector<MarkAddress> usedMarks(std::span<const MarkedView> views);

const std::string& markId(std::span<const MarkedView> views, const MarkAddress& at);
double markSigma_px(std::span<const MarkedView> views, const MarkAddress& at);

}  // namespace boresight::sessions
