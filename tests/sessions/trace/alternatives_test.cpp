// SPDX-License-Identifier: Apache-2.0
#include "sessions/trace/alternatives.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

#include "tests/support/example_run.h"
#include "tests/support/random_pose.h"

namespace boresight::sessions {
namespace {

/// Two iterations of rolled hypotheses, and two plain ones.
struct Alternatives : testing::Test {
  Random random = test::randomFor("Alternatives");
  LocalizationTrace run;

  Alternatives() {
    for (int i = 0; i < 4; ++i) {
      IterationTrace iteration;
      iteration.index = i;
      iteration.camera_from_station_before = test::randomPose(random);
      iteration.camera_from_station = test::randomPose(random);
      const int count = i == 0 ? 3 : i == 1 ? 2 : 1;
      for (int k = 0; k < count; ++k) {
        HypothesisSummary& hypothesis = iteration.hypotheses.emplace_back();
        hypothesis.camera_from_station = test::randomPose(random);
        hypothesis.inliers = 5 + k;
        hypothesis.matches = 20;
        hypothesis.solved = k != 1;
      }
      iteration.chosen_hypothesis = i == 0 ? 2 : 0;
      run.iterations.push_back(std::make_shared<const IterationTrace>(iteration));
    }
    run.finished = true;
    run.status = LocalizationStatus::kConverged;
    run.camera_from_station = run.iterations.back()->camera_from_station;
  }
};

TEST_F(Alternatives, RolledHypotheses_AreListedPerIteration) {
  const std::vector<Alternative> all = alternativesOf(run);
  ASSERT_EQ(all.size(), 5u);
  for (std::size_t i = 0; i < all.size(); ++i) {
    const std::size_t iteration = i < 3 ? 0 : 1;
    const std::size_t k = i < 3 ? i : i - 3;
    const auto& hypotheses = run.iterations[iteration]->hypotheses;
    const std::size_t chosen = iteration == 0 ? 2 : 0;
    EXPECT_EQ(all[i].kind, AlternativeKind::kRolled);
    EXPECT_EQ(all[i].iteration, static_cast<int>(iteration));
    EXPECT_EQ(all[i].camera_from_station, hypotheses[k].camera_from_station);
    EXPECT_EQ(all[i].inliers, hypotheses[k].inliers);
    EXPECT_EQ(all[i].camera_from_station_chosen, hypotheses[chosen].camera_from_station);
    EXPECT_EQ(all[i].chosen, k == chosen);
    EXPECT_TRUE(std::isnan(all[i].similarity));
  }
  EXPECT_TRUE(std::isnan(all[0].score)) << "rolled hypotheses have none";
  EXPECT_FALSE(all[4].has_pose);
  EXPECT_TRUE(std::isnan(all[4].apart_m));
}

TEST_F(Alternatives, TellHowFarTheyAreApart) {
  Pose moved = run.camera_from_station;
  moved.rotation = rotationExp({0.0, 0.0, 0.25}) * moved.rotation;
  moved.translation_m += Eigen::Vector3d(0.003, 0.0, 0.004);
  run.competing_poses = {{moved, 0.4, 25.0}};
  const Alternative competing = alternativesOf(run).front();
  EXPECT_NEAR(competing.apart_m, 0.005, 1e-12);
  EXPECT_NEAR(competing.apart_rad, 0.25, 1e-9);
  EXPECT_EQ(competing.camera_from_station_chosen, run.camera_from_station);
  EXPECT_EQ(competing.margin_nats, 25.0);
}

/// A run that ends as ambiguous has its seed for a result.
TEST_F(Alternatives, OfAnAmbiguousRun_AreComparedWithItsLastIteration) {
  const Pose elsewhere = test::randomPose(random);
  run.competing_poses = {{elsewhere, 0.9, 1.0}, {elsewhere, 0.9, 2.0}};
  run.status = LocalizationStatus::kAmbiguous;
  run.camera_from_station = test::randomPose(random);
  const std::vector<Alternative> all = alternativesOf(run);
  ASSERT_EQ(all.size(), 7u);
  for (int i = 0; i < 2; ++i) {
    const Alternative& competing = all[static_cast<std::size_t>(i)];
    EXPECT_EQ(competing.number, i + 1);
    EXPECT_EQ(competing.camera_from_station, elsewhere);
    EXPECT_EQ(competing.camera_from_station_chosen, run.iterations.back()->camera_from_station);
  }
}

TEST_F(Alternatives, ComparedPoses_BeginWithTheCompetitorThenByScore) {
  for (const double score : {1.0, 4.0, 2.0, 3.0}) {
    const auto number = static_cast<std::int32_t>(run.hypotheses.size());
    PoseHypothesis& compared = run.hypotheses.emplace_back();
    compared.camera_from_station = test::randomPose(random);
    compared.score = score;
    compared.number = number;
  }
  run.best_hypothesis = 1;
  run.competitor = 2;
  std::vector<Alternative> all = alternativesOf(run);
  std::erase_if(all, [](const auto& each) { return each.kind != AlternativeKind::kCompared; });
  ASSERT_EQ(all.size(), 4u);
  const int numbers[] = {3, 2, 4, 1};
  for (std::size_t i = 0; i < 4; ++i) {
    EXPECT_EQ(all[i].number, numbers[i]);
    EXPECT_EQ(all[i].chosen, numbers[i] == 2);
    EXPECT_EQ(all[i].camera_from_station_chosen, run.hypotheses[1].camera_from_station);
  }
}

}  // namespace
}  // namespace boresight::sessions
