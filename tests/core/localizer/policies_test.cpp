// SPDX-License-Identifier: Apache-2.0
#include "core/localizer/acceptance.h"

#include <array>
#include <vector>

#include <gtest/gtest.h>

#include "core/localizer/attempt.h"
#include "core/localizer/pass_plan.h"
#include "core/localizer/pose_comparison.h"
#include "core/localizer/workspace.h"
#include "tests/support/random_pose.h"

namespace boresight {
namespace {

/// Replaces a pass: fills in the fields of a record that a policy reads, without an image.
class ScriptedPass {
 public:
  RunContext context() const {
    return {options, camera_, scene_, levels_, end_effector_in_camera_m_};
  }

  /// The record of a match pass that found a pose.
  Agreement match(const PassPlan& plan, const Pose& found, int inliers, int matches = 90) {
    Iteration& record = start(plan, IterationKind::kMatch, Stage::kPose);
    record.correspondence_count = 0;
    record.pnp.camera_from_station = found;
    record.pnp.covariance = Matrix6d::Identity() * 1e-8;
    record.pnp.inlier_count = inliers;
    return {inliers, matches};
  }
  /// The record of a match pass that failed.
  Agreement fail(const PassPlan& plan, Stage stage, LocalizationStatus status) {
    Iteration& record = start(plan, IterationKind::kMatch, stage);
    record.status = status;
    record.pnp.inlier_count = 0;
    record.pnp.camera_from_station = plan.camera_from_station;
    return {};
  }
  /// The record of a refinement that found a pose.
  void refine(const PassPlan& plan, const Pose& found) {
    Iteration& record = start(plan, IterationKind::kRefine, Stage::kRefine);
    record.refinement.camera_from_station = found;
    record.refinement.covariance = Matrix6d::Identity() * 1e-10;
  }

  LocalizerOptions options;
  std::array<Iteration, 2> records;
  PassOutcome outcome;

 private:
  Iteration& start(const PassPlan& plan, IterationKind kind, Stage reached) {
    outcome = {};
    outcome.reached = reached;
    Iteration& record = records[static_cast<std::size_t>(plan.record)];
    record.kind = kind;
    record.attempt = plan.attempt;
    record.level = plan.level;
    record.threshold_px = plan.threshold_px;
    record.camera_from_station_before = plan.camera_from_station;
    record.uncertainty = plan.uncertainty;
    record.status = LocalizationStatus::kRunning;
    return record;
  }

  Eigen::Vector3d end_effector_in_camera_m_ = Eigen::Vector3d::Zero();
  const Camera camera_ = test::makePinhole(2048, 2048, 3000.0);
  const BoundingBox scene_{Eigen::Vector3d::Constant(-0.05), Eigen::Vector3d::Constant(0.05)};
  const RunLevels levels_ = levelsOf({2048, 2048, 8, 12, 1}, options);
};

/// A seed half a metre in front of the camera, with the default uncertainty about the camera.
Seed seedInFront() {
  Seed seed;
  seed.camera_from_station.translation_m = {0.0, 0.0, 0.5};
  return seed;
}

Pose movedBy(Pose pose, double x_m) {
  pose.translation_m.x() += x_m;
  return pose;
}

/// Poses 20 mm off lie within the uncertainty, those 200 mm off beyond it.
TEST(Acceptance, CompetingPose_IsAmbiguousByItsPlaceAndMargin) {
  const auto judged = [](std::span<const CompetingPose> poses, double probability) {
    return judgeCompetingPoses(poses, probability, seedInFront(), defaultProfile());
  };
  EXPECT_EQ(judged({}, 0.3), LocalizationStatus::kConverged);
  const struct {
    double x_m, margin_nats, probability;
    bool mirrored;
    LocalizationStatus expected;
  } cases[] = {{0.02, -10.0, 0.9, false, LocalizationStatus::kAmbiguous},
               {0.02, 2.0, 0.9, false, LocalizationStatus::kAmbiguous},
               {0.02, 4.0, 0.9, false, LocalizationStatus::kConverged},
               {0.2, -9.0, 0.5, false, LocalizationStatus::kConverged},
               {0.2, -9.4, 0.9, false, LocalizationStatus::kAmbiguous},
               {0.2, -1.0, 0.4, false, LocalizationStatus::kConverged},
               {0.2, -3.0, 0.49, false, LocalizationStatus::kAmbiguous},
               {0.0, 100.0, 0.9, true, LocalizationStatus::kAmbiguous}};
  for (const auto& [x_m, margin_nats, probability, mirrored, expected] : cases) {
    CompetingPose pose{movedBy(seedInFront().camera_from_station, x_m), 0.9, margin_nats};
    pose.mirrored = mirrored;
    EXPECT_EQ(judged({&pose, 1}, probability), expected)
        << x_m << " m, " << margin_nats << " nats, probability " << probability;
  }
}

TEST(Acceptance, DoubtfulPose_IsComparedWithMoreThanAProbableOne) {
  using Kinds = std::vector<PassKind>;
  const auto kinds = [](double probability, double x_m) {
    const Pose pose = movedBy(seedInFront().camera_from_station, x_m);
    Kinds all = {PassKind::kCompare};
    while (const auto next = comparisonAfter(all.back(), probability, seedInFront(), pose)) {
      all.push_back(*next);
      if (all.size() > 5) break;
    }
    return all;
  };
  const double outside_m = 1.01 * seedInFront().uncertainty.translation_m.x();
  EXPECT_EQ(kinds(0.9, 0.0), Kinds({PassKind::kCompare}));
  EXPECT_EQ(kinds(0.89, 0.0), Kinds({PassKind::kCompare, PassKind::kMirror, PassKind::kWider}));
  EXPECT_EQ(kinds(0.99, outside_m), Kinds({PassKind::kCompare, PassKind::kWider}));
  EXPECT_EQ(kinds(0.5, outside_m), kinds(0.89, 0.0));
}

TEST(Acceptance, EachRequirementThatFails_IsTheReason) {
  Workspace measured;
  measured.probability = 0.9;
  LocalizerOptions options = defaultProfile();
  const auto judged = [&] { return judgeSupport(measured, options, true); };
  EXPECT_EQ(judged(), LocalizationStatus::kConverged);
  measured.gap = 0.09;
  EXPECT_EQ(judgeGap(measured, options), LocalizationStatus::kConverged) << "no other pose";
  measured.competitor = 1;
  EXPECT_EQ(judgeGap(measured, options), LocalizationStatus::kAmbiguous);
  measured.gap = 0.5;
  EXPECT_EQ(judgeGap(measured, options), LocalizationStatus::kConverged);
  measured.focal = {0.05, 0.001, true};
  EXPECT_EQ(judged(), LocalizationStatus::kCameraMismatch);
  measured.edge_width.width_px.fill(15.0);
  measured.edge_width.places.fill(1000);
  EXPECT_EQ(judged(), LocalizationStatus::kBlurred);
  measured.probability = 0.1;
  EXPECT_EQ(judged(), LocalizationStatus::kNotSupported);
  options.support.gate = false;
  EXPECT_EQ(judged(), LocalizationStatus::kConverged);
}

/// Without a search only edge support counts.
TEST(Acceptance, WithoutASearch_RestsOnEdgeSupport) {
  Workspace measured;
  EXPECT_EQ(judgeSupport(measured, defaultProfile(), false), LocalizationStatus::kNotSupported);
  measured.support.rendered = measured.support.covered = 100;
  measured.support.seen = measured.support.explained = 100;
  EXPECT_EQ(judgeSupport(measured, defaultProfile(), false), LocalizationStatus::kConverged);
}

using ComparisonNext = PoseComparison::Next;

class PoseComparisonTest : public testing::Test {
 protected:
  /// Candidates 10 mm apart, 60 px in the image.
  void offer(int count, double error_px = 1.0) {
    for (int i = 0; i < count; ++i) {
      PoseCandidate candidate;
      candidate.camera_from_station = movedBy(seed.camera_from_station, 0.01 * i - 0.02);
      candidate.error_px = error_px;
      candidates.push_back(candidate);
    }
    comparison = PoseComparison(candidates, seed);
  }
  PassPlan planOf(const Attempt& attempt) const { return attempt.plan(pass.context()); }
  /// The attempt has converged where it started.
  ComparisonNext take(const Attempt& attempt, double score, double probability = 0.9,
                      bool has_weak = false) {
    PoseHypothesis measured;
    measured.score = score;
    measured.probability = probability;
    WeakDirections weak;
    weak.known = has_weak;
    weak.offset_per_px[0][3] = 1e-4;
    weak.offset_per_px[1][0] = 1e-3;
    weak.pivot_in_camera_m = attempt.camera_from_station() * Eigen::Vector3d::Zero();
    return comparison.takePose(attempt, attempt.camera_from_station(), measured, weak, edges,
                               pass.context());
  }

  ScriptedPass pass;
  const Seed seed = seedInFront();
  std::vector<PoseCandidate> candidates;
  EdgePlaces edges;
  PoseComparison comparison;
};

TEST_F(PoseComparisonTest, EveryCandidate_IsRefinedAndTheBestReturns) {
  offer(3);
  const double scores[] = {2.0, 5.0, 4.0};
  for (int i = 0; i < 3; ++i) {
    const Attempt attempt = comparison.next(i, pass.context());
    EXPECT_EQ(planOf(attempt).kind, PassKind::kRefine);
    EXPECT_EQ(attempt.camera_from_station(),
              candidates[static_cast<std::size_t>(i)].camera_from_station);
    EXPECT_EQ(take(attempt, scores[i]), i < 2 ? ComparisonNext::kTry : ComparisonNext::kReturn);
  }
  EXPECT_EQ(comparison.bestIndex(), 1);
  EXPECT_EQ(comparison.competitorIndex(pass.context()), 2);
  EXPECT_NEAR(comparison.gap(pass.context()), 1.0, 1e-12);
  const Attempt back = comparison.best(3, pass.options);
  EXPECT_EQ(back.index(), 3);
  EXPECT_EQ(back.camera_from_station(), candidates[1].camera_from_station);
  EXPECT_EQ(comparison.takeFailure(pass.context()), ComparisonNext::kConclude);
}

TEST_F(PoseComparisonTest, CandidateOutOfReach_IsMatchedThenRefinedFromTheCoarseLevelOn) {
  offer(1, 20.0);
  const Attempt matched = comparison.next(0, pass.context());
  EXPECT_EQ(planOf(matched).kind, PassKind::kMatch);
  EXPECT_EQ(matched.camera_from_station(), candidates[0].camera_from_station);
  const SeedUncertainty box =
      uncertaintyAbout(candidates[0].camera_from_station, seed, pass.context().scene);
  for (int i = 0; i < 3; ++i) {
    EXPECT_LE(box.rotation_rad[i], seed.uncertainty.rotation_rad[i]);
    EXPECT_EQ(planOf(matched).uncertainty.rotation_rad[i], box.rotation_rad[i]);
  }
  EXPECT_EQ(comparison.takeFailure(pass.context()), ComparisonNext::kTry);
  Attempt direct = comparison.next(1, pass.context());
  const PassPlan coarse = planOf(direct);
  EXPECT_EQ(coarse.kind, PassKind::kRefine);
  EXPECT_EQ(coarse.level, pass.context().levels.coarse);
  pass.refine(coarse, coarse.camera_from_station);
  (void)direct.take(pass.outcome, {}, pass.context(), pass.records);
  const PassPlan fine = planOf(direct);
  EXPECT_EQ(fine.kind, PassKind::kRefine);
  EXPECT_EQ(fine.level, pass.context().levels.fine);
  EXPECT_EQ(coarse.threshold_px, fine.threshold_px * (1 << (coarse.level - fine.level)));
  EXPECT_EQ(take(direct, 3.0), ComparisonNext::kReturn);
}

TEST_F(PoseComparisonTest, SeedIsTried_WithoutAProbableCandidate) {
  offer(0);
  const Attempt only = comparison.next(0, pass.context());
  EXPECT_EQ(only.camera_from_station(), seed.camera_from_station);
  EXPECT_EQ(planOf(only).kind, PassKind::kMatch);
  EXPECT_EQ(comparison.takeFailure(pass.context()), ComparisonNext::kConclude);
  offer(1);
  EXPECT_EQ(take(comparison.next(0, pass.context()), 1.0, 0.29), ComparisonNext::kTry);
  const Attempt attempt = comparison.next(1, pass.context());
  EXPECT_EQ(attempt.camera_from_station(), seed.camera_from_station);
  EXPECT_EQ(take(attempt, 0.5, 0.2), ComparisonNext::kReturn);
  EXPECT_EQ(comparison.hypotheses()[1].origin, HypothesisOrigin::kSeed);
}

TEST_F(PoseComparisonTest, NearSeed_IsTakenIfItConvincesAndSearchedForOtherwise) {
  offer(1);
  comparison = PoseComparison::ofNearSeed(candidates, seed);
  const Attempt attempt = comparison.next(0, pass.context());
  EXPECT_EQ(planOf(attempt).kind, PassKind::kRefine);
  EXPECT_EQ(planOf(attempt).most_samples, 0) << "the final attempt, not a draft";
  EXPECT_EQ(attempt.camera_from_station(), candidates[0].camera_from_station);
  EXPECT_TRUE(comparison.returns());
  const Pose& pose = attempt.camera_from_station();
  EXPECT_TRUE(comparison.convinces(pose, 0.95));
  EXPECT_FALSE(comparison.convinces(pose, 0.8));
  EXPECT_FALSE(comparison.convinces(movedBy(seed.camera_from_station, 0.031), 0.95))
      << "beyond the stated 30 mm";
  EXPECT_EQ(comparison.takeFailure(pass.context()), ComparisonNext::kSearch);
  comparison = PoseComparison(candidates, seed);
  EXPECT_TRUE(comparison.convinces(pose, 0.1)) << "after a search";

  comparison = PoseComparison::ofNearSeed({}, seed);
  const PassPlan alone = planOf(comparison.next(0, pass.context()));
  EXPECT_EQ(alone.kind, PassKind::kRefine);
  EXPECT_EQ(alone.level, pass.context().levels.coarse) << "without a candidate";
  EXPECT_EQ(alone.camera_from_station, seed.camera_from_station);
}

TEST_F(PoseComparisonTest, FirstCandidate_IsRestartedAndReturnsIfItConvinces) {
  offer(1);
  comparison = PoseComparison::ofFirst(candidates, seed);
  EXPECT_EQ(take(comparison.next(0, pass.context()), 5.0, 0.95, true), ComparisonNext::kTry);
  for (int i = 1; i <= PoseComparison::kRestarts; ++i) {
    (void)comparison.next(i, pass.context());
    EXPECT_EQ(comparison.takeFailure(pass.context()),
              i < PoseComparison::kRestarts ? ComparisonNext::kTry : ComparisonNext::kReturn);
  }
  const Pose back = comparison.best(5, pass.options).camera_from_station();
  EXPECT_TRUE(comparison.convinces(back, 0.95));
  EXPECT_FALSE(comparison.convinces(back, 0.8));
  EXPECT_EQ(comparison.takeFailure(pass.context()), ComparisonNext::kSearch)
      << "the final pose was not accepted";

  comparison = PoseComparison::ofFirst(candidates, seed);
  const Attempt doubtful = comparison.next(0, pass.context());
  EXPECT_EQ(planOf(doubtful).kind, PassKind::kRefine);
  EXPECT_NE(planOf(doubtful).most_samples, 0) << "a draft";
  EXPECT_EQ(take(doubtful, 5.0, 0.8, true), ComparisonNext::kSearch) << "without restarts";
}

/// 6 mm are 36 px of the 600 px that the object spans.
TEST_F(PoseComparisonTest, NearSeed_IsOneWhoseBoxMovesTheSceneByLessThanATenthOfItsSize) {
  Seed stated = seed;
  stated.uncertainty.pivot_in_camera_m = {0.0, 0.0, 0.5};
  stated.uncertainty.rotation_rad.setZero();
  const auto isNearWithin = [&](double x_m, double y_m) {
    stated.uncertainty.translation_m = {x_m, y_m, 0.0};
    return isNear(stated, pass.context());
  };
  EXPECT_TRUE(isNearWithin(0.006, 0.006));
  EXPECT_FALSE(isNearWithin(0.009, 0.009));
  EXPECT_TRUE(isNearWithin(0.009, 0.0));
  EXPECT_FALSE(isNear(seed, pass.context())) << "30 mm and 5 deg";
}

/// To both sides of both directions, by the same motion in the image.
TEST_F(PoseComparisonTest, BestPose_RestartsAlongItsWeakDirections) {
  offer(2);
  EXPECT_EQ(take(comparison.next(0, pass.context()), 5.0, 0.9, true), ComparisonNext::kTry);
  EXPECT_EQ(take(comparison.next(1, pass.context()), 1.0, 0.9, true), ComparisonNext::kTry);
  std::vector<Pose> starts;
  for (int i = 0; i < PoseComparison::kRestarts; ++i) {
    const Attempt attempt = comparison.next(2 + i, pass.context());
    EXPECT_EQ(planOf(attempt).level, pass.context().levels.coarse);
    starts.push_back(attempt.camera_from_station());
    EXPECT_EQ(comparison.takeFailure(pass.context()),
              i + 1 < PoseComparison::kRestarts ? ComparisonNext::kTry : ComparisonNext::kReturn);
  }
  const double motion_px = 7.0 * (1 << pass.context().levels.fine);
  const double x_m = candidates[0].camera_from_station.translation_m.x();
  EXPECT_NEAR(starts[0].translation_m.x(), x_m + 1e-4 * motion_px, 1e-9);
  EXPECT_NEAR(starts[1].translation_m.x(), x_m - 1e-4 * motion_px, 1e-9);
  EXPECT_NEAR(starts[2].rotation.angularDistance(starts[3].rotation), 2e-3 * motion_px, 1e-6);
}

TEST_F(PoseComparisonTest, KnownPose_IsOneWithinAPixelOfTheLevel) {
  offer(2);
  const Attempt attempt = comparison.next(0, pass.context());
  EXPECT_FALSE(comparison.isKnown(attempt.camera_from_station(), 1, pass.context()));
  (void)take(attempt, 1.0);
  // 0.1 mm are 0.6 px of the image.
  const Pose near = movedBy(attempt.camera_from_station(), 0.0001);
  EXPECT_TRUE(comparison.isKnown(near, 1, pass.context()));
  EXPECT_FALSE(comparison.isKnown(movedBy(near, 0.0002), 1, pass.context()));
  EXPECT_TRUE(comparison.isKnown(movedBy(near, 0.0002), 2, pass.context()));
}

/// 3 % of the 600 px that the object's box spans are 18 px.
TEST_F(PoseComparisonTest, PosesNearTheBestOne_AreNotItsCompetitors) {
  offer(1);
  (void)take(comparison.next(0, pass.context()), 5.0, 0.3);
  const Attempt near(1, {movedBy(candidates[0].camera_from_station, 0.001), seed.uncertainty});
  (void)take(near, 4.9);
  EXPECT_EQ(comparison.competitorIndex(pass.context()), -1);
  EXPECT_EQ(comparison.gap(pass.context()), 0.0);
  const Attempt apart(2, {movedBy(candidates[0].camera_from_station, 0.005), seed.uncertainty});
  (void)take(apart, -1.0);
  EXPECT_EQ(comparison.competitorIndex(pass.context()), 2);
  EXPECT_NEAR(comparison.gap(pass.context()), 6.0, 1e-12) << "scores may be negative";
}

/// All edges run along x: a motion along them shows nothing, however far it is.
TEST_F(PoseComparisonTest, PosesThatDifferAlongTheEdges_AreNotCompetitors) {
  std::array<EdgeSample, 200> samples;
  for (std::size_t i = 0; i < samples.size(); ++i) {
    samples[i].point_in_station_m = {4e-4 * static_cast<double>(i) - 0.04, i % 2 ? 0.02 : -0.02,
                                     0.0};
    samples[i].normal_y = 127;
  }
  RefinementResult refined;
  offer(1);
  refined.camera_from_station = candidates[0].camera_from_station;
  refined.samples = samples;
  refined.sample_count = static_cast<std::int32_t>(samples.size());
  edges = EdgePlaces(refined, pass.context().camera);
  (void)take(comparison.next(0, pass.context()), 5.0, 0.3);
  const Pose& best = candidates[0].camera_from_station;
  (void)take(Attempt(1, {movedBy(best, 0.01), seed.uncertainty}), 4.9);
  EXPECT_EQ(comparison.competitorIndex(pass.context()), -1);
  Pose across = best;
  across.translation_m.y() += 0.004;  // 24 px; the object is 600 px long
  (void)take(Attempt(2, {across, seed.uncertainty}), 4.8);
  EXPECT_EQ(comparison.competitorIndex(pass.context()), 2);
  EXPECT_NEAR(comparison.gap(pass.context()), 0.2, 1e-12);
}

class AttemptTest : public testing::Test {
 protected:
  Ruling takeMatch(const Pose& pose, int inliers) {
    const Agreement agreement = pass.match(attempt.plan(pass.context()), pose, inliers);
    return attempt.take(pass.outcome, agreement, pass.context(), pass.records);
  }
  Ruling takeRefinement(const Pose& pose) {
    pass.refine(attempt.plan(pass.context()), pose);
    return attempt.take(pass.outcome, {}, pass.context(), pass.records);
  }

  ScriptedPass pass;
  const Seed seed = seedInFront();
  const Pose found = movedBy(seed.camera_from_station, 0.01);
  Attempt attempt{0, seed};
};

TEST_F(AttemptTest, UnconvincingHypotheses_KeepTheOneWithMostInliers) {
  const int inliers[] = {10, 30, 20};
  Ruling ruling;
  int tried = 0;
  for (; !ruling.iteration_complete; ++tried) {
    ASSERT_LT(tried, 3);
    ruling = takeMatch(movedBy(found, 0.001 * tried), inliers[tried]);
  }
  EXPECT_EQ(tried, rolledHypotheses(pass.options, seed.uncertainty));
  const Iteration& shown = pass.records[static_cast<std::size_t>(ruling.record)];
  EXPECT_EQ(shown.chosen_hypothesis, 1);
  EXPECT_EQ(shown.hypothesis_count, tried);
  EXPECT_EQ(shown.hypotheses[2].inliers, 20);
  EXPECT_NEAR(shown.correction_translation_m, 0.011, 1e-12);
  EXPECT_EQ(attempt.camera_from_station(), movedBy(found, 0.001));
}

TEST_F(AttemptTest, HypothesisAfterABetterOne_FillsTheOtherRecord) {
  (void)takeMatch(found, 30);
  EXPECT_EQ(attempt.plan(pass.context()).record, 1);
  (void)takeMatch(found, 10);  // worse: its record is free again
  EXPECT_EQ(attempt.plan(pass.context()).record, 1);
}

TEST_F(AttemptTest, SmallCorrectionsInARow_Converge) {
  (void)takeMatch(found, 80);
  (void)takeMatch(found, 80);
  EXPECT_EQ(attempt.plan(pass.context()).kind, PassKind::kRefine);
  Ruling ruling;
  int refinements = 0;
  for (; ruling.next == Ruling::Next::kPass; ++refinements) {  // the first by 12 px: not small
    ASSERT_LT(refinements, 10);
    ruling = takeRefinement(movedBy(found, 0.002));
  }
  EXPECT_TRUE(ruling.found());
  EXPECT_EQ(refinements, 1 + pass.options.loop.converged_iterations);
  EXPECT_EQ(attempt.covariance(), Matrix6d(Matrix6d::Identity() * 1e-10));
}

TEST_F(AttemptTest, PoseBeyondTheUncertainty_IsPulledBackWhenMatchedAndFailsWhenRefined) {
  (void)takeMatch(movedBy(seed.camera_from_station, 0.05), 80);
  EXPECT_NEAR(attempt.camera_from_station().translation_m.x(), 0.03, 1e-12);
  (void)takeMatch(found, 80);
  const Ruling ruling = takeRefinement(movedBy(seed.camera_from_station, 0.046));  // of 0.045
  EXPECT_TRUE(ruling.failed());
  EXPECT_EQ(ruling.status, LocalizationStatus::kLeftUncertainty);
}

TEST_F(AttemptTest, FailedHypotheses_FailWithTheReasonOfTheKeptOneAndMayRestart) {
  Ruling ruling;
  while (ruling.next == Ruling::Next::kPass) {
    const Agreement none = pass.fail(attempt.plan(pass.context()), Stage::kTemplates,
                                     LocalizationStatus::kTooFewTemplates);
    ruling = attempt.take(pass.outcome, none, pass.context(), pass.records);
  }
  EXPECT_EQ(ruling.status, LocalizationStatus::kTooFewTemplates);
  EXPECT_EQ(ruling.stage, Stage::kTemplates);

  attempt.restart();  // from the seed with larger templates
  const PassPlan plan = attempt.plan(pass.context());
  EXPECT_EQ(plan.attempt, 1);
  EXPECT_EQ(plan.camera_from_station, seed.camera_from_station);
  EXPECT_EQ(plan.template_factor, 2.0);
  EXPECT_EQ(plan.level, pass.context().levels.coarse);
}

}  // namespace
}  // namespace boresight
