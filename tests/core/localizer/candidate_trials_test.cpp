// SPDX-License-Identifier: Apache-2.0
#include "core/localizer/candidate_trials.h"

#include <vector>

#include <gtest/gtest.h>

#include "tests/core/localizer/scripted_pass.h"

namespace boresight {
namespace {

using test::movedBy;
using test::ScriptedPass;
using test::seedInFront;
using Next = CandidateTrials::Next;

class CandidateTrialsTest : public testing::Test {
 protected:
  /// Candidates 1 mm apart, each with a little less evidence than the one before.
  void offer(int count, double behind_nats, double error_px) {
    for (int i = 0; i < count; ++i) {
      PoseCandidate made;
      made.camera_from_station = movedBy(seed.camera_from_station, 0.001 * (i + 1));
      made.evidence.edges_nats = 0.8 - behind_nats * i;
      made.error_px = error_px;
      candidates.push_back(made);
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
  EXPECT_EQ(trials.takeFailure(0, pass.context()), Next::kConclude);
}

TEST_F(CandidateTrialsTest, SurePose_EndsTheRun) {
  offer(3, 0.01, 1.0);
  const Attempt attempt = trials.next(0, pass.context());
  EXPECT_EQ(trials.takePose(attempt, Pose(), 0.99, pass.context()), Next::kConclude);
}

TEST_F(CandidateTrialsTest, UnsurePose_IsComparedAndTheMostProbableReturns) {
  offer(2, 0.01, 1.0);
  Attempt attempt = trials.next(0, pass.context());
  EXPECT_EQ(trials.takePose(attempt, Pose(), 0.8, pass.context()), Next::kTry);
  attempt = trials.next(1, pass.context());
  EXPECT_EQ(attempt.camera_from_station(), candidates[1].camera_from_station);
  EXPECT_EQ(trials.takePose(attempt, Pose(), 0.7, pass.context()), Next::kReturn);
  const Attempt back = trials.best(2, pass.options);
  EXPECT_EQ(back.index(), 2);
  EXPECT_EQ(trials.takePose(back, Pose(), 0.8, pass.context()), Next::kConclude);
}

TEST_F(CandidateTrialsTest, CandidateOfMuchLessEvidence_IsNotCompared) {
  offer(2, 0.5, 1.0);
  const Attempt attempt = trials.next(0, pass.context());
  EXPECT_EQ(trials.takePose(attempt, Pose(), 0.8, pass.context()), Next::kConclude);
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
    EXPECT_EQ(trials.takeFailure(i, pass.context()), i + 1 < most ? Next::kTry : Next::kConclude);
  }
}

}  // namespace
}  // namespace boresight
