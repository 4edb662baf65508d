// SPDX-License-Identifier: Apache-2.0
#include <gtest/gtest.h>
#include <Eigen/Cholesky>

#include "core/pnp/normal_equations.h"
#include "core/pnp/refine_pose.h"
#include "tests/core/pnp/pnp_scene.h"

namespace boresight {
namespace {

using test::makeScene;
using test::PnpScene;
using test::randomFor;

/// Draws the pixels of a scene anew around their exact places.
void drawPixels(Random& random, const PnpScene& exact, PnpScene& noisy) {
  for (std::size_t i = 0; i < exact.correspondences.size(); ++i) {
    const double sigma_px = exact.correspondences[i].sigma_px;
    noisy.correspondences[i].pixel = exact.correspondences[i].pixel +
                                     sigma_px * Eigen::Vector2d{random.normal(), random.normal()};
  }
}

TEST(PoseCovariance, DescribesTheErrorsOfTheRefinedPose) {
  Random random = randomFor("PoseCovariance.DescribesTheErrorsOfTheRefinedPose");
  PnpScene exact = makeScene(random, {.points = 60});
  for (Correspondence& item : exact.correspondences) item.sigma_px = random.uniform(0.3, 2.0);
  PnpScene noisy = exact;
  constexpr int kDraws = 1000;
  double mean_square = 0.0;
  Matrix6d whitened_scatter = Matrix6d::Zero();
  for (int draw = 0; draw < kDraws; ++draw) {
    drawPixels(random, exact, noisy);
    Pose pose = exact.camera_from_station;
    ASSERT_EQ(refinePose(noisy.correspondences, {}, noisy.camera, nullptr, 20, pose), Status::kOk);
    Matrix6d covariance;
    ASSERT_EQ(poseCovariance(noisy.correspondences, {}, noisy.camera, pose, covariance),
              Status::kOk);
    const Vector6d xi = perturbationBetween(pose, exact.camera_from_station);
    const Eigen::LLT<Matrix6d> factor(covariance);
    ASSERT_EQ(factor.info(), Eigen::Success);
    const Vector6d white = factor.matrixL().solve(xi);
    mean_square += white.squaredNorm() / kDraws;
    whitened_scatter += white * white.transpose() / kDraws;
  }
  // 6 (2n - 6) / (2n - 8) for a variance estimated from the same residuals; its mean over 1000
  // draws has a standard deviation of 0.11.
  EXPECT_NEAR(mean_square, 6.0 * 114.0 / 112.0, 0.4);
  EXPECT_LT((whitened_scatter - Matrix6d::Identity()).cwiseAbs().maxCoeff(), 0.16);
}

TEST(PoseCovariance, DividesByTheDegreesOfFreedom) {
  Random random = randomFor("PoseCovariance.DividesByTheDegreesOfFreedom");
  const PnpScene scene = makeScene(random, {.points = 5, .noise_px = 0.7});
  const Pose& pose = scene.camera_from_station;
  Matrix6d covariance;
  ASSERT_EQ(poseCovariance(scene.correspondences, {}, scene.camera, pose, covariance), Status::kOk);
  const Matrix6d lower =
      reprojectionEquations(scene.correspondences, {}, scene.camera, pose).information;
  const Matrix6d information = lower.selfadjointView<Eigen::Lower>();
  const double variance =
      test::reprojectionCost(scene.correspondences, {}, scene.camera, pose) / (2 * 5 - 6);
  EXPECT_LT((information * covariance / variance - Matrix6d::Identity()).norm(), 1e-6);
}

TEST(PoseCovariance, DoesNotDependOnACommonScaleOfTheSigmas) {
  Random random = randomFor("PoseCovariance.DoesNotDependOnACommonScaleOfTheSigmas");
  PnpScene scene = makeScene(random, {.points = 20, .noise_px = 0.7});
  Pose pose = scene.camera_from_station;
  ASSERT_EQ(refinePose(scene.correspondences, {}, scene.camera, nullptr, 20, pose), Status::kOk);
  Matrix6d unit;
  ASSERT_EQ(poseCovariance(scene.correspondences, {}, scene.camera, pose, unit), Status::kOk);
  for (Correspondence& item : scene.correspondences) item.sigma_px = 4.0;
  Matrix6d scaled_sigma;
  ASSERT_EQ(poseCovariance(scene.correspondences, {}, scene.camera, pose, scaled_sigma),
            Status::kOk);
  EXPECT_LT((unit - scaled_sigma).norm(), 1e-12 * unit.norm());
}

TEST(PoseCovariance, OfExactDataIsTinyButDefinite) {
  Random random = randomFor("PoseCovariance.OfExactDataIsTinyButDefinite");
  const PnpScene scene = makeScene(random, {.points = 20});
  Matrix6d covariance;
  ASSERT_EQ(poseCovariance(scene.correspondences, {}, scene.camera, scene.camera_from_station,
                           covariance),
            Status::kOk);
  EXPECT_EQ(Eigen::LLT<Matrix6d>(covariance).info(), Eigen::Success);
  EXPECT_LT(covariance.norm(), 1e-12);
}

TEST(PoseCovariance, OfThreePointsExists) {
  Random random = randomFor("PoseCovariance.OfThreePointsExists");
  const PnpScene scene = makeScene(random, {.points = 3, .noise_px = 0.1});
  Matrix6d covariance;
  EXPECT_EQ(poseCovariance(scene.correspondences, {}, scene.camera, scene.camera_from_station,
                           covariance),
            Status::kOk);
  EXPECT_TRUE(test::isFiniteMatrix(covariance));
}

TEST(PoseCovariance, OfUndeterminedPosesIsDegenerate) {
  Random random = randomFor("PoseCovariance.OfUndeterminedPosesIsDegenerate");
  PnpScene scene = makeScene(random, {.points = 20});
  Matrix6d covariance;
  EXPECT_EQ(poseCovariance(std::span(scene.correspondences).first(2), {}, scene.camera,
                           scene.camera_from_station, covariance),
            Status::kDegenerate);
  for (Correspondence& item : scene.correspondences) {
    item.point_in_station_m *= 0.0;
    item.point_in_station_m.x() = random.uniform(-0.1, 0.1);
  }
  EXPECT_EQ(poseCovariance(scene.correspondences, {}, scene.camera, scene.camera_from_station,
                           covariance),
            Status::kDegenerate);
  Pose broken = scene.camera_from_station;
  broken.rotation.w() = std::numeric_limits<double>::quiet_NaN();
  EXPECT_EQ(poseCovariance(scene.correspondences, {}, scene.camera, broken, covariance),
            Status::kInvalidPose);
}

}  // namespace
}  // namespace boresight
