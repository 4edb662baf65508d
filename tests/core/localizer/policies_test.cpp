// SPDX-License-Identifier: Apache-2.0
#include "core/localizer/acceptance.h"

#include <array>
#include <vector>

#include <gtest/gtest.h>

#include "core/localizer/attempt.h"
#include "core/localizer/candidate_trials.h"
#include "core/localizer/pass_plan.h"
#include "core/localizer/workspace.h"

namespace boresight {
namespace {

/// Replaces a pass: fills in the fields of a record that a policy reads, without an image.
class ScriptedPass {
 public:
  ScriptedPass() {
    camera_.width = camera_.height = 2048;
    camera_.fx = camera_.fy = 3000.0;
    camera_.cx = camera_.cy = 1023.5;
    EXPECT_EQ(prepareCamera(camera_), Status::kOk);
    scene_.minimum_m = {-0.05, -0.05, -0.05};
    scene_.maximum_m = {0.05, 0.05, 0.05};
    ProblemSize size;
    size.width = size.height = 2048;
    levels_ = levelsOf(size, options);
  }

  RunContext context() const { return {options, camera_, scene_, levels_, end_effector_in_camera_m_}; }

  /// The record of a match pass that found a pose.
  Agreement match(const PassPlan& plan, const Pose& found, int inliers, int matches = 90) {
    Iteration& record = start(plan, IterationKind::kMatch);
    record.correspondence_count = 0;
    record.pnp.camera_from_station = found;
    record.pnp.covariance = Matrix6d::Identity() * 1e-8;
    record.pnp.inlier_count = inliers;
    outcome = {};
    outcome.reached = Stage::kPose;
    return {inliers, matches};
  }
  /// The record of a match pass that failed.
  Agreement fail(const PassPlan& plan, Stage stage, LocalizationStatus status) {
    Iteration& record = start(plan, IterationKind::kMatch);
    record.status = status;
    record.pnp.inlier_count = 0;
    record.pnp.camera_from_station = plan.camera_from_station;
    outcome = {};
    outcome.reached = stage;
    return {};
  }
  /// The record of a refinement that found a pose.
  void refine(const PassPlan& plan, const Pose& found) {
    Iteration& record = start(plan, IterationKind::kRefine);
    record.refinement.camera_from_station = found;
    record.refinement.covariance = Matrix6d::Identity() * 1e-10;
    outcome = {};
    outcome.reached = Stage::kRefine;
  }

  LocalizerOptions options;
  std::array<Iteration, 2> records;
  PassOutcome outcome;

 private:
  Iteration& start(const PassPlan& plan, IterationKind kind) {
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
  Camera camera_;
  BoundingBox scene_;
  RunLevels levels_;
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

CompetingPose competingAt(double x_m, double margin_nats) {
  return {movedBy(seedInFront().camera_from_station, x_m), 0.9, margin_nats};
}

TEST(Acceptance, CompetingPoseWithinTheUncertainty_IsAmbiguousUnlessThePoseHasMoreEvidence) {
  for (const double margin_nats : {-10.0, 2.0, 4.0}) {
    const CompetingPose pose = competingAt(0.02, margin_nats);
    EXPECT_EQ(judgeCompetingPoses(std::span(&pose, 1), seedInFront(), defaultProfile()),
              margin_nats < 3.0 ? LocalizationStatus::kAmbiguous : LocalizationStatus::kConverged);
  }
  EXPECT_EQ(judgeCompetingPoses({}, seedInFront(), defaultProfile()),
            LocalizationStatus::kConverged);
}

TEST(Acceptance, CompetingPoseOutsideTheUncertainty_IsAmbiguousOnlyWhereItIsBetter) {
  for (const double margin_nats : {-1.0, -3.0}) {
    const CompetingPose pose = competingAt(0.2, margin_nats);
    EXPECT_EQ(judgeCompetingPoses(std::span(&pose, 1), seedInFront(), defaultProfile()),
              margin_nats < -2.0 ? LocalizationStatus::kAmbiguous : LocalizationStatus::kConverged);
  }
}

TEST(Acceptance, EachRequirementThatFails_IsTheReason) {
  Workspace measured;
  measured.probability = 0.9;
  const Seed seed = seedInFront();
  const LocalizerOptions options = defaultProfile();
  const auto judged = [&](const Pose& pose) {
    return judgeSupport(measured, seed, pose, options, true);
  };
  const Pose& right = seed.camera_from_station;
  EXPECT_EQ(judged(right), LocalizationStatus::kConverged);
  EXPECT_EQ(judged(movedBy(right, 0.2)), LocalizationStatus::kLeftUncertainty);
  measured.focal = {0.05, 0.001, true};
  EXPECT_EQ(judged(right), LocalizationStatus::kCameraMismatch);
  measured.edge_width.width_px.fill(15.0);
  measured.edge_width.places.fill(1000);
  EXPECT_EQ(judged(right), LocalizationStatus::kBlurred);
  measured.probability = 0.1;
  EXPECT_EQ(judged(right), LocalizationStatus::kNotSupported);
  LocalizerOptions ungated = options;
  ungated.support.gate = false;
  EXPECT_EQ(judgeSupport(measured, seed, right, ungated, true), LocalizationStatus::kConverged);
}

/// Without a search only edge support counts.
TEST(Acceptance, WithoutASearch_RestsOnEdgeSupport) {
  Workspace measured;
  const Seed seed = seedInFront();
  EXPECT_EQ(judgeSupport(measured, seed, seed.camera_from_station, defaultProfile(), false),
            LocalizationStatus::kNotSupported);
  measured.support.rendered = measured.support.covered = 100;
  measured.support.seen = measured.support.explained = 100;
  EXPECT_EQ(judgeSupport(measured, seed, seed.camera_from_station, defaultProfile(), false),
            LocalizationStatus::kConverged);
}

using TrialNext = CandidateTrials::Next;

class CandidateTrialsTest : public testing::Test {
 protected:
  /// Candidates 1 mm apart, each with a little less evidence than the one before.
  void offer(int count, double behind_nats, double error_px) {
    for (int i = 0; i < count; ++i) {
      PoseCandidate candidate;
      candidate.camera_from_station = movedBy(seed.camera_from_station, 0.001 * (i + 1));
      candidate.evidence.edges_nats = 0.8 - behind_nats * i;
      candidate.error_px = error_px;
      candidates.push_back(candidate);
    }
    trials = CandidateTrials(candidates, seed);
  }
  PassKind kindOf(const Attempt& attempt) const { return attempt.plan(pass.context()).kind; }

  ScriptedPass pass;
  const Seed seed = seedInFront();
  std::vector<PoseCandidate> candidates;
  CandidateTrials trials;
};

TEST_F(CandidateTrialsTest, ResolvedCandidate_IsRefinedAtOnce) {
  offer(1, 0.0, 1.0);
  const Attempt attempt = trials.next(0, pass.context());
  EXPECT_EQ(kindOf(attempt), PassKind::kRefine);
  EXPECT_EQ(attempt.camera_from_station(), candidates[0].camera_from_station);
}

TEST_F(CandidateTrialsTest, CoarselyResolvedCandidate_IsMatchedInANarrowerBox) {
  offer(1, 0.0, 20.0);
  const Attempt attempt = trials.next(0, pass.context());
  EXPECT_EQ(kindOf(attempt), PassKind::kMatch);
  const SeedUncertainty box =
      uncertaintyAbout(candidates[0].camera_from_station, seed, pass.context().scene);
  for (int i = 0; i < 3; ++i) EXPECT_LE(box.rotation_rad[i], seed.uncertainty.rotation_rad[i]);
}

TEST_F(CandidateTrialsTest, NoCandidates_StartFromTheSeed) {
  offer(0, 0.0, 0.0);
  EXPECT_EQ(trials.next(0, pass.context()).camera_from_station(), seed.camera_from_station);
  EXPECT_EQ(trials.takeFailure(pass.context()), TrialNext::kConclude);
}

TEST_F(CandidateTrialsTest, SurePose_EndsTheRun) {
  offer(3, 0.01, 1.0);
  const Attempt attempt = trials.next(0, pass.context());
  EXPECT_EQ(trials.takePose(attempt, Pose(), 0.99, pass.context()), TrialNext::kConclude);
}

TEST_F(CandidateTrialsTest, UnsurePose_IsComparedAndTheMostProbableReturns) {
  offer(2, 0.01, 1.0);
  Attempt attempt = trials.next(0, pass.context());
  EXPECT_EQ(trials.takePose(attempt, Pose(), 0.8, pass.context()), TrialNext::kTry);
  attempt = trials.next(1, pass.context());
  EXPECT_EQ(attempt.camera_from_station(), candidates[1].camera_from_station);
  EXPECT_EQ(trials.takePose(attempt, Pose(), 0.7, pass.context()), TrialNext::kReturn);
  const Attempt back = trials.best(2, pass.options);
  EXPECT_EQ(back.index(), 2);
  EXPECT_EQ(trials.takePose(back, Pose(), 0.8, pass.context()), TrialNext::kConclude);
}

TEST_F(CandidateTrialsTest, CandidateWhoseTemplatesFail_IsRefinedFromTheCoarseLevelOn) {
  offer(2, 0.01, 20.0);
  EXPECT_EQ(kindOf(trials.next(0, pass.context())), PassKind::kMatch);
  EXPECT_EQ(trials.takeFailure(pass.context()), TrialNext::kTry);
  Attempt direct = trials.next(1, pass.context());
  EXPECT_EQ(direct.camera_from_station(), candidates[0].camera_from_station);
  const PassPlan coarse = direct.plan(pass.context());
  EXPECT_EQ(coarse.kind, PassKind::kRefine);
  EXPECT_EQ(coarse.level, pass.context().levels.coarse);
  pass.refine(coarse, coarse.camera_from_station);
  (void)direct.take(pass.outcome, {}, pass.context(), pass.records);
  const PassPlan fine = direct.plan(pass.context());
  EXPECT_EQ(fine.kind, PassKind::kRefine);
  EXPECT_EQ(fine.level, pass.context().levels.fine);
  EXPECT_EQ(coarse.threshold_px, fine.threshold_px * (1 << (coarse.level - fine.level)));
  EXPECT_EQ(trials.takeFailure(pass.context()), TrialNext::kTry);
  EXPECT_EQ(kindOf(trials.next(2, pass.context())), PassKind::kMatch);
}

TEST_F(CandidateTrialsTest, CandidateOfMuchLessEvidence_IsNotCompared) {
  offer(2, 0.5, 1.0);
  const Attempt attempt = trials.next(0, pass.context());
  EXPECT_EQ(trials.takePose(attempt, Pose(), 0.8, pass.context()), TrialNext::kConclude);
}

TEST_F(CandidateTrialsTest, Failures_GoThroughCandidatesThenTheSeed) {
  offer(5, 0.01, 1.0);
  const int most = pass.options.loop.max_attempts;
  for (int i = 0; i < most; ++i) {
    const Attempt attempt = trials.next(i, pass.context());
    const Pose& expected = i + 1 < most
                               ? candidates[static_cast<std::size_t>(i)].camera_from_station
                               : seed.camera_from_station;
    EXPECT_EQ(attempt.camera_from_station(), expected) << i;
    EXPECT_EQ(trials.takeFailure(pass.context()),
              i + 1 < most ? TrialNext::kTry : TrialNext::kConclude);
  }
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

TEST_F(AttemptTest, ConvincingFirstHypothesis_EndsTheIteration) {
  const Ruling ruling = takeMatch(found, 80);  // of 90 matches
  EXPECT_EQ(ruling.next, Ruling::Next::kPass);
  EXPECT_TRUE(ruling.iteration_complete);
  EXPECT_EQ(pass.records[0].hypothesis_count, 1);
  EXPECT_NEAR(pass.records[0].correction_translation_m, 0.01, 1e-12);
  EXPECT_EQ(attempt.camera_from_station(), found);
}

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
  EXPECT_EQ(attempt.camera_from_station(), movedBy(found, 0.001));
}

TEST_F(AttemptTest, HypothesisAfterABetterOne_FillsTheOtherRecord) {
  (void)takeMatch(found, 30);
  EXPECT_EQ(attempt.plan(pass.context()).record, 1);
  (void)takeMatch(found, 10);  // worse: its record is free again
  EXPECT_EQ(attempt.plan(pass.context()).record, 1);
}

TEST_F(AttemptTest, LaterIterations_ShrinkWindowsAndThreshold) {
  const PassPlan first = attempt.plan(pass.context());
  (void)takeMatch(found, 80);
  const PassPlan second = attempt.plan(pass.context());
  EXPECT_EQ(second.level, first.level - 1);
  EXPECT_EQ(second.threshold_px, 0.5 * first.threshold_px);
  EXPECT_EQ(second.uncertainty.rotation_rad, 0.5 * first.uncertainty.rotation_rad);
  EXPECT_EQ(second.camera_from_station, found);
}

TEST_F(AttemptTest, SmallCorrectionsInARow_Converge) {
  (void)takeMatch(found, 80);
  (void)takeMatch(found, 80);
  EXPECT_EQ(attempt.plan(pass.context()).kind, PassKind::kRefine);
  Ruling ruling = takeRefinement(movedBy(found, 0.002));  // 12 px: not small
  int refinements = 1;
  for (; ruling.next == Ruling::Next::kPass; ++refinements) {
    ASSERT_LT(refinements, 10);
    ruling = takeRefinement(movedBy(found, 0.002));
  }
  EXPECT_TRUE(ruling.found());
  EXPECT_EQ(refinements, 1 + pass.options.loop.converged_iterations);
  EXPECT_EQ(attempt.covariance(), Matrix6d(Matrix6d::Identity() * 1e-10));
}

TEST_F(AttemptTest, CorrectionsThatStayLarge_EndAtTheIterationLimit) {
  Ruling ruling = takeMatch(found, 80);
  int iterations = 1;
  for (; ruling.next == Ruling::Next::kPass; ++iterations) {
    const Pose next = movedBy(found, iterations % 2 == 0 ? 0.0 : 0.005);
    ruling = iterations == 1 ? takeMatch(next, 80) : takeRefinement(next);
  }
  EXPECT_TRUE(ruling.failed());
  EXPECT_EQ(ruling.status, LocalizationStatus::kIterationLimit);
  EXPECT_EQ(iterations, pass.options.loop.max_iterations);
}

TEST_F(AttemptTest, RefinementBeyondTheUncertainty_Fails) {
  (void)takeMatch(found, 80);
  (void)takeMatch(found, 80);
  const Ruling ruling = takeRefinement(movedBy(seed.camera_from_station, 0.046));  // of 0.045
  EXPECT_TRUE(ruling.failed());
  EXPECT_EQ(ruling.status, LocalizationStatus::kLeftUncertainty);
}

TEST_F(AttemptTest, MatchedPoseBeyondTheUncertainty_IsPulledBack) {
  (void)takeMatch(movedBy(seed.camera_from_station, 0.05), 80);
  EXPECT_NEAR(attempt.camera_from_station().translation_m.x(), 0.03, 1e-12);
}

TEST_F(AttemptTest, FailedHypotheses_FailWithTheReasonOfTheKeptOne) {
  Ruling ruling;
  while (ruling.next == Ruling::Next::kPass) {
    const Agreement none = pass.fail(attempt.plan(pass.context()), Stage::kTemplates,
                                     LocalizationStatus::kTooFewTemplates);
    ruling = attempt.take(pass.outcome, none, pass.context(), pass.records);
  }
  EXPECT_EQ(ruling.status, LocalizationStatus::kTooFewTemplates);
  EXPECT_EQ(ruling.stage, Stage::kTemplates);
}

TEST_F(AttemptTest, Restart_BeginsAtTheSeedWithLargerTemplates) {
  (void)takeMatch(found, 80);
  attempt.restart();
  const PassPlan plan = attempt.plan(pass.context());
  EXPECT_EQ(plan.attempt, 1);
  EXPECT_EQ(plan.camera_from_station, seed.camera_from_station);
  EXPECT_EQ(plan.template_factor, 2.0);
  EXPECT_EQ(plan.level, pass.context().levels.coarse);
}

}  // namespace
}  // namespace boresight
