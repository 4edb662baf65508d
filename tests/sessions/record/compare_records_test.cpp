// SPDX-License-Identifier: Apache-2.0
#include "sessions/record/compare_records.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <span>

#include "tests/sessions/record/recorded_run.h"
#include "tests/support/matchers.h"
#include "tests/support/random_pose.h"

namespace boresight::test {
namespace {

using namespace sessions;

const OnboardRecord& reference() { return exampleRun().run.record; }

/// Each change of one value in a copy is the first difference found, with its place.
TEST(CompareRecords, NamesTheFirstThingThatDiffers) {
  const struct Change {
    RunPart part;
    void (*make)(OnboardRecord&);
    int iteration = -1;
    int template_index = -1;
  } changes[] = {
      {RunPart::kMask, [](auto& run) { run.inputs->sha256.ignore[3] ^= 1; }},
      {RunPart::kScene, [](auto& run) { run.inputs->sha256.scene[31] ^= 128; }},
      {RunPart::kCamera, [](auto& run) { run.inputs->sha256.camera[0] ^= 1; }},
      {RunPart::kSeed,
       [](auto& run) { run.inputs->camera_from_station_seed.translation_m.z() += 1e-15; }},
      {RunPart::kSeed, [](auto& run) { run.inputs->uncertainty.translation_m.z() *= 2.0; }},
      {RunPart::kSeed, [](auto& run) { run.inputs->uncertainty.rotation_rad.x() *= 2.0; }},
      {RunPart::kSeed, [](auto& run) { run.inputs->uncertainty.pivot_in_camera_m.y() += 0.1; }},
      {RunPart::kSeed, [](auto& run) { run.inputs->end_effector_in_camera_m.x() += 0.1; }},
      {RunPart::kOptions, [](auto& run) { run.options[0].options[5].bits ^= 1; }},
      {RunPart::kOptions, [](auto& run) { run.options[0].options.pop_back(); }},
      {RunPart::kEdges, [](auto& run) { run.edges->sha256[9] ^= 4; }},
      {RunPart::kEdges, [](auto& run) { run.edges->low_threshold += 1.0; }},
      {RunPart::kEdges, [](auto& run) { run.edges->high_threshold += 1.0; }},
      {RunPart::kEdges, [](auto& run) { --run.edges->edge_count; }},
      {RunPart::kRender, [](auto& run) { run.iterations[1].trace.kind = IterationKind::kRefine; },
       1},
      {RunPart::kRender, [](auto& run) { ++run.iterations[0].trace.level; }, 0},
      {RunPart::kRender, [](auto& run) { ++run.iterations[0].trace.edge_pixel_count; }, 0},
      {RunPart::kRender, [](auto& run) { (*run.iterations[0].render_sha256)[0] ^= 1; }, 0},
      {RunPart::kTemplates, [](auto& run) { ++run.iterations[0].trace.template_count; }, 0},
      {RunPart::kTemplates, [](auto& run) { ++(*run.iterations[0].templates)[7].x; }, 0, 7},
      {RunPart::kTemplates, [](auto& run) { ++(*run.iterations[1].templates)[6].y; }, 1, 6},
      {RunPart::kMatches, [](auto& run) { (*run.iterations[0].templates)[2].score += 1e-6F; }, 0,
       2},
      {RunPart::kMatches, [](auto& run) { (*run.iterations[0].templates)[0].found_x += 1.0F; }, 0,
       0},
      {RunPart::kMatches, [](auto& run) { (*run.iterations[0].templates)[1].found_y += 1.0F; }, 0,
       1},
      {RunPart::kMatches, [](auto& run) { (*run.iterations[0].templates)[3].searched ^= true; }, 0,
       3},
      {RunPart::kMatches, [](auto& run) { (*run.iterations[0].templates)[3].at_border ^= true; }, 0,
       3},
      {RunPart::kMatches, [](auto& run) { (*run.iterations[0].templates)[3].second_score = 0.3F; },
       0, 3},
      {RunPart::kMatches, [](auto& run) { ++run.iterations[0].trace.searched_count; }, 0},
      {RunPart::kMatches, [](auto& run) { ++run.iterations[0].trace.correspondence_count; }, 0},
      {RunPart::kInliers, [](auto& run) { (*run.iterations[0].templates)[4].inlier ^= true; }, 0,
       4},
      {RunPart::kInliers, [](auto& run) { ++run.iterations[0].trace.pnp.inlier_count; }, 0},
      {RunPart::kInliers, [](auto& run) { ++run.iterations[1].trace.refinement.used_count; }, 1},
      {RunPart::kPose,
       [](auto& run) {
         run.iterations[1].trace.camera_from_station_before.translation_m.x() += 1e-16;
       },
       1},
      {RunPart::kPose,
       [](auto& run) { run.iterations[0].trace.camera_from_station.translation_m.x() += 1e-16; },
       0},
      {RunPart::kPose,
       [](auto& run) { run.iterations[0].trace.status = LocalizationStatus::kBlurred; }, 0},
      {RunPart::kPose, [](auto& run) { run.iterations[0].trace.reached = Stage::kSupport; }, 0},
      {RunPart::kEnd, [](auto& run) { run.iterations.pop_back(); }},
      {RunPart::kEnd, [](auto& run) { run.end->status = LocalizationStatus::kBlurred; }},
      {RunPart::kEnd, [](auto& run) { run.end->fault = Status::kInvalidPose; }},
      {RunPart::kEnd, [](auto& run) { run.end->camera_from_station.translation_m.y() += 1e-16; }},
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
      EXPECT_EQ(found.first->iteration, change.iteration) << found.first->text;
      EXPECT_EQ(found.first->template_index, change.template_index) << found.first->text;
      if (change.iteration < 0) {
        EXPECT_THAT(found.first->text, Not(HasSubstr(", in iteration")));
      } else {
        EXPECT_THAT(found.first->text,
                    testing::EndsWith(", in iteration " + std::to_string(change.iteration + 1)));
      }
      if (change.template_index >= 0) {
        EXPECT_THAT(found.first->text,
                    StartsWith("template " + std::to_string(change.template_index + 1) + " "));
      }
      EXPECT_EQ(found.verdict, RunVerdict::kDifferent)
          << "runs given the same pixels must be the same to the bit";
    }
  }
}

TEST(CompareRecords, EachCountOfTheEdgeSupport_IsCompared) {
  const std::size_t last = reference().iterations.size() - 1;
  ASSERT_TRUE(reference().iterations[last].support);
  for (const auto count : {&EdgeSupport::rendered, &EdgeSupport::covered, &EdgeSupport::displaced,
                           &EdgeSupport::displaced_covered, &EdgeSupport::seen,
                           &EdgeSupport::explained, &EdgeSupport::displaced_explained}) {
    OnboardRecord changed = reference();
    ++((*changed.iterations[last].support).*count);
    const RecordComparison found = compareRecords(reference(), changed);
    ASSERT_TRUE(found.first);
    EXPECT_EQ(found.first->part, RunPart::kSupport);
    EXPECT_EQ(found.first->iteration, static_cast<int>(last));
  }
}

TEST(CompareRecords, TextOfADifference_HasBothValues) {
  const auto text = [](void (*make)(OnboardRecord&)) {
    OnboardRecord changed = reference();
    make(changed);
    return compareRecords(reference(), changed).first->text;
  };
  const int edges = reference().edges->edge_count;
  EXPECT_EQ(text([](auto& run) { run.edges->edge_count = 7; }),
            "the image's edge pixels differ: " + std::to_string(edges) + " and 7");
  EXPECT_EQ(text([](auto& run) { run.end->status = LocalizationStatus::kBlurred; }),
            "the runs ended as converged and blurred");
  const auto option = [](OnboardRecord& run) -> RecordedOption& {
    return *std::ranges::find(run.options[0].options, "pnp.min_inliers", &RecordedOption::name);
  };
  OnboardRecord changed = reference();
  const double before = option(changed).value();
  option(changed).bits = 99;
  EXPECT_EQ(compareRecords(reference(), changed).first->text,
            "the option pnp.min_inliers is " + std::to_string(std::lround(before)) + " and 99");
  option(changed).name = "later.option";
  EXPECT_THAT(compareRecords(reference(), changed).first->text,
              StartsWith("only one run has the option "));
}

/// Of two differences the earlier one in a run is reported.
TEST(CompareRecords, LaterDifference_IsNotTheFirst) {
  OnboardRecord changed = reference();
  changed.end->digest[0] ^= 1;
  ++changed.iterations[1].trace.searched_count;
  ++changed.iterations[0].trace.searched_count;
  EXPECT_EQ(compareRecords(reference(), changed).first->iteration, 0);
  --changed.edges->edge_count;
  EXPECT_EQ(compareRecords(reference(), changed).first->part, RunPart::kEdges);
  changed.inputs->camera_from_station_seed.translation_m.x() += 1.0;
  EXPECT_EQ(compareRecords(reference(), changed).first->part, RunPart::kSeed);
}

TEST(CompareRecords, OptionsChangedOnTheWay_AreComparedWithTheirIteration) {
  OnboardRecord run = reference();
  run.options.push_back(run.options.front());
  run.options.back().first_iteration = 3;
  OnboardRecord other = run;
  EXPECT_FALSE(compareRecords(run, other).first);
  other.options.back().options[5].bits ^= 1;
  const RecordComparison found = compareRecords(run, other);
  ASSERT_TRUE(found.first);
  EXPECT_EQ(found.first->part, RunPart::kOptions);
  EXPECT_EQ(found.first->iteration, 3);
}

TEST(CompareRecords, PartOfOneRecordAlone_IsNoDifference) {
  void (*const removals[])(OnboardRecord&) = {
      [](OnboardRecord& run) { run.inputs.reset(); },
      [](OnboardRecord& run) { run.options.clear(); },
      [](OnboardRecord& run) { run.edges.reset(); },
      [](OnboardRecord& run) { run.iterations[0].render_sha256.reset(); },
      [](OnboardRecord& run) { run.iterations[0].templates.reset(); },
      [](OnboardRecord& run) { run.iterations.back().support.reset(); },
      [](OnboardRecord& run) { run.end.reset(); },
  };
  for (const auto remove : removals) {
    OnboardRecord less = reference();
    remove(less);
    less.missing.push_back("a part");
    for (const auto& found :
         {compareRecords(reference(), less), compareRecords(less, reference())}) {
      EXPECT_FALSE(found.first) << found.first->text;
      EXPECT_EQ(found.inputs_compared, less.inputs.has_value() && !less.options.empty());
      EXPECT_EQ(found.ends_compared, less.end.has_value());
      EXPECT_EQ(found.verdict, less.end ? RunVerdict::kEqual : RunVerdict::kWithinLimits)
          << "one digest covers what a record lacks";
    }
  }
}

/// Two runs on other pixels, of one iteration each: `templates` templates found at the same
/// positions, the first ten of them inliers.
struct TwoRuns {
  OnboardRecord run;
  OnboardRecord other;

  explicit TwoRuns(int templates) {
    run.inputs.emplace();
    run.options.resize(1);
    RecordedIteration& iteration = run.iterations.emplace_back();
    iteration.templates.emplace();
    for (int i = 0; i < templates; ++i) {
      RecordedTemplate& item = iteration.templates->emplace_back();
      item.x = i;
      item.y = 2 * i;
      item.searched = true;
      item.inlier = i < 10;
      item.found_x = 50.0F;
      item.found_y = 60.0F;
    }
    run.end.emplace().status = LocalizationStatus::kConverged;
    run.end->covariance.setIdentity();
    run.end->digest = "a";
    other = run;
    other.inputs->sha256.pixels[0] = 1;
    other.end->digest = "b";
  }
  std::vector<RecordedTemplate>& otherTemplates() { return *other.iterations[0].templates; }
  RecordComparison compared() const {
    const RecordComparison found = compareRecords(run, other);
    EXPECT_EQ(found.first->part, RunPart::kPixels);
    EXPECT_EQ(found.verdict,
              found.beyond.empty() ? RunVerdict::kWithinLimits : RunVerdict::kDifferent);
    return found;
  }
};

TEST(CompareRecords, SharesOfTheFirstIteration_AreHeldToTheirLimits) {
  for (const int templates : {9, 10, 20})
    for (int moved = 0; moved <= templates; ++moved) {
      TwoRuns runs(templates);
      for (int i = 0; i < moved; ++i)
        runs.otherTemplates()[static_cast<std::size_t>(i)].found_y += i % 2 == 0 ? 1.25F : -1.25F;
      const RecordComparison found = runs.compared();
      ASSERT_EQ(found.iterations.size(), 1u);
      EXPECT_EQ(found.iterations[0].templates, templates);
      EXPECT_EQ(found.iterations[0].found_alike, templates - moved);
      // 80 % of ten and more.
      const bool beyond = templates >= 10 && 10 * (templates - moved) < 8 * templates;
      EXPECT_EQ(found.beyond.size(), beyond ? 1u : 0u) << moved << " of " << templates;
    }
  for (int common = 0; common <= 10; ++common) {
    TwoRuns runs(20);
    for (std::size_t i = static_cast<std::size_t>(common); i < 10; ++i)
      runs.otherTemplates()[i].inlier = false;
    const RecordComparison found = runs.compared();
    EXPECT_EQ(found.iterations[0].inliers_either, 10);
    EXPECT_EQ(found.iterations[0].inliers_both, common);
    EXPECT_EQ(found.beyond.size(), common < 7 ? 1u : 0u) << common;
    runs.run.iterations[0].templates->front().inlier = false;
    runs.otherTemplates().front().inlier = false;
    EXPECT_THAT(runs.compared().beyond, IsEmpty()) << "nine inliers say little";
  }
}

TEST(CompareRecords, Templates_CountWhereBothSearchedAtOnePlace) {
  TwoRuns runs(20);
  auto& other = runs.otherTemplates();
  other[0].searched = false;
  ++other[1].x;
  ++other[2].y;
  (*runs.run.iterations[0].templates)[3].searched = false;
  other[4].found_x += 1.0F;  // at the limit
  other[5].inlier = false;
  other[15].inlier = true;
  const IterationComparison found = runs.compared().iterations.at(0);
  EXPECT_EQ(found.templates, 16);
  EXPECT_EQ(found.found_alike, 16);
  EXPECT_EQ(found.inliers_either, 7);
  EXPECT_EQ(found.inliers_both, 5);
}

TEST(CompareRecords, OtherStart_ExcusesOtherTemplates) {
  TwoRuns runs(20);
  for (RecordedTemplate& item : runs.otherTemplates()) item.found_x += 9.0F;
  EXPECT_THAT(runs.compared().beyond, ElementsAre(HasSubstr("only 0 % of")));
  runs.other.iterations[0].trace.camera_from_station_before.translation_m.x() += 1e-3;
  EXPECT_THAT(runs.compared().beyond, IsEmpty());
}

TEST(CompareRecords, DistanceOfPoses_IsInMillimetresMilliradiansAndSigmas) {
  Random random = randomFor("CompareRecords.Distance");
  const Vector6d sigma = (Vector6d() << 1e-3, 2e-3, 3e-3, 1e-4, 2e-4, 3e-4).finished();
  const Vector6d xi = (Vector6d() << 3e-3, 0.0, -4e-3, 1e-3, 2e-3, -2e-3).finished();
  TwoRuns runs(1);
  runs.run.end->covariance = sigma.cwiseAbs2().asDiagonal();
  runs.run.end->camera_from_station = randomPose(random);
  runs.run.iterations[0].trace.camera_from_station = randomPose(random);
  runs.other.end->camera_from_station = perturbed(xi, runs.run.end->camera_from_station);
  runs.other.iterations[0].trace.camera_from_station =
      perturbed(2.0 * xi, runs.run.iterations[0].trace.camera_from_station);
  RecordComparison found = runs.compared();
  EXPECT_NEAR(found.rotation_mrad, 5.0, 1e-9);
  EXPECT_NEAR(found.translation_mm, 3.0, 1e-9);
  EXPECT_NEAR(found.iterations[0].rotation_mrad, 10.0, 1e-9);
  EXPECT_NEAR(found.iterations[0].translation_mm, 6.0, 1e-9);
  EXPECT_NEAR(found.pose_sigmas.value(), (xi.array() / sigma.array()).matrix().norm() / sqrt(6.0),
              1e-9);
  for (const double sigmas : {2.9, 3.1}) {
    runs.other.end->camera_from_station =
        perturbed(sigmas * sigma, runs.run.end->camera_from_station);
    found = runs.compared();
    EXPECT_NEAR(found.pose_sigmas.value(), sigmas, 1e-6);
    EXPECT_EQ(found.beyond.empty(), sigmas < 3.0);
  }
}

TEST(CompareRecords, PoseThatASymmetryMakesTheSame_IsNotApart) {
  Random random = randomFor("CompareRecords.Symmetry");
  const Pose half_turn{Eigen::Quaterniond(0.0, 0.0, 0.0, 1.0), Eigen::Vector3d::Zero()};
  TwoRuns runs(1);
  runs.run.end->camera_from_station = randomPose(random);
  runs.other.end->camera_from_station = runs.run.end->camera_from_station * half_turn;
  RecordComparison found = compareRecords(runs.run, runs.other);
  EXPECT_NEAR(found.rotation_mrad, 3141.6, 0.1);
  EXPECT_FALSE(found.by_symmetry);
  ComparisonLimits limits;
  limits.equivalent = [&](const Pose& pose, const Pose&) { return pose * half_turn; };
  found = compareRecords(runs.run, runs.other, limits);
  EXPECT_NEAR(found.rotation_mrad, 0.0, 1e-9);
  EXPECT_LT(found.pose_sigmas.value_or(1.0), 1e-6);
  EXPECT_THAT(comparisonText(found), HasSubstr("by the declared symmetries"));
}

TEST(CompareRecords, Sigmas_NeedTwoPosesAndAUsableCovariance) {
  const auto sigmas = [](void (*make)(TwoRuns&)) {
    TwoRuns runs(1);
    runs.other.end->camera_from_station.translation_m.x() = 1.0;
    make(runs);
    return compareRecords(runs.run, runs.other).pose_sigmas;
  };
  EXPECT_NEAR(sigmas([](TwoRuns&) {}).value(), 1.0 / sqrt(6.0), 1e-12);
  EXPECT_FALSE(sigmas([](TwoRuns& runs) { runs.run.end->covariance.setZero(); }));
  EXPECT_FALSE(sigmas([](TwoRuns& runs) { runs.run.end->covariance(2, 2) = NAN; }));
  EXPECT_FALSE(sigmas([](TwoRuns& runs) { runs.run.end->covariance(3, 3) = -1.0; }));
  EXPECT_FALSE(sigmas([](TwoRuns& runs) { runs.run.end->status = LocalizationStatus::kBlurred; }));
  EXPECT_FALSE(
      sigmas([](TwoRuns& runs) { runs.other.end->status = LocalizationStatus::kBlurred; }));
  EXPECT_EQ(sigmas([](TwoRuns& runs) { runs.other.end->camera_from_station = Pose(); }), 0.0);
}

TEST(CompareRecords, OtherPixels_ExcuseNeitherOtherInputsNorAnotherEnd) {
  TwoRuns runs(1);
  EXPECT_THAT(runs.compared().beyond, IsEmpty());
  runs.other.end->status = LocalizationStatus::kBlurred;
  EXPECT_THAT(runs.compared().beyond, ElementsAre("the runs ended as converged and blurred"));
  runs = TwoRuns(1);
  runs.other.inputs->sha256.scene[0] = 1;
  EXPECT_THAT(runs.compared().beyond,
              ElementsAre("inputs other than the pixels differ: the meshes differ"));
  for (const auto side : {&RecordedInputs::width, &RecordedInputs::height}) {
    runs.other.inputs->width = runs.other.inputs->height = 0;
    (*runs.other.inputs).*side = 9;
    EXPECT_THAT(runs.compared().beyond, Contains("the images are of different sizes"));
  }
}

TEST(CompareRecords, Text_HasVerdictFirstDifferenceTableAndDistance) {
  TwoRuns runs(20);
  runs.other.end->camera_from_station.translation_m.x() = 2.0;
  const std::string text = comparisonText(runs.compared());
  EXPECT_THAT(text, StartsWith("different, but within the limits\n"
                               "first difference: pixels: the pixels differ\n"));
  EXPECT_THAT(text, testing::ContainsRegex("\n *1 +20 +20 +10 +10 +0\\.000 +0\\.000 *\n"));
  EXPECT_THAT(text,
              testing::EndsWith("final poses: 2000.000 mm and 0.000 mrad apart, 0.816 sigmas\n"));
  runs.run.end->covariance.setZero();
  EXPECT_THAT(comparisonText(runs.compared()), testing::EndsWith("0.000 mrad apart\n"));
  runs.other.end->status = LocalizationStatus::kBlurred;
  EXPECT_THAT(comparisonText(runs.compared()),
              AllOf(StartsWith("different\n"),
                    HasSubstr("\nbeyond limits: the runs ended as converged and blurred\n")));
  EXPECT_EQ(comparisonText(compareRecords(runs.run, runs.run)), "equal to the bit\n");
  OnboardRecord cut = runs.run;
  cut.missing = {"the end"};
  cut.end.reset();
  EXPECT_THAT(comparisonText(compareRecords(runs.run, cut)),
              StartsWith("equal to the bit as far as the records reach\n"
                         "missing: second: the end\n"));
}

/// A digest that neither record has shows nothing.
TEST(CompareRecords, EmptyDigests_AreNotTheSameDigest) {
  TwoRuns runs(1);
  runs.other = runs.run;
  runs.other.missing = {"a part"};
  EXPECT_EQ(compareRecords(runs.run, runs.other).verdict, RunVerdict::kEqual);
  runs.run.end->digest = runs.other.end->digest = "";
  EXPECT_EQ(compareRecords(runs.run, runs.other).verdict, RunVerdict::kWithinLimits);
  runs.other.missing.clear();
  EXPECT_EQ(compareRecords(runs.run, runs.other).verdict, RunVerdict::kEqual);
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
