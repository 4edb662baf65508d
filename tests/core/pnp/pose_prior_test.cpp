// SPDX-License-Identifier: Apache-2.0
#include <gtest/gtest.h>

#include "core/pnp/refine_pose.h"
#include "tests/core/pnp/pnp_scene.h"

namespace boresight {
namespace {

using test::makeScene;
using test::PnpScene;
using test::poseNear;
using test::randomFor;

double priorCost(const PosePrior& prior, const Pose& pose) {
  const Vector6d offset =
      offsetAboutPivot(prior.camera_from_station, pose, prior.sigma.pivot_in_camera_m);
  return offset.head<3>().cwiseQuotient(prior.sigma.rotation_rad).squaredNorm() +
         offset.tail<3>().cwiseQuotient(prior.sigma.translation_m).squaredNorm();
}

PosePrior randomPrior(Random& random, const PnpScene& scene) {
  PosePrior prior = scene.hypothesis;
  prior.sigma.pivot_in_camera_m = test::randomVector(random, 0.3);
  for (int i = 0; i < 3; ++i) {
    prior.sigma.translation_m[i] = random.uniform(0.001, 0.05);
    prior.sigma.rotation_rad[i] = random.uniform(0.005, 0.1);
  }
  return prior;
}

TEST(RefinePosePrior, AloneLeadsToTheHypothesis) {
  Random random = randomFor("RefinePosePrior.AloneLeadsToTheHypothesis");
  for (int trial = 0; trial < 50; ++trial) {
    const PnpScene scene = makeScene(random, {.points = 0});
    const PosePrior prior = randomPrior(random, scene);
    Pose pose = scene.camera_from_station;
    ASSERT_EQ(refinePose({}, {}, scene.camera, &prior, 20, pose), Status::kOk);
    EXPECT_THAT(pose, poseNear(prior.camera_from_station, 1e-9, 1e-9));
  }
}

TEST(RefinePosePrior, BalancesWithTheReprojections) {
  Random random = randomFor("RefinePosePrior.BalancesWithTheReprojections");
  for (const int points : {1, 2, 3, 4, 20}) {
    for (int trial = 0; trial < 10; ++trial) {
      PnpScene scene = makeScene(random, {.points = points, .noise_px = 2.0, .sigma_px = 20.0});
      const PosePrior prior = randomPrior(random, scene);
      Pose pose = prior.camera_from_station;
      ASSERT_EQ(refinePose(scene.correspondences, {}, scene.camera, &prior, 50, pose), Status::kOk);
      const auto cost = [&](const Pose& at) {
        return test::reprojectionCost(scene.correspondences, {}, scene.camera, at) +
               priorCost(prior, at);
      };
      EXPECT_LT(test::newtonStepLeft(cost, pose), 2e-6) << points << " points";
      EXPECT_GT(priorCost(prior, pose), 1e-4) << "the reprojections must have pulled";
    }
  }
}

TEST(RefinePosePrior, HoldsAFixedAxis) {
  Random random = randomFor("RefinePosePrior.HoldsAFixedAxis");
  const PnpScene scene = makeScene(random, {.points = 20});
  PosePrior prior = scene.hypothesis;
  prior.sigma.rotation_rad.setConstant(10.0);
  prior.sigma.translation_m.setConstant(10.0);
  prior.sigma.rotation_rad.z() = 0.0;  // counts as 1e-9
  Pose pose = prior.camera_from_station;
  ASSERT_EQ(refinePose(scene.correspondences, {}, scene.camera, &prior, 50, pose), Status::kOk);
  const Vector6d offset =
      offsetAboutPivot(prior.camera_from_station, pose, prior.sigma.pivot_in_camera_m);
  EXPECT_LT(std::abs(offset[2]), 1e-6);
  EXPECT_GT(std::abs(offset[0]) + std::abs(offset[1]), 1e-4);
}

TEST(RefinePosePrior, DeterminesCollinearPoints) {
  Random random = randomFor("RefinePosePrior.DeterminesCollinearPoints");
  PnpScene scene = makeScene(random, {.points = 10});
  for (Correspondence& item : scene.correspondences) {
    item.point_in_station_m = {random.uniform(-0.1, 0.1), 0.0, 0.0};
    ASSERT_TRUE(
        project(scene.camera, scene.camera_from_station * item.point_in_station_m, item.pixel));
  }
  Pose pose = scene.hypothesis.camera_from_station;
  EXPECT_EQ(refinePose(scene.correspondences, {}, scene.camera, &scene.hypothesis, 50, pose),
            Status::kOk);
  for (const Correspondence& item : scene.correspondences) {
    Eigen::Vector2d pixel;
    ASSERT_TRUE(project(scene.camera, pose * item.point_in_station_m, pixel));
    EXPECT_LT((pixel - item.pixel).norm(), 0.5);
  }
}

}  // namespace
}  // namespace boresight
