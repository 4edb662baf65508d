// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>

#include "core/base/options.h"

namespace boresight {

/// Of the support that an image must give a converged pose.
struct SupportOptions {
  bool gate = true;
  double min_probability = 0.5;
  double min_support = 0.32;
  double search_radius_px = 4.0;
  double near_px = 1.0;
  double min_gradient = 4.0;
  double derivative_sigma_px = 1.0;
  bool partial = false;
  double partial_visible = 0.45;
  double partial_precision = 0.7;

  template <class Self, class Visitor>
  static void visitFields(Self& self, Visitor&& visit) {
    visit(OptionInfo{"support.gate", "", 0, 1,
                     "A converged pose must be supported by the image's edges."},
          self.gate);
    visit(OptionInfo{"support.min_probability", "", 0.0, 1.0,
                     "Probability of being right that a converged pose must have, by the evidence "
                     "of its contours and its edge support."},
          self.min_probability);
    visit(OptionInfo{"support.min_support", "", 0.0, 1.0,
                     "Edge support that a converged pose must have when nothing was searched."},
          self.min_support);
    visit(OptionInfo{"support.search_radius_px", "px", 1.0, 50.0,
                     "How far around a rendered edge its counterpart is looked for, in pixels of "
                     "the render."},
          self.search_radius_px);
    visit(OptionInfo{"support.near_px", "px", 0.1, 50.0,
                     "A rendered edge counts as seen when its counterpart is this near, in pixels "
                     "of the render."},
          self.near_px);
    visit(OptionInfo{"support.min_gradient", "gray/px", 0.0, 255.0,
                     "Weaker edges do not count as seen."},
          self.min_gradient);
    visit(OptionInfo{"support.derivative_sigma_px", "px", 0.3, 5.0,
                     "Scale of the derivative along the normal."},
          self.derivative_sigma_px);
    visit(OptionInfo{"support.partial", "", 0, 1,
                     "A pose with too little edge support for a part of the object being hidden is "
                     "accepted when enough of the object is visible and precisely met."},
          self.partial);
    visit(OptionInfo{"support.partial_visible", "", 0.0, 1.0,
                     "Share of the rendered edges that must lie where the object is visible."},
          self.partial_visible);
    visit(OptionInfo{"support.partial_precision", "", 0.0, 1.0,
                     "Share of the edges found about the rendered ones that must be met, beyond "
                     "chance."},
          self.partial_precision);
  }
};

}  // namespace boresight
