// SPDX-License-Identifier: Apache-2.0
#include "core/pnp/normal_equations.h"

#include <limits>

#include <gtest/gtest.h>
#include <Eigen/Cholesky>
#include <Eigen/LU>

#include "core/pnp/refine_pose.h"
#include "tests/core/pnp/pnp_scene.h"

namespace boresight::test {
namespace {

Matrix6d symmetric(const Matrix6d& lower) {
  Matrix6d whole = lower;
  for (int i = 0; i < 6; ++i) {
    for (int j = i + 1; j < 6; ++j) whole(i, j) = lower(j, i);
  }
  return whole;
}

class ReprojectionEquations : public ::testing::TestWithParam<CameraModel> {};

TEST_P(ReprojectionEquations, MatchFiniteDifferences) {
  Random random = randomFor("ReprojectionEquations.AreThoseOfFiniteDifferences");
  const Camera camera = randomCamera(random, GetParam());
  PnpScene scene = makeScene(random, {.points = 20, .noise_px = 3.0}, camera);
  for (Correspondence& item : scene.correspondences) item.sigma_px = random.uniform(0.5, 2.0);
  const Pose pose = scene.hypothesis.camera_from_station;
  Matrix6d information = Matrix6d::Zero();
  Vector6d gradient = Vector6d::Zero();
  for (const Correspondence& item : scene.correspondences) {
    Eigen::Matrix<double, 2, 6> jacobian;
    for (int k = 0; k < 6; ++k) {
      Vector6d xi = Vector6d::Zero();
      xi[k] = 1e-6;
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
  const NormalEquations equations = reprojectionEquations(scene.correspondences, {}, camera, pose);
  EXPECT_LT((symmetric(equations.information) - information).norm(), 1e-6 * information.norm());
  EXPECT_LT((equations.gradient - gradient).norm(), 1e-6 * gradient.norm());
  const double cost = reprojectionCost(scene.correspondences, {}, camera, pose);
  EXPECT_NEAR(equations.squares, cost, 1e-9 * cost);
  EXPECT_EQ(equations.projected, 20);
  EXPECT_EQ(equations.missing, 0);
}

INSTANTIATE_TEST_SUITE_P(EveryModel, ReprojectionEquations,
                         ::testing::Values(CameraModel::kPinhole, CameraModel::kBrownConrady,
                                           CameraModel::kKannalaBrandt));

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
    const auto squares = [&prior](const Pose& pose) {
      const Vector6d offset =
          offsetAboutPivot(prior.camera_from_station, pose, prior.sigma.pivot_in_camera_m);
      return offset.head<3>().cwiseQuotient(prior.sigma.rotation_rad).squaredNorm() +
             offset.tail<3>().cwiseQuotient(prior.sigma.translation_m).squaredNorm();
    };
    const Pose pose =
        displacedAboutPivot(prior.camera_from_station, randomOffset(random, prior.sigma),
                            prior.sigma.pivot_in_camera_m);
    NormalEquations equations;
    addPrior(prior, pose, equations);
    EXPECT_NEAR(equations.prior_squares, squares(pose), 1e-9 * squares(pose));
    for (int k = 0; k < 6; ++k) {
      Vector6d xi = Vector6d::Zero();
      xi[k] = 1e-6;
      const double slope = (squares(perturbed(xi, pose)) - squares(perturbed(-xi, pose))) / 2e-6;
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
  equations.information(3, 1) = std::numeric_limits<double>::quiet_NaN();
  EXPECT_FALSE(solve(equations, 0.0, xi));
  equations.information.setConstant(std::numeric_limits<double>::infinity());
  EXPECT_FALSE(solve(equations, 0.0, xi));
}

/// Draws new noisy pixels of a scene around their exact places.
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
      reprojectionCost(scene.correspondences, {}, scene.camera, pose) / (2 * 5 - 6);
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

TEST(PoseCovariance, ExactData_GivesATinyPositiveDefiniteMatrix) {
  Random random = randomFor("PoseCovariance.OfExactDataIsTinyButDefinite");
  const PnpScene scene = makeScene(random, {.points = 20});
  Matrix6d covariance;
  ASSERT_EQ(poseCovariance(scene.correspondences, {}, scene.camera, scene.camera_from_station,
                           covariance),
            Status::kOk);
  EXPECT_EQ(Eigen::LLT<Matrix6d>(covariance).info(), Eigen::Success);
  EXPECT_LT(covariance.norm(), 1e-12);
}

TEST(PoseCovariance, ThreePoints_GiveACovariance) {
  Random random = randomFor("PoseCovariance.OfThreePointsExists");
  const PnpScene scene = makeScene(random, {.points = 3, .noise_px = 0.1});
  Matrix6d covariance;
  EXPECT_EQ(poseCovariance(scene.correspondences, {}, scene.camera, scene.camera_from_station,
                           covariance),
            Status::kOk);
  EXPECT_TRUE(isFiniteMatrix(covariance));
}

TEST(PoseCovariance, UndeterminedPose_IsDegenerate) {
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
}  // namespace boresight::test
