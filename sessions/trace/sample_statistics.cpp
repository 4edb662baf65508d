// SPDX-License-Identifier: Apache-2.0
#include "sessions/trace/sample_statistics.h"

#include <algorithm>
#include <cmath>
#include <cstddef>

namespace boresight::sessions {
namespace {

bool isFound(const EdgeSample& sample) { return sample.gradient != 0.0; }
bool isUsed(const EdgeSample& sample) { return isFound(sample) && sample.weight > 0.5; }

void count(const EdgeSample& sample, SampleCounts& counts) {
  ++counts.places;
  if (isFound(sample)) ++counts.found;
  if (isUsed(sample)) ++counts.used;
}

SampleCounts& ofKind(const EdgeSample& sample, SampleStatistics& statistics) {
  if ((sample.kind & kEdgeBorder) != 0) return statistics.border;
  if ((sample.kind & kEdgeOccluding) != 0) return statistics.occluding;
  return statistics.creases;
}

std::size_t binOf(double residual_px, double radius_px, std::size_t bins) {
  if (!(radius_px > 0.0)) return bins / 2;
  const double place =
      std::floor((residual_px / radius_px + 1.0) * 0.5 * static_cast<double>(bins));
  return static_cast<std::size_t>(std::clamp(place, 0.0, static_cast<double>(bins - 1)));
}

}  // namespace

SampleStatistics sampleStatistics(const IterationTrace& iteration, int bins) {
  SampleStatistics statistics;
  statistics.radius_px = iteration.threshold_px;
  const auto bin_count = static_cast<std::size_t>(std::max(1, bins));
  statistics.found_in_bin.assign(bin_count, 0);
  statistics.used_in_bin.assign(bin_count, 0);
  for (const EdgeSample& sample : iteration.refinement.samples) {
    count(sample, statistics.all);
    count(sample, ofKind(sample, statistics));
    if (!isFound(sample)) continue;
    const std::size_t bin = binOf(sample.residual_px, statistics.radius_px, bin_count);
    ++statistics.found_in_bin[bin];
    if (isUsed(sample)) ++statistics.used_in_bin[bin];
  }
  return statistics;
}

}  // namespace boresight::sessions
