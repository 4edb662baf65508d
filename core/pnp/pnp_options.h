// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>

#include "core/base/options.h"

namespace boresight {

enum class PnpSampler : std::int32_t { kP3p = 0, kGuided = 1 };
inline constexpr const char* kPnpSamplerNames[] = {"p3p", "guided"};

/// Of RANSAC and the refits.
struct PnpOptions {
  PnpSampler sampler = PnpSampler::kGuided;
  std::int32_t max_samples = 500;
  double confidence = 0.999;
  std::int32_t min_inliers = 6;
  std::int32_t local_optimizations = 3;  ///< rounds of refit on the inliers after each new best
  std::int32_t guided_sample_size = 3;   ///< points of a kGuided sample
  double prior_factor = 3.0;  ///< the weak prior's sigma as a multiple of the uncertainty (kGuided)
  std::int32_t refine_iterations = 20;
  std::int64_t seed = 1;

  template <class Self, class Visitor>
  static void visitFields(Self& self, Visitor&& visit) {
    visit(OptionInfo{"pnp.sampler", "", 0, 1,
                     "Minimal samples by P3P, or a few points refined from the hypothesis under a "
                     "weak prior.",
                     kPnpSamplerNames},
          self.sampler);
    visit(OptionInfo{"pnp.max_samples", "", 1, 100000, "Largest number of RANSAC samples."},
          self.max_samples);
    visit(OptionInfo{"pnp.confidence", "", 0.5, 0.999999, "RANSAC stops early at this confidence."},
          self.confidence);
    visit(OptionInfo{"pnp.min_inliers", "", 4, 10000, "Fewer inliers are no pose."},
          self.min_inliers);
    visit(OptionInfo{"pnp.local_optimizations", "", 0, 20,
                     "Refits on the inliers after each new best sample."},
          self.local_optimizations);
    visit(OptionInfo{"pnp.guided_sample_size", "", 3, 4,
                     "Points of a guided sample; three need fewer samples, four are less noisy."},
          self.guided_sample_size);
    visit(OptionInfo{"pnp.prior_factor", "", 0.1, 1000.0,
                     "Sigma of the prior in guided samples, as a multiple of the uncertainty."},
          self.prior_factor);
    visit(OptionInfo{"pnp.refine_iterations", "", 1, 200, "Largest number of refinement steps."},
          self.refine_iterations);
    visit(OptionInfo{"pnp.seed", "", 0, 9007199254740991.0, "Seed of the sample generator."},
          self.seed);
  }
};

}  // namespace boresight
