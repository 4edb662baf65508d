// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>

#include "core/base/options.h"

namespace boresight {

/// Whether a converged pose is the only one: repeated features (sleeves, fins, a row of bolts) can
/// hold a run one pitch off with good support.
struct AmbiguityOptions {
  bool enabled = false;
  double min_similarity = 0.3;
  double reach = 2.0;
  std::int32_t max_rivals = 8;
  double min_margin_nats = 10.0;

  bool operator==(const AmbiguityOptions&) const = default;

  template <class Self, class Visitor>
  static void visitFields(Self& self, Visitor&& visit) {
    visit(OptionInfo{"ambiguity.enabled", "", 0, 1,
                     "A converged pose is compared with those under which the model's edges look "
                     "like themselves, and the best of them stands."},
          self.enabled);
    visit(OptionInfo{"ambiguity.min_similarity", "", 0.05, 1.0,
                     "Share of the rendered edges, beyond chance, that a displacement must lay on "
                     "others of their direction."},
          self.min_similarity);
    visit(OptionInfo{"ambiguity.reach", "", 0.0, 10.0,
                     "How far from the seed rivals are looked for, as a multiple of its "
                     "uncertainty."},
          self.reach);
    visit(OptionInfo{"ambiguity.max_rivals", "", 1, 32, "Rivals that are tried, at most."},
          self.max_rivals);
    visit(OptionInfo{"ambiguity.min_margin_nats", "", 0.0, 1e6,
                     "A run whose best pose has less evidence than this beyond a rival's ends as "
                     "ambiguous; one clearly better outside the seed's uncertainty ends it, too."},
          self.min_margin_nats);
  }
};

}  // namespace boresight
