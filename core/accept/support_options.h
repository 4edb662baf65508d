// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>

#include "core/base/options.h"

namespace boresight {

/// Options of the acceptance test of a converged pose.
struct SupportOptions {
  bool gate = true;
  double min_probability = 0.3;
  double min_support = 0.32;

  template <class Self, class Visitor>
  static void visitFields(Self& self, Visitor&& visit) {
    visit(
        OptionInfo{
            "support.gate", "", 0, 1,
            "A converged pose must be supported by the image's edges, which must be sharp and "
            "confirm the focal length; and no other pose that shows about the same edges may fit "
            "as well."},
        self.gate);
    visit(OptionInfo{"support.min_probability", "", 0.0, 1.0,
                     "Least probability that a converged pose is correct, by the evidence of its "
                     "contours and its edge support."},
          self.min_probability);
    visit(OptionInfo{"support.min_support", "", 0.0, 1.0,
                     "Least edge support of a converged pose without a search."},
          self.min_support);
  }
};

}  // namespace boresight
