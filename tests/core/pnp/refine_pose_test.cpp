// SPDX-License-Identifier: Apache-2.0
#include "core/pnp/refine_pose.h"

#include <gtest/gtest.h>

#include "tests/core/geometry/example_cameras.h"
#include "tests/core/pnp/pnp_scene.h"
#include "tests/support/not_finite.h"

namespace boresight::test {
namespace {

TEST(RefinePose, EveryCamera_RecoversExactDataAndEndsAtTheLeastSquares) {
  for (const auto& [name, camera] : exampleCameras()) {
    SCOPED_TRACE(name);
    Random random = randomFor("RefinePoseCameras." + name);
    for (int trial = 0; trial < 20; ++trial) {
      const PnpScene scene = makeScene(random, {.points = 30}, camera);
      EXPECT_THAT(refinedPose(scene, scene.hypothesis.camera_from_station),
                  poseNear(scene.camera_from_station, 1e-9, 1e-9));
    }
    random = randomFor("RefinePoseCameras.Least." + name);
    for (int trial = 0; trial < 5; ++trial) {
      const PnpScene scene = makeScene(random, {.points = 30, .noise_px = 2.0}, camera);
      const auto cost = [&scene](const Pose& at) { return reprojectionCost(scene, at); };
      EXPECT_LT(newtonStepLeft(cost, refinedPose(scene, scene.hypothesis.camera_from_station, 50)),
                1e-8);
    }
  }
}

TEST(RefinePose, WeighsByInverseVariance) {
  Random random = randomFor("RefinePose.WeighsByInverseVariance");
  PnpScene scene = makeScene(random, {.points = 12, .noise_px = 3.0});
  PnpScene repeated = scene;
  repeated.correspondences.insert(repeated.correspondences.end(), 3, scene.correspondences[4]);
  const Pose plain = refinedPose(repeated, scene.camera_from_station, 50);
  EXPECT_THAT(refinedPose(scene, scene.camera_from_station, 50),
              ::testing::Not(poseNear(plain, 1e-6, 1e-6)));
  scene.correspondences[4].sigma_px = 0.5;  // as good as four of them
  EXPECT_THAT(refinedPose(scene, scene.camera_from_station, 50), poseNear(plain, 1e-10, 1e-10));
}

TEST(RefinePose, LeavesOutUnusableCorrespondences) {
  Random random = randomFor("RefinePose.LeavesOutWhatIsNotUsable");
  PnpScene scene = makeScene(random, {.points = 20});
  scene.correspondences[3].pixel.x() = kNan;
  scene.correspondences[7].point_in_station_m.z() = kInfinity;
  scene.correspondences[9].sigma_px = 0.0;
  scene.correspondences[11].sigma_px = -1.0;
  scene.correspondences[13].pixel.y() = 1e300;
  EXPECT_THAT(refinedPose(scene, scene.hypothesis.camera_from_station),
              poseNear(scene.camera_from_station, 1e-9, 1e-9));
}

TEST(RefinePose, NeverRaisesTheSquares) {
  Random random = randomFor("RefinePose.NeverRaisesTheSquares");
  for (int trial = 0; trial < 300; ++trial) {
    // Half the pixels are wrong: no minimum is near, and full steps often overshoot.
    const PnpScene scene = makeScene(random, {.points = 8, .outlier_share = 0.5, .noise_px = 1.0});
    const Pose start = scene.hypothesis.camera_from_station;
    Pose pose = start;
    const Status status = refinePose(scene.correspondences, {}, scene.camera, nullptr, 3, pose);
    ASSERT_TRUE(pose.isFinite());
    if (status != Status::kOk) continue;
    ASSERT_LE(reprojectionCost(scene, pose), reprojectionCost(scene, start) * (1.0 + 1e-12));
  }
}

TEST(RefinePose, CollinearPointsAreDegenerate) {
  Random random = randomFor("RefinePose.CollinearPointsAreDegenerate");
  for (int trial = 0; trial < 50; ++trial) {
    PnpScene scene = makeScene(random, {.points = 30});
    makeCollinear(random, randomDirection(random), scene);
    for (Correspondence& item : scene.correspondences)
      item.pixel += Eigen::Vector2d{random.normal(), random.normal()};
    const Pose start = scene.hypothesis.camera_from_station;
    Pose pose = start;
    ASSERT_EQ(refinePose(scene.correspondences, {}, scene.camera, nullptr, 20, pose),
              Status::kDegenerate);
    EXPECT_EQ(pose, start);
  }
}

TEST(RefinePose, TooFewPointsAndBadArguments_GiveAStatus) {
  Random random = randomFor("RefinePose.TooFewOrInvisiblePointsAreDegenerate");
  const PnpScene scene = makeScene(random, {.points = 6});
  const std::span<const Correspondence> all = scene.correspondences;
  const auto statusOf = [&scene](std::span<const Correspondence> items, Pose pose,
                                 const PosePrior* prior = nullptr,
                                 const std::vector<std::uint8_t>& use = {}) {
    const Pose start = pose;
    const Status status = refinePose(items, use, scene.camera, prior, 20, pose);
    EXPECT_TRUE(pose == start || !start.isFinite());
    return status;
  };
  Pose pose = scene.camera_from_station;
  for (std::size_t count = 0; count < 3; ++count)
    EXPECT_EQ(statusOf(all.first(count), pose), Status::kDegenerate);
  EXPECT_EQ(statusOf(all, pose, nullptr, {1, 1, 1, 1, 1}), Status::kTooFewPoints);
  PosePrior prior = scene.hypothesis;
  prior.sigma.rotation_rad.x() = -0.1;
  EXPECT_EQ(statusOf(all, pose, &prior), Status::kInvalidPose);
  pose.translation_m.z() = -1.0;  // behind the camera
  EXPECT_EQ(statusOf(all, pose), Status::kDegenerate);
  pose.translation_m.y() = kNan;
  EXPECT_EQ(statusOf(all, pose), Status::kInvalidPose);
  pose = scene.camera_from_station;
  pose.rotation.coeffs().setZero();
  EXPECT_EQ(statusOf(all, pose), Status::kInvalidPose);
}

PosePrior randomPrior(Random& random, const PnpScene& scene) {
  PosePrior prior = scene.hypothesis;
  prior.sigma.pivot_in_camera_m = randomVector(random, 0.3);
  for (int i = 0; i < 3; ++i) {
    prior.sigma.translation_m[i] = random.uniform(0.001, 0.05);
    prior.sigma.rotation_rad[i] = random.uniform(0.005, 0.1);
  }
  return prior;
}

TEST(RefinePosePrior, WithoutCorrespondences_LeadsToTheHypothesis) {
  Random random = randomFor("RefinePosePrior.AloneLeadsToTheHypothesis");
  for (int trial = 0; trial < 50; ++trial) {
    const PnpScene scene = makeScene(random, {.points = 0});
    const PosePrior prior = randomPrior(random, scene);
    EXPECT_THAT(refinedPose(scene, scene.camera_from_station, 20, &prior),
                poseNear(prior.camera_from_station, 1e-9, 1e-9));
  }
}

TEST(RefinePosePrior, BalancesWithTheReprojections) {
  Random random = randomFor("RefinePosePrior.BalancesWithTheReprojections");
  for (const int points : {1, 2, 3, 4, 20}) {
    for (int trial = 0; trial < 10; ++trial) {
      const PnpScene scene =
          makeScene(random, {.points = points, .noise_px = 2.0, .sigma_px = 20.0});
      const PosePrior prior = randomPrior(random, scene);
      const Pose pose = refinedPose(scene, prior.camera_from_station, 50, &prior);
      const auto cost = [&](const Pose& at) {
        return reprojectionCost(scene, at) + priorCost(prior, at);
      };
      EXPECT_LT(newtonStepLeft(cost, pose), 2e-6) << points << " points";
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
  const Pose pose = refinedPose(scene, prior.camera_from_station, 50, &prior);
  const Vector6d offset =
      offsetAboutPivot(prior.camera_from_station, pose, prior.sigma.pivot_in_camera_m);
  EXPECT_LT(std::abs(offset[2]), 1e-6);
  EXPECT_GT(std::abs(offset[0]) + std::abs(offset[1]), 1e-4);
}

}  // namespace
}  // namespace boresight::test
