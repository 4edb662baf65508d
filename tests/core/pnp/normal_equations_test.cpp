// SPDX-License-Identifier: Apache-2.0
#include "core/pnp/normal_equations.h"

#include <gtest/gtest.h>
#include <Eigen/Cholesky>
#include <Eigen/LU>

#include "core/pnp/refine_pose.h"
#include "tests/core/pnp/pnp_scene.h"
#include "tests/support/not_finite.h"

namespace boresight::test {
namespace {

TEST(ReprojectionEquations, MatchFiniteDifferences) {
  for (const CameraModel model :
       {CameraModel::kPinhole, CameraModel::kBrownConrady, CameraModel::kKannalaBrandt}) {
    SCOPED_TRACE(static_cast<int>(model));
    Random random = randomFor("ReprojectionEquations.AreThoseOfFiniteDifferences");
    const Camera camera = randomCamera(random, model);
    PnpScene scene = makeScene(random, {.points = 20, .noise_px = 3.0}, camera);
    for (Correspondence& item : scene.correspondences) item.sigma_px = random.uniform(0.5, 2.0);
    const Pose pose = scene.hypothesis.camera_from_station;
    Matrix6d information = Matrix6d::Zero();
    Vector6d gradient = Vector6d::Zero();
    for (const Correspondence& item : scene.correspondences) {
      Eigen::Matrix<double, 2, 6> jacobian;
      for (int k = 0; k < 6; ++k) {
        const Vector6d xi = 1e-6 * Vector6d::Unit(k);
        Eigen::Vector2d above, below;
        ASSERT_TRUE(project(camera, perturbed(xi, pose) * item.point_in_station_m, above));
        ASSERT_TRUE(project(camera, perturbed(-xi, pose) * item.point_in_station_m, below));
        jacobian.col(k) = (above - below) / 2e-6;
      }
      Eigen::Vector2d pixel;
      ASSERT_TRUE(project(camera, pose * item.point_in_station_m, pixel));
      const double weight = 1.0 / (item.sigma_px * item.sigma_px);
      information += weight * jacobian.transpose() * jacobian;
      gradient += weight * jacobian.transpose() * (item.pixel - pixel);
    }
    const NormalEquations equations =
        reprojectionEquations(scene.correspondences, {}, camera, pose);
    const Matrix6d symmetric = equations.information.selfadjointView<Eigen::Lower>();
    EXPECT_LT((symmetric - information).norm(), 1e-6 * information.norm());
    EXPECT_LT((equations.gradient - gradient).norm(), 1e-6 * gradient.norm());
    const double cost = reprojectionCost(scene, pose);
    EXPECT_NEAR(equations.squares, cost, 1e-9 * cost);
    EXPECT_EQ(equations.projected, 20);
    EXPECT_EQ(equations.missing, 0);
  }
}

TEST(NormalEquationsCost, PointBehindTheCamera_CostsMoreThanAnyResidual) {
  Random random = randomFor("NormalEquationsCost.OfAPointBehindTheCameraExceedsAnyResidual");
  PnpScene scene = makeScene(random, {.points = 5});
  const NormalEquations before =
      reprojectionEquations(scene.correspondences, {}, scene.camera, scene.camera_from_station);
  scene.correspondences[2].point_in_station_m =
      scene.camera_from_station.inverse() * Eigen::Vector3d(0.0, 0.0, -1.0);
  const NormalEquations after =
      reprojectionEquations(scene.correspondences, {}, scene.camera, scene.camera_from_station);
  EXPECT_EQ(after.projected, 4);
  EXPECT_EQ(after.missing, 1);
  EXPECT_GE(after.cost(), before.cost() + 1e12);
}

TEST(AddPrior, AddsTheGradientOfTheSquaredOffsets) {
  Random random = randomFor("AddPrior.IsTheGradientOfTheOffsetsSquares");
  for (int trial = 0; trial < 100; ++trial) {
    PosePrior prior;
    prior.camera_from_station = randomCameraFromStation(random, 0.5);
    prior.sigma.pivot_in_camera_m = randomVector(random, 0.5);
    prior.sigma.translation_m = {0.01, 0.02, 0.04};
    prior.sigma.rotation_rad = {0.05, 0.1, 0.2};
    const Pose pose =
        displacedAboutPivot(prior.camera_from_station, randomOffset(random, prior.sigma),
                            prior.sigma.pivot_in_camera_m);
    NormalEquations equations;
    addPrior(prior, pose, equations);
    EXPECT_NEAR(equations.prior_squares, priorCost(prior, pose), 1e-9 * priorCost(prior, pose));
    for (int k = 0; k < 6; ++k) {
      const Vector6d xi = 1e-6 * Vector6d::Unit(k);
      const double slope =
          (priorCost(prior, perturbed(xi, pose)) - priorCost(prior, perturbed(-xi, pose))) / 2e-6;
      // gradient is minus half the slope; the left Jacobian is good to |r|^4 / 720 < 2e-5.
      EXPECT_NEAR(equations.gradient[k], -0.5 * slope, 1e-4 * equations.gradient.norm());
    }
  }
}

TEST(Solve, AgreesWithEigenOnRandomInformation) {
  Random random = randomFor("Solve.AgreesWithEigenOnRandomInformation");
  for (int trial = 0; trial < 200; ++trial) {
    Matrix6d root;
    NormalEquations equations;
    for (int i = 0; i < 36; ++i) root(i / 6, i % 6) = random.uniform(-1.0, 1.0);
    for (int i = 0; i < 6; ++i) equations.gradient[i] = random.uniform(-1.0, 1.0);
    const Matrix6d information = root * root.transpose() + 0.01 * Matrix6d::Identity();
    equations.information = information.triangularView<Eigen::Lower>();
    const double damping = trial % 2 == 0 ? 0.0 : 0.3;
    Matrix6d damped = information;
    damped.diagonal() *= 1.0 + damping;
    Vector6d xi;
    ASSERT_TRUE(solve(equations, damping, xi));
    EXPECT_LT((damped * xi - equations.gradient).norm(), 1e-9);
    Matrix6d covariance;
    ASSERT_TRUE(invert(equations.information, covariance));
    EXPECT_LT((covariance - information.inverse()).norm(), 1e-8 * covariance.norm());
    EXPECT_EQ(covariance, covariance.transpose());
  }
}

TEST(Solve, RefusesUndeterminedEquations) {
  Random random = randomFor("Solve.RefusesWhatIsNotDetermined");
  Vector6d xi;
  Matrix6d covariance;
  for (int rank = 0; rank < 6; ++rank) {
    Eigen::Matrix<double, 6, 6> root = Matrix6d::Zero();
    for (int i = 0; i < 6; ++i) {
      for (int j = 0; j < rank; ++j) root(i, j) = random.uniform(-1.0, 1.0);
    }
    NormalEquations equations;
    equations.information = root * root.transpose();
    EXPECT_FALSE(solve(equations, 0.0, xi)) << "rank " << rank;
    EXPECT_FALSE(invert(equations.information, covariance)) << "rank " << rank;
  }
  NormalEquations equations;
  equations.information.setIdentity();
  equations.information(3, 1) = kNan;
  EXPECT_FALSE(solve(equations, 0.0, xi));
  equations.information.setConstant(kInfinity);
  EXPECT_FALSE(solve(equations, 0.0, xi));
}

TEST(PoseCovariance, DescribesTheErrorsOfTheRefinedPose) {
  Random random = randomFor("PoseCovariance.DescribesTheErrorsOfTheRefinedPose");
  PnpScene exact = makeScene(random, {.points = 60});
  for (Correspondence& item : exact.correspondences) item.sigma_px = random.uniform(0.3, 2.0);
  constexpr int kDraws = 1000;
  double mean_square = 0.0;
  Matrix6d whitened_scatter = Matrix6d::Zero();
  for (int draw = 0; draw < kDraws; ++draw) {
    PnpScene noisy = exact;
    for (Correspondence& item : noisy.correspondences)
      item.pixel += item.sigma_px * Eigen::Vector2d{random.normal(), random.normal()};
    const Pose pose = refinedPose(noisy, exact.camera_from_station);
    const Vector6d xi = perturbationBetween(pose, exact.camera_from_station);
    const Eigen::LLT<Matrix6d> factor(covarianceAt(noisy, pose));
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

TEST(PoseCovariance, DividesByTheDegreesOfFreedomWhateverTheCommonSigma) {
  Random random = randomFor("PoseCovariance.DividesByTheDegreesOfFreedom");
  PnpScene scene = makeScene(random, {.points = 5, .noise_px = 0.7});
  const Pose& pose = scene.camera_from_station;
  const Matrix6d covariance = covarianceAt(scene, pose);
  const Matrix6d lower =
      reprojectionEquations(scene.correspondences, {}, scene.camera, pose).information;
  const Matrix6d information = lower.selfadjointView<Eigen::Lower>();
  const double variance = reprojectionCost(scene, pose) / (2 * 5 - 6);
  EXPECT_LT((information * covariance / variance - Matrix6d::Identity()).norm(), 1e-6);
  for (Correspondence& item : scene.correspondences) item.sigma_px = 4.0;
  EXPECT_LT((covarianceAt(scene, pose) - covariance).norm(), 1e-12 * covariance.norm());
}

TEST(PoseCovariance, ExactData_GivesATinyPositiveDefiniteMatrix) {
  Random random = randomFor("PoseCovariance.OfExactDataIsTinyButDefinite");
  const PnpScene scene = makeScene(random, {.points = 20});
  const Matrix6d covariance = covarianceAt(scene, scene.camera_from_station);
  EXPECT_EQ(Eigen::LLT<Matrix6d>(covariance).info(), Eigen::Success);
  EXPECT_LT(covariance.norm(), 1e-12);
}

TEST(PoseCovariance, ThreePoints_GiveACovariance) {
  Random random = randomFor("PoseCovariance.OfThreePointsExists");
  const PnpScene scene = makeScene(random, {.points = 3, .noise_px = 0.1});
  EXPECT_TRUE(covarianceAt(scene, scene.camera_from_station).allFinite());
}

TEST(PoseCovariance, UndeterminedPose_IsDegenerate) {
  Random random = randomFor("PoseCovariance.OfUndeterminedPosesIsDegenerate");
  PnpScene scene = makeScene(random, {.points = 20});
  const auto statusOf = [&scene](std::size_t points, const Pose& pose) {
    Matrix6d covariance;
    return poseCovariance(std::span(scene.correspondences).first(points), {}, scene.camera, pose,
                          covariance);
  };
  EXPECT_EQ(statusOf(2, scene.camera_from_station), Status::kDegenerate);
  makeCollinear(random, Eigen::Vector3d::UnitX(), scene);
  EXPECT_EQ(statusOf(20, scene.camera_from_station), Status::kDegenerate);
  Pose broken = scene.camera_from_station;
  broken.rotation.w() = kNan;
  EXPECT_EQ(statusOf(20, broken), Status::kInvalidPose);
}

}  // namespace
}  // namespace boresight::test
