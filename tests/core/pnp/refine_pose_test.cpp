// SPDX-License-Identifier: Apache-2.0
#include "core/pnp/refine_pose.h"

#include <gtest/gtest.h>

#include "tests/core/geometry/example_cameras.h"
#include "tests/core/pnp/pnp_scene.h"

namespace boresight::test {
namespace {

class RefinePoseCameras : public ::testing::TestWithParam<NamedCamera> {};

TEST_P(RefinePoseCameras, RecoversExactDataFromTheHypothesis) {
  Random random = randomFor("RefinePoseCameras." + GetParam().name);
  for (int trial = 0; trial < 20; ++trial) {
    const PnpScene scene = makeScene(random, {.points = 30}, GetParam().camera);
    Pose pose = scene.hypothesis.camera_from_station;
    ASSERT_EQ(refinePose(scene.correspondences, {}, scene.camera, nullptr, 20, pose), Status::kOk);
    EXPECT_THAT(pose, poseNear(scene.camera_from_station, 1e-9, 1e-9));
  }
}

TEST_P(RefinePoseCameras, EndsAtTheLeastSquares) {
  Random random = randomFor("RefinePoseCameras.Least." + GetParam().name);
  for (int trial = 0; trial < 5; ++trial) {
    const PnpScene scene = makeScene(random, {.points = 30, .noise_px = 2.0}, GetParam().camera);
    Pose pose = scene.hypothesis.camera_from_station;
    ASSERT_EQ(refinePose(scene.correspondences, {}, scene.camera, nullptr, 50, pose), Status::kOk);
    const auto cost = [&scene](const Pose& at) {
      return reprojectionCost(scene.correspondences, {}, scene.camera, at);
    };
    EXPECT_LT(newtonStepLeft(cost, pose), 1e-8);
  }
}

INSTANTIATE_TEST_SUITE_P(Every, RefinePoseCameras, ::testing::ValuesIn(exampleCameras()),
                         [](const auto& tested) { return tested.param.name; });

TEST(RefinePose, WeighsByInverseVariance) {
  Random random = randomFor("RefinePose.WeighsByInverseVariance");
  PnpScene scene = makeScene(random, {.points = 12, .noise_px = 3.0});
  std::vector<Correspondence> repeated = scene.correspondences;
  for (int copy = 0; copy < 3; ++copy) repeated.push_back(scene.correspondences[4]);
  scene.correspondences[4].sigma_px = 0.5;  // as good as four of them
  Pose weighted = scene.camera_from_station;
  Pose plain = scene.camera_from_station;
  ASSERT_EQ(refinePose(scene.correspondences, {}, scene.camera, nullptr, 50, weighted),
            Status::kOk);
  ASSERT_EQ(refinePose(repeated, {}, scene.camera, nullptr, 50, plain), Status::kOk);
  EXPECT_THAT(weighted, poseNear(plain, 1e-10, 1e-10));
  scene.correspondences[4].sigma_px = 1.0;
  Pose unweighted = scene.camera_from_station;
  ASSERT_EQ(refinePose(scene.correspondences, {}, scene.camera, nullptr, 50, unweighted),
            Status::kOk);
  EXPECT_THAT(unweighted, ::testing::Not(poseNear(plain, 1e-6, 1e-6)));
}

TEST(RefinePose, UsesMarkedCorrespondencesOnly) {
  Random random = randomFor("RefinePose.UsesOnlyWhatIsMarked");
  const PnpScene scene = makeScene(random, {.points = 40, .outlier_share = 0.5});
  std::vector<std::uint8_t> use;
  for (const bool outlier : scene.is_outlier) use.push_back(outlier ? 0 : 1);
  Pose pose = scene.hypothesis.camera_from_station;
  ASSERT_EQ(refinePose(scene.correspondences, use, scene.camera, nullptr, 20, pose), Status::kOk);
  EXPECT_THAT(pose, poseNear(scene.camera_from_station, 1e-9, 1e-9));
}

TEST(RefinePose, LeavesOutUnusableCorrespondences) {
  Random random = randomFor("RefinePose.LeavesOutWhatIsNotUsable");
  PnpScene scene = makeScene(random, {.points = 20});
  const double nan = std::numeric_limits<double>::quiet_NaN();
  const double infinity = std::numeric_limits<double>::infinity();
  scene.correspondences[3].pixel.x() = nan;
  scene.correspondences[7].point_in_station_m.z() = infinity;
  scene.correspondences[9].sigma_px = 0.0;
  scene.correspondences[11].sigma_px = -1.0;
  scene.correspondences[13].pixel.y() = 1e300;
  Pose pose = scene.hypothesis.camera_from_station;
  ASSERT_EQ(refinePose(scene.correspondences, {}, scene.camera, nullptr, 20, pose), Status::kOk);
  EXPECT_THAT(pose, poseNear(scene.camera_from_station, 1e-9, 1e-9));
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
    const double before = reprojectionCost(scene.correspondences, {}, scene.camera, start);
    ASSERT_LE(reprojectionCost(scene.correspondences, {}, scene.camera, pose),
              before * (1.0 + 1e-12));
  }
}

TEST(RefinePose, CollinearPointsAreDegenerate) {
  Random random = randomFor("RefinePose.CollinearPointsAreDegenerate");
  for (int trial = 0; trial < 50; ++trial) {
    PnpScene scene = makeScene(random, {.points = 30});
    const Eigen::Vector3d direction = randomDirection(random);
    for (Correspondence& item : scene.correspondences) {
      item.point_in_station_m = random.uniform(-0.1, 0.1) * direction;
      ASSERT_TRUE(
          project(scene.camera, scene.camera_from_station * item.point_in_station_m, item.pixel));
      item.pixel += Eigen::Vector2d{random.normal(), random.normal()};
    }
    const Pose start = scene.hypothesis.camera_from_station;
    Pose pose = start;
    ASSERT_EQ(refinePose(scene.correspondences, {}, scene.camera, nullptr, 20, pose),
              Status::kDegenerate);
    EXPECT_EQ(pose.translation_m, start.translation_m);
    EXPECT_EQ(pose.rotation.coeffs(), start.rotation.coeffs());
  }
}

TEST(RefinePose, TooFewOrInvisiblePointsAreDegenerate) {
  Random random = randomFor("RefinePose.TooFewOrInvisiblePointsAreDegenerate");
  const PnpScene scene = makeScene(random, {.points = 6});
  for (std::size_t count = 0; count < 3; ++count) {
    Pose pose = scene.camera_from_station;
    EXPECT_EQ(refinePose(std::span(scene.correspondences).first(count), {}, scene.camera, nullptr,
                         20, pose),
              Status::kDegenerate);
  }
  Pose behind = scene.camera_from_station;
  behind.translation_m.z() = -1.0;
  EXPECT_EQ(refinePose(scene.correspondences, {}, scene.camera, nullptr, 20, behind),
            Status::kDegenerate);
  EXPECT_EQ(behind.translation_m.z(), -1.0);
}

TEST(RefinePose, BadArgumentsGiveAStatus) {
  Random random = randomFor("RefinePose.BadArgumentsGiveAStatus");
  const PnpScene scene = makeScene(random, {.points = 6});
  Pose pose = scene.camera_from_station;
  const std::vector<std::uint8_t> short_use(5, 1);
  EXPECT_EQ(refinePose(scene.correspondences, short_use, scene.camera, nullptr, 20, pose),
            Status::kTooFewPoints);
  pose.rotation.coeffs().setZero();
  EXPECT_EQ(refinePose(scene.correspondences, {}, scene.camera, nullptr, 20, pose),
            Status::kInvalidPose);
  pose = scene.camera_from_station;
  pose.translation_m.y() = std::numeric_limits<double>::quiet_NaN();
  EXPECT_EQ(refinePose(scene.correspondences, {}, scene.camera, nullptr, 20, pose),
            Status::kInvalidPose);
  pose = scene.camera_from_station;
  PosePrior prior = scene.hypothesis;
  prior.sigma.rotation_rad.x() = -0.1;
  EXPECT_EQ(refinePose(scene.correspondences, {}, scene.camera, &prior, 20, pose),
            Status::kInvalidPose);
}

double priorCost(const PosePrior& prior, const Pose& pose) {
  const Vector6d offset =
      offsetAboutPivot(prior.camera_from_station, pose, prior.sigma.pivot_in_camera_m);
  return offset.head<3>().cwiseQuotient(prior.sigma.rotation_rad).squaredNorm() +
         offset.tail<3>().cwiseQuotient(prior.sigma.translation_m).squaredNorm();
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
        return reprojectionCost(scene.correspondences, {}, scene.camera, at) + priorCost(prior, at);
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
}  // namespace boresight::test
