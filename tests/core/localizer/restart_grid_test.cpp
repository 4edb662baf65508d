// SPDX-License-Identifier: Apache-2.0
// Where restarts begin, what they cover, and which go on.
#include "core/localizer/restart_grid.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <vector>

#include <gtest/gtest.h>

#include "core/base/math.h"
#include "core/localizer/pose_change.h"
#include "tests/core/localizer/scene.h"
#include "tests/support/random_pose.h"

namespace boresight::test {
namespace {

BoundingBox boxAt(const Eigen::Vector3d& centre_m) {
  return {centre_m - Eigen::Vector3d(0.08, 0.06, 0.02),
          centre_m + Eigen::Vector3d(0.08, 0.06, 0.02)};
}

LocalizationProblem problemAt(const Pose& camera_from_station_seed) {
  LocalizationProblem problem;
  problem.camera_from_station_seed = camera_from_station_seed;
  problem.uncertainty.translation_m = {0.02, 0.03, 0.04};
  problem.uncertainty.rotation_rad = {0.05, 0.06, 0.07};
  return problem;
}

WideOptions turnsOf(double range_rad, TurnAxis axis = TurnAxis::kView) {
  WideOptions options;
  options.rotation_rad = range_rad;
  options.rotation_axis = axis;
  return options;
}

double angleBetween(double one_rad, double other_rad) {
  const double between = std::abs(one_rad - other_rad);
  return std::min(between, 2.0 * kPi - between);
}

TEST(RestartGrid, BeginsWithTheSeedItself) {
  Random random = randomFor("RestartGrid.BeginsWithTheSeedItself");
  const Pose seed = randomCameraFromStation(random, 0.5);
  WideOptions options = turnsOf(kPi);
  options.translation_m = 0.075;
  const RestartGrid grid(problemAt(seed), boxAt({0.01, 0.02, 0.0}), options);
  EXPECT_EQ(grid.poseOf(0), seed);
  EXPECT_EQ(grid.turnOf_rad(0), 0.0);
  EXPECT_EQ(grid.depthOffsetOf_m(0), 0.0);
}

TEST(RestartGrid, EveryTurnOfTheRangeIsNearARestart) {
  const Pose seed{Eigen::Quaterniond::Identity(), {0.0, 0.0, 0.5}};
  for (const double range_deg : {1.0, 19.0, 40.0, 90.0, 170.0, 178.0, 180.0}) {
    for (const double spacing_deg : {5.0, 8.0, 20.0, 77.0}) {
      WideOptions options = turnsOf(range_deg * kDegree_rad);
      options.rotation_spacing_rad = spacing_deg * kDegree_rad;
      const RestartGrid grid(problemAt(seed), boxAt({0.0, 0.0, 0.0}), options);
      for (double turn_deg = -range_deg; turn_deg <= range_deg; turn_deg += 0.25) {
        double nearest_rad = 10.0;
        for (int i = 0; i < grid.count(); ++i) {
          nearest_rad =
              std::min(nearest_rad, angleBetween(grid.turnOf_rad(i), turn_deg * kDegree_rad));
        }
        EXPECT_LE(nearest_rad, 0.5 * spacing_deg * kDegree_rad + 1e-9)
            << range_deg << " " << spacing_deg << " " << turn_deg;
        EXPECT_LE(nearest_rad, grid.uncertaintyOf(0).rotation_rad.z() + 1e-9);
      }
    }
  }
}

TEST(RestartGrid, AFullTurnMeetsItselfOnce) {
  const Pose seed{Eigen::Quaterniond::Identity(), {0.0, 0.0, 0.5}};
  WideOptions options = turnsOf(kPi);
  options.rotation_spacing_rad = 20.0 * kDegree_rad;
  const RestartGrid grid(problemAt(seed), boxAt({0.0, 0.0, 0.0}), options);
  EXPECT_EQ(grid.count(), 18);
  for (int i = 0; i < grid.count(); ++i) {
    for (int k = 0; k < i; ++k)
      EXPECT_GT(angleBetween(grid.turnOf_rad(i), grid.turnOf_rad(k)), 19.99 * kDegree_rad);
  }
}

TEST(RestartGrid, TooManyAreSpacedWiderAndStillCoverAll) {
  const Pose seed{Eigen::Quaterniond::Identity(), {0.0, 0.0, 0.5}};
  WideOptions options = turnsOf(kPi);
  options.translation_m = 0.075;
  options.max_restarts = 20;
  const RestartGrid grid(problemAt(seed), boxAt({0.0, 0.0, 0.0}), options);
  EXPECT_LE(grid.count(), 20);
  EXPECT_EQ(grid.depths(), 3);
  EXPECT_EQ(grid.turns(), 6);
  EXPECT_NEAR(grid.uncertaintyOf(0).rotation_rad.z(), kPi / 6, 1e-9);
}

TEST(RestartGrid, TurnsAboutTheViewOrAnAxisOfTheStationLeaveItsMiddleInPlace) {
  Random random = randomFor("RestartGrid.Axis");
  for (int trial = 0; trial < 40; ++trial) {
    const auto axis = static_cast<TurnAxis>(trial % 4);
    const Pose seed = randomCameraFromStation(random, 0.5);
    const BoundingBox scene = boxAt({0.01, -0.02, 0.005});
    const RestartGrid grid(problemAt(seed), scene, turnsOf(kPi, axis));
    const Eigen::Vector3d middle_m = seed * scene.centre();
    const Eigen::Vector3d expected =
        axis == TurnAxis::kView
            ? middle_m.normalized().eval()
            : (seed.rotation * Eigen::Vector3d::Unit(static_cast<int>(axis) - 1)).eval();
    for (int i = 0; i < grid.count(); ++i) {
      const Pose pose = grid.poseOf(i);
      EXPECT_LT((pose * scene.centre() - middle_m).norm(), 1e-12);
      const Eigen::Vector3d turn =
          rotationLog((pose.rotation * seed.rotation.conjugate()).normalized());
      if (std::abs(std::abs(grid.turnOf_rad(i)) - kPi) < 1e-6) continue;  // of either sign
      EXPECT_LT((turn - grid.turnOf_rad(i) * expected).norm(), 1e-9);
    }
  }
}

/// A truth that was turned, moved, and then off by as much as the seed's uncertainty allows lies in
/// the box of a restart.
TEST(RestartGrid, TheTruthLiesInTheBoxOfARestart) {
  Random random = randomFor("RestartGrid.Truth");
  for (int trial = 0; trial < 300; ++trial) {
    const Pose seed = randomCameraFromStation(random, 0.5);
    LocalizationProblem problem = problemAt(seed);
    const BoundingBox scene = boxAt({0.0, 0.0, 0.0});
    problem.uncertainty.pivot_in_camera_m = seed * scene.centre();
    WideOptions options = turnsOf(0.7, static_cast<TurnAxis>(trial % 4));
    options.translation_m = 0.075;
    const RestartGrid grid(problem, scene, options);
    const RestartGrid turned(problem, scene, [&] {
      WideOptions one = options;
      one.translation_m = 0.0;
      one.rotation_spacing_rad = 0.001 + 0.7 * random.uniform();
      return one;
    }());
    const Pose start =
        turned.poseOf(static_cast<int>(random.below(static_cast<std::uint32_t>(turned.count()))));
    Vector6d offset;
    for (int i = 0; i < 3; ++i) {
      const bool covered = options.rotation_axis == TurnAxis::kView && i == 2;
      offset[i] = covered ? 0.0 : 0.5 * problem.uncertainty.rotation_rad[i] * random.uniform(-1, 1);
      offset[3 + i] = 0.075 * random.uniform(-1.0, 1.0);
    }
    const Pose truth = displacedAboutPivot(start, offset, start * scene.centre());
    bool covered = false;
    for (int i = 0; i < grid.count() && !covered; ++i) {
      LocalizationProblem from = problem;
      from.camera_from_station_seed = grid.poseOf(i);
      from.uncertainty = grid.uncertaintyOf(i);
      covered = !leftUncertainty(seedOf(from), truth, 1.1);
    }
    EXPECT_TRUE(covered) << trial;
  }
}

TEST(Evidence, IsTheExponentOfChance) {
  // 10 heads of 10 at one half: 2^-10.
  EXPECT_NEAR(excessNats(10, 1.0, 0.5), 10 * std::log(2.0), 1e-12);
  EXPECT_NEAR(excessNats(7, 0.75, 0.25), 7 * (0.75 * std::log(3.0) - 0.25 * std::log(3.0)), 1e-12);
  EXPECT_EQ(excessNats(100, 0.2, 0.2), 0.0);
  EXPECT_EQ(excessNats(100, 0.1, 0.2), 0.0);
  EXPECT_GT(excessNats(100, 0.3, 0.2), 0.0);
  EXPECT_TRUE(std::isfinite(excessNats(100, 0.5, 0.0)));
}

HypothesisSummary restartAt(double x_m, int inliers, double edge_nats) {
  HypothesisSummary one;
  one.camera_from_station = {Eigen::Quaterniond::Identity(), {x_m, 0.0, 0.5}};
  one.solved = true;
  one.inliers = inliers;
  one.edge_nats = edge_nats;
  return one;
}

TEST(Finalists, GoByEvidenceAndNotByInliers) {
  std::vector<HypothesisSummary> restarts = {restartAt(0.00, 80, 5.0), restartAt(0.02, 12, 90.0),
                                             restartAt(0.04, 50, 20.0), restartAt(0.06, 90, 99.0)};
  restarts[3].solved = false;
  std::array<std::int32_t, 9> chosen{};
  ASSERT_EQ(chooseFinalists(restarts, boxAt({0, 0, 0}), pinholeCamera(), 5.0, chosen), 3);
  EXPECT_EQ(chosen[0], 1);
  EXPECT_EQ(chosen[1], 2);
  EXPECT_EQ(chosen[2], 0);
}

TEST(Finalists, AreDifferentPlaces) {
  // 0.1 mm is a tenth of a pixel here.
  const std::vector<HypothesisSummary> restarts = {
      restartAt(0.0, 9, 50.0), restartAt(0.0001, 9, 60.0), restartAt(-0.0001, 9, 60.0),
      restartAt(0.03, 9, 10.0)};
  std::array<std::int32_t, 3> chosen{};
  ASSERT_EQ(chooseFinalists(restarts, boxAt({0, 0, 0}), pinholeCamera(), 5.0, chosen), 2);
  EXPECT_EQ(chosen[0], 1);  // the earlier of equals
  EXPECT_EQ(chosen[1], 3);
}

}  // namespace
}  // namespace boresight::test
