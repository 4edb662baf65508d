// SPDX-License-Identifier: Apache-2.0
#include "sessions/trace/sample_statistics.h"

#include <cmath>
#include <numeric>

#include <gtest/gtest.h>

#include "tests/support/example_run.h"

namespace boresight::sessions {
namespace {

EdgeSample sampleOf(double residual_px, double weight, std::uint8_t kind) {
  EdgeSample sample;
  sample.residual_px = residual_px;
  sample.gradient = 5.0;
  sample.weight = weight;
  sample.kind = kind;
  return sample;
}

TEST(SampleStatistics, CountByKindAndBin) {
  IterationTrace iteration;
  iteration.threshold_px = 1.0;
  auto& samples = iteration.refinement.samples;
  samples.push_back(sampleOf(0.0, 0.9, kEdgeCrease));
  samples.push_back(sampleOf(-0.9, 0.2, kEdgeCrease));
  samples.push_back(sampleOf(5.0, 0.0, kEdgeOccluding | kEdgeCrease));
  samples.push_back(sampleOf(0.1, 0.8, kEdgeBorder | kEdgeOccluding));
  samples.push_back(EdgeSample{});  // nothing found
  const SampleStatistics statistics = sampleStatistics(iteration, 5);
  EXPECT_EQ(statistics.all.places, 5);
  EXPECT_EQ(statistics.all.found, 4);
  EXPECT_EQ(statistics.all.used, 2);
  EXPECT_EQ(statistics.creases.places, 3);
  EXPECT_EQ(statistics.creases.found, 2);
  EXPECT_EQ(statistics.occluding.found, 1);
  EXPECT_EQ(statistics.border.used, 1);
  EXPECT_EQ(statistics.found_in_bin, (std::vector<std::int32_t>{1, 0, 2, 0, 1}));
  EXPECT_EQ(statistics.used_in_bin, (std::vector<std::int32_t>{0, 0, 2, 0, 0}));
  EXPECT_DOUBLE_EQ(statistics.all.foundShare(), 0.8);
  const SampleStatistics none = sampleStatistics(IterationTrace{}, 3);
  EXPECT_EQ(none.all.places, 0);
  EXPECT_EQ(none.all.foundShare(), 0.0);
}

TEST(SampleStatistics, AgreeWithWhatTheRunCounted) {
  const IterationTrace& last = *test::exampleTrace().iterations.back();
  ASSERT_EQ(last.kind, IterationKind::kRefine);
  const SampleStatistics statistics = sampleStatistics(last, 21);
  EXPECT_EQ(statistics.all.places, last.refinement.sample_count);
  EXPECT_EQ(statistics.all.found, last.refinement.found_count);
  EXPECT_EQ(statistics.all.used, last.refinement.used_count);
  EXPECT_EQ(std::accumulate(statistics.found_in_bin.begin(), statistics.found_in_bin.end(), 0),
            statistics.all.found);
  EXPECT_EQ(statistics.creases.places + statistics.occluding.places + statistics.border.places,
            statistics.all.places);
}

}  // namespace
}  // namespace boresight::sessions
