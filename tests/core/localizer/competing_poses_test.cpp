// SPDX-License-Identifier: Apache-2.0
#include "core/localizer/competing_poses.h"

#include <gtest/gtest.h>

#include "tests/core/localizer/scripted_pass.h"

namespace boresight {
namespace {

using test::movedBy;
using test::ScriptedPass;
using test::seedInFront;
using Next = CompetingPoses::Next;

/// A rail whose pattern repeats every 20 mm to both sides.
class CompetingPosesTest : public testing::Test {
 protected:
  CompetingPosesTest() {
    pass.options.ambiguity.enabled = true;
    const Agreement agreement =
        pass.match(first.plan(pass.context()), seed.camera_from_station, 80);
    (void)first.take(pass.outcome, agreement, pass.context(), pass.records);
    for (const double x_m : {0.02, -0.02}) {
      SelfShift shift;
      shift.similarity = 0.8;
      shift.displacement_in_camera_m.x() = x_m;
      shifts.push_back(shift);
    }
  }

  /// An attempt that converged at a pose displaced by `x_m`.
  Next converge(double x_m, double best_margin_nats) {
    Attempt attempt = competing.isTrying() ? competing.competitor(1, pass.context()) : first;
    const Pose found = movedBy(seed.camera_from_station, x_m);
    const Agreement agreement = pass.match(attempt.plan(pass.context()), found, 80);
    (void)attempt.take(pass.outcome, agreement, pass.context(), pass.records);
    return competing.takePose(attempt, found, best_margin_nats, pass.context(), leads);
  }

  ScriptedPass pass;
  const Seed seed = seedInFront();
  Attempt first{0, seed};
  std::vector<SelfShift> shifts;
  std::array<Rival, 8> memory;
  CompetingPoses competing{memory, seed};
  bool leads = false;
};

TEST_F(CompetingPosesTest, NoRepeatedPattern_ConcludesConverged) {
  EXPECT_EQ(converge(0.0, 0.0), Next::kCompare);
  EXPECT_TRUE(leads);
  EXPECT_EQ(competing.takeShifts({}, pass.context()), Next::kConclude);
  EXPECT_EQ(competing.verdict(seed.camera_from_station, pass.options),
            LocalizationStatus::kConverged);
}

TEST_F(CompetingPosesTest, RepeatedPattern_TriesEveryDisplacementOnce) {
  (void)converge(0.0, 0.0);
  EXPECT_EQ(competing.takeShifts(shifts, pass.context()), Next::kTry);
  ASSERT_EQ(competing.poses().size(), 2u);
  EXPECT_EQ(competing.takeFailure(LocalizationStatus::kNotSupported), Next::kTry);
  EXPECT_EQ(competing.takeFailure(LocalizationStatus::kTooFewMatches), Next::kReturn);
  EXPECT_TRUE(competing.hasEnded());
  EXPECT_EQ(competing.poses()[0].ended, LocalizationStatus::kNotSupported);
  EXPECT_EQ(competing.verdict(seed.camera_from_station, pass.options),
            LocalizationStatus::kConverged);
}

TEST_F(CompetingPosesTest, CompetitorWithSimilarEvidence_IsAmbiguous) {
  (void)converge(0.0, 0.0);
  (void)competing.takeShifts(std::span(shifts).first(1), pass.context());
  EXPECT_EQ(converge(0.02, 2.0), Next::kReturn);
  EXPECT_FALSE(leads);
  EXPECT_EQ(competing.verdict(seed.camera_from_station, pass.options),
            LocalizationStatus::kAmbiguous);
}

TEST_F(CompetingPosesTest, CompetitorWithMoreEvidence_BecomesTheBestPose) {
  (void)converge(0.0, 0.0);
  (void)competing.takeShifts(std::span(shifts).first(1), pass.context());
  EXPECT_EQ(converge(0.02, -50.0), Next::kCompare);
  EXPECT_TRUE(leads);
  EXPECT_EQ(competing.takeShifts({}, pass.context()), Next::kConclude);
  EXPECT_EQ(competing.poses()[0].margin_nats, 50.0);
  EXPECT_EQ(competing.poses()[0].camera_from_station, seed.camera_from_station);
  EXPECT_EQ(competing.verdict(movedBy(seed.camera_from_station, 0.02), pass.options),
            LocalizationStatus::kConverged);
}

TEST_F(CompetingPosesTest, Competitor_StartsInABoxThatDoesNotReachTheBestPose) {
  (void)converge(0.0, 0.0);
  (void)competing.takeShifts(std::span(shifts).first(1), pass.context());
  const PassPlan plan = competing.competitor(1, pass.context()).plan(pass.context());
  EXPECT_NEAR(plan.uncertainty.translation_m.x(), 0.25 * 0.02, 1e-12);
  EXPECT_EQ(plan.level, pass.context().levels.fine);
}

TEST_F(CompetingPosesTest, DisplacementOutOfReach_IsLeftOut) {
  (void)converge(0.0, 0.0);
  shifts[0].displacement_in_camera_m.x() = 0.061;  // of twice 0.03 m
  EXPECT_EQ(competing.takeShifts(std::span(shifts).first(1), pass.context()), Next::kConclude);
  EXPECT_TRUE(competing.poses().empty());
}

}  // namespace
}  // namespace boresight
