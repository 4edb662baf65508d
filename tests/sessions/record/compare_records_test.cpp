// SPDX-License-Identifier: Apache-2.0
#include "sessions/record/compare_records.h"

#include <gtest/gtest.h>

#include <span>

#include "tests/sessions/record/recorded_run.h"
#include "tests/support/matchers.h"

namespace boresight::test {
namespace {

using namespace sessions;

const OnboardRecord& reference() { return exampleRun().run.record; }

/// Each change of one value in a copy is the first difference found.
TEST(CompareRecords, NamesTheFirstThingThatDiffers) {
  const struct Change {
    RunPart part;
    void (*make)(OnboardRecord&);
  } changes[] = {
      {RunPart::kMask, [](auto& run) { run.inputs->sha256.ignore[3] ^= 1; }},
      {RunPart::kScene, [](auto& run) { run.inputs->sha256.scene[31] ^= 128; }},
      {RunPart::kCamera, [](auto& run) { run.inputs->sha256.camera[0] ^= 1; }},
      {RunPart::kSeed,
       [](auto& run) { run.inputs->camera_from_station_seed.translation_m.z() += 1e-15; }},
      {RunPart::kSeed, [](auto& run) { run.inputs->uncertainty.rotation_rad.x() *= 2.0; }},
      {RunPart::kSeed, [](auto& run) { run.inputs->end_effector_in_camera_m.x() += 0.1; }},
      {RunPart::kOptions, [](auto& run) { run.options[0].options[5].bits ^= 1; }},
      {RunPart::kOptions, [](auto& run) { run.options[0].options.pop_back(); }},
      {RunPart::kEdges, [](auto& run) { run.edges->sha256[9] ^= 4; }},
      {RunPart::kEdges, [](auto& run) { run.edges->high_threshold += 1.0; }},
      {RunPart::kEdges, [](auto& run) { --run.edges->edge_count; }},
      {RunPart::kRender, [](auto& run) { ++run.iterations[0].trace.edge_pixel_count; }},
      {RunPart::kRender, [](auto& run) { (*run.iterations[0].render_sha256)[0] ^= 1; }},
      {RunPart::kTemplates, [](auto& run) { ++(*run.iterations[0].templates)[7].x; }},
      {RunPart::kMatches, [](auto& run) { (*run.iterations[0].templates)[2].score += 1e-6F; }},
      {RunPart::kInliers, [](auto& run) { (*run.iterations[0].templates)[4].inlier ^= true; }},
      {RunPart::kPose,
       [](auto& run) { run.iterations[0].trace.camera_from_station.translation_m.x() += 1e-16; }},
      {RunPart::kEnd, [](auto& run) { run.end->covariance(0, 0) *= 1.0 + 1e-15; }},
      {RunPart::kDigest, [](auto& run) { run.end->digest[0] ^= 1; }},
  };
  for (const Change& change : changes) {
    OnboardRecord changed = reference();
    change.make(changed);
    for (const auto& found :
         {compareRecords(reference(), changed), compareRecords(changed, reference())}) {
      ASSERT_TRUE(found.first) << runPartText(change.part);
      EXPECT_EQ(found.first->part, change.part) << found.first->text;
      EXPECT_EQ(found.verdict, RunVerdict::kDifferent)
          << "runs given the same pixels must be the same to the bit";
    }
  }
}

TEST(CompareRecords, OtherPixelsAreHeldToTheLimits) {
  ExampleCase noisy("os");
  for (std::size_t i = 0; i < noisy.image.pixels.size(); i += 7)
    noisy.image.pixels[i] = static_cast<std::uint8_t>(
        std::clamp(noisy.image.pixels[i] + (i % 2 == 0 ? 2 : -2), 0, 255));
  const OnboardRecord other = recordRun(noisy.problem(), recordedOptions()).record;
  const RecordComparison found = compareRecords(reference(), other);
  ASSERT_TRUE(found.first);
  EXPECT_EQ(found.first->part, RunPart::kPixels);
  EXPECT_EQ(found.verdict, RunVerdict::kWithinLimits) << comparisonText(found);
  ASSERT_TRUE(found.pose_sigmas);
  EXPECT_GT(*found.pose_sigmas, 0.0);
  EXPECT_GT(found.iterations.front().templates, 20);
  ComparisonLimits strict;
  strict.pose_sigmas = 1e-9;
  EXPECT_EQ(compareRecords(reference(), other, strict).verdict, RunVerdict::kDifferent);
  OnboardRecord astray = other;
  astray.end->camera_from_station.translation_m.x() += 0.005;
  EXPECT_EQ(compareRecords(reference(), astray).verdict, RunVerdict::kDifferent);
}

TEST(CompareRecords, ACutRecordIsComparedAsFarAsItGoes) {
  const OnboardRecord cut = parseRecord("cut.whsr", std::span(exampleRun().run.bytes).first(4000));
  ASSERT_FALSE(cut.whole());
  const RecordComparison found = compareRecords(reference(), cut);
  EXPECT_FALSE(found.first) << found.first->text;
  EXPECT_EQ(found.verdict, RunVerdict::kWithinLimits);
  EXPECT_FALSE(found.missing.empty());
  EXPECT_FALSE(found.showsAgreement()) << "its end is not known";
  EXPECT_THAT(comparisonText(found), Not(HasSubstr("final poses")));
  OnboardRecord changed = cut;
  ASSERT_FALSE(changed.options.empty());
  changed.options.front().options[0].bits ^= 1;
  EXPECT_EQ(compareRecords(reference(), changed).verdict, RunVerdict::kDifferent);
}

TEST(CompareRecords, RecordWithoutAnyPartOfARun_ShowsNothing) {
  const OnboardRecord empty = parseRecord("c.whsr", std::span(exampleRun().run.bytes).first(64));
  for (const RecordComparison& found :
       {compareRecords(reference(), empty), compareRecords(empty, reference())}) {
    EXPECT_EQ(found.verdict, RunVerdict::kUndecided);
    EXPECT_FALSE(found.showsAgreement());
    EXPECT_THAT(comparisonText(found), AllOf(HasSubstr("not comparable"), HasSubstr("missing: "),
                                             Not(HasSubstr("apart")), Not(HasSubstr("equal"))));
  }
}

}  // namespace
}  // namespace boresight::test
