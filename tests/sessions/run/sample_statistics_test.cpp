// SPDX-License-Identifier: Apache-2.0
#include "sessions/run/sample_statistics.h"

#include <cmath>
#include <numeric>

#include <gtest/gtest.h>

#include "sessions/run/runner.h"
#include "tests/support/example_case.h"

namespace boresight::sessions {
namespace {

EdgeSample sampleAt(double residual_px, double weight, std::uint8_t kind) {
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
  samples.push_back(sampleAt(0.0, 0.9, kEdgeCrease));
  samples.push_back(sampleAt(-0.9, 0.2, kEdgeCrease));
  samples.push_back(sampleAt(5.0, 0.0, kEdgeOccluding | kEdgeCrease));
  samples.push_back(sampleAt(0.1, 0.8, kEdgeBorder | kEdgeOccluding));
  samples.push_back(EdgeSample{});  // nothing found
  const SampleStatistics made = sampleStatistics(iteration, 5);
  EXPECT_EQ(made.all.places, 5);
  EXPECT_EQ(made.all.found, 4);
  EXPECT_EQ(made.all.used, 2);
  EXPECT_EQ(made.creases.places, 3);
  EXPECT_EQ(made.creases.found, 2);
  EXPECT_EQ(made.occluding.found, 1);
  EXPECT_EQ(made.border.used, 1);
  EXPECT_EQ(made.found_in_bin, (std::vector<std::int32_t>{1, 0, 2, 0, 1}));
  EXPECT_EQ(made.used_in_bin, (std::vector<std::int32_t>{0, 0, 2, 0, 0}));
  EXPECT_DOUBLE_EQ(made.all.foundShare(), 0.8);
}

TEST(SampleStatistics, AgreeWithWhatTheRunCounted) {
  const test::ExampleCase example("os");
  const LocalizationTrace run = localize(example.problem(), defaultProfile(), RecordLevel::kFull);
  const IterationTrace& last = *run.iterations.back();
  ASSERT_EQ(last.kind, IterationKind::kRefine);
  const SampleStatistics made = sampleStatistics(last, 21);
  EXPECT_EQ(made.all.places, last.refinement.sample_count);
  EXPECT_EQ(made.all.found, last.refinement.found_count);
  EXPECT_EQ(made.all.used, last.refinement.used_count);
  EXPECT_EQ(std::accumulate(made.found_in_bin.begin(), made.found_in_bin.end(), 0), made.all.found);
  EXPECT_EQ(made.creases.places + made.occluding.places + made.border.places, made.all.places);
}

TEST(SampleStatistics, AreEmptyWithoutSamples) {
  const SampleStatistics made = sampleStatistics(IterationTrace{}, 3);
  EXPECT_EQ(made.all.places, 0);
  EXPECT_EQ(made.all.foundShare(), 0.0);
}

}  // namespace
}  // namespace boresight::sessions
