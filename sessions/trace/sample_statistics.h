// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <cstdint>
#include <vector>

#include "sessions/trace/trace.h"

namespace boresight::sessions {

/// Edge places of a refinement, counted.
struct SampleCounts {
  std::int32_t places = 0;  ///< along rendered edges
  std::int32_t found = 0;   ///< with an image edge within the search radius
  std::int32_t used = 0;    ///< with a weight above one half in the last round

  double foundShare() const { return places > 0 ? static_cast<double>(found) / places : 0.0; }
  double usedShare() const { return places > 0 ? static_cast<double>(used) / places : 0.0; }
};

/// Statistics of a refinement along the rendered edges.
struct SampleStatistics {
  SampleCounts all;
  SampleCounts creases;    ///< inner edges, where the normals differ
  SampleCounts occluding;  ///< where a surface hides another part of the scene
  SampleCounts border;     ///< the scene's outline
  double radius_px = 0.0;  ///< the histogram covers residuals within -radius ... radius
  std::vector<std::int32_t> found_in_bin;  ///< residuals along the edges' normals, found places
  std::vector<std::int32_t> used_in_bin;   ///< of those, the used ones
};

/// Of an iteration that refines and was recorded in full; `bins` is odd, so that one is centred
/// at 0. Residuals beyond the search radius (the pose has moved since) count in the outer bins. A
/// place of several kinds counts as border before occluding before crease.
SampleStatistics sampleStatistics(const IterationTrace& iteration, int bins);

}  // namespace boresight::sessions
