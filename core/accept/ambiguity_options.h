// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>

#include "core/base/options.h"

namespace boresight {

/// Whether a converged pose is the only one: repeated features (sleeves, fins, a row of bolts) can
/// hold a run one pitch off with good support.
struct AmbiguityOptions {
  bool enabled = false;

  bool operator==(const AmbiguityOptions&) const = default;

  template <class Self, class Visitor>
  static void visitFields(Self& self, Visitor&& visit) {
    visit(OptionInfo{"ambiguity.enabled", "", 0, 1,
                     "A converged pose is compared with those under which the model's edges look "
                     "like themselves, and the best of them stands."},
          self.enabled);
  }
};

}  // namespace boresight
