// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>

#include "core/base/options.h"

namespace boresight {

enum class PnpSampler : std::int32_t { kGuided = 0, kEpnp = 1 };
inline constexpr const char* kPnpSamplerNames[] = {"guided", "epnp"};

/// Options of RANSAC and the refits.
struct PnpOptions {
  PnpSampler sampler = PnpSampler::kGuided;
  std::int32_t max_samples = 500;
  std::int32_t min_inliers = 6;
  std::int64_t seed = 1;

  template <class Self, class Visitor>
  static void visitFields(Self& self, Visitor&& visit) {
    visit(OptionInfo{"pnp.sampler", "", 0, 1,
                     "How RANSAC solves a sample: three points refined from the hypothesis under a "
                     "weak prior, or five points by EPnP.",
                     kPnpSamplerNames},
          self.sampler);
    visit(OptionInfo{"pnp.max_samples", "", 1, 100000, "Largest number of RANSAC samples."},
          self.max_samples);
    visit(OptionInfo{"pnp.min_inliers", "", 4, 10000, "Fewer inliers give no pose."},
          self.min_inliers);
    visit(OptionInfo{"pnp.seed", "", 0, 9007199254740991.0, "Seed of the sample generator."},
          self.seed);
  }
};

}  // namespace boresight
