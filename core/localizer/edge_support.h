// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>

#include "core/base/image.h"
#include "core/base/options.h"
#include "core/edges/edge_map.h"
#include "core/render/edge_render.h"

namespace boresight {

struct SupportOptions {
  bool gate = true;
  double min_support = 0.40;
  double direction_tolerance_rad = 0.5235987755982988;  ///< 30 deg

  template <class Self, class Visitor>
  static void visitFields(Self& self, Visitor&& visit) {
    visit(OptionInfo{"support.gate", "", 0, 1,
                     "A converged pose must be supported by the image's edges."},
          self.gate);
    visit(
        OptionInfo{
            "support.min_support", "", 0.0, 1.0,
            "Share of rendered edge pixels that must meet an image edge of their direction."},
        self.min_support);
    visit(OptionInfo{"support.direction_tolerance_rad", "rad", 0.05, 1.6,
                     "Largest angle between rendered and seen edge."},
          self.direction_tolerance_rad);
  }
};

/// How much of what the pose predicts is seen, not resting on any match: rendered edge pixels with
/// a test edge within one pixel (of the render's level) whose gradient in the raw image points
/// along the rendered normal, either way.
struct EdgeSupport {
  std::int32_t rendered = 0;  ///< rendered edge pixels that are not ignored
  std::int32_t supported = 0;
  double share() const {
    return rendered > 0 ? static_cast<double>(supported) / static_cast<double>(rendered) : 0.0;
  }
};

EdgeSupport measureEdgeSupport(const EdgeRender& render, int level, const EdgeMap& edges,
                               const ImageView& image, const BitImage* ignore,
                               const SupportOptions& options);

}  // namespace boresight
