// SPDX-License-Identifier: Apache-2.0
#include "core/pnp/normal_equations.h"

#include <array>
#include <limits>

#include <gtest/gtest.h>
#include <Eigen/LU>

#include "tests/core/pnp/pnp_scene.h"

namespace boresight {
namespace {

using test::makeScene;
using test::PnpScene;
using test::randomFor;

Matrix6d symmetric(const Matrix6d& lower) {
  Matrix6d whole = lower;
  for (int i = 0; i < 6; ++i) {
    for (int j = i + 1; j < 6; ++j) whole(i, j) = lower(j, i);
  }
  return whole;
}

class ReprojectionEquations : public ::testing::TestWithParam<CameraModel> {};

TEST_P(ReprojectionEquations, AreThoseOfFiniteDifferences) {
  Random random = randomFor("ReprojectionEquations.AreThoseOfFiniteDifferences");
  const Camera camera = test::randomCamera(random, GetParam());
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
  const double cost = test::reprojectionCost(scene.correspondences, {}, camera, pose);
  EXPECT_NEAR(equations.squares, cost, 1e-9 * cost);
  EXPECT_EQ(equations.projected, 20);
  EXPECT_EQ(equations.missing, 0);
}

INSTANTIATE_TEST_SUITE_P(EveryModel, ReprojectionEquations,
                         ::testing::Values(CameraModel::kPinhole, CameraModel::kBrownConrady,
                                           CameraModel::kKannalaBrandt));

TEST(NormalEquationsCost, OfAPointBehindTheCameraExceedsAnyResidual) {
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

TEST(AddPrior, IsTheGradientOfTheOffsetsSquares) {
  Random random = randomFor("AddPrior.IsTheGradientOfTheOffsetsSquares");
  for (int trial = 0; trial < 100; ++trial) {
    PosePrior prior;
    prior.camera_from_station = test::randomCameraFromStation(random, 0.5);
    prior.sigma.pivot_in_camera_m = test::randomVector(random, 0.5);
    prior.sigma.translation_m = {0.01, 0.02, 0.04};
    prior.sigma.rotation_rad = {0.05, 0.1, 0.2};
    const auto squares = [&prior](const Pose& pose) {
      const Vector6d offset =
          offsetAboutPivot(prior.camera_from_station, pose, prior.sigma.pivot_in_camera_m);
      return offset.head<3>().cwiseQuotient(prior.sigma.rotation_rad).squaredNorm() +
             offset.tail<3>().cwiseQuotient(prior.sigma.translation_m).squaredNorm();
    };
    const Pose pose =
        displacedAboutPivot(prior.camera_from_station, test::randomOffset(random, prior.sigma),
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

TEST(Solve, RefusesWhatIsNotDetermined) {
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

}  // namespace
}  // namespace boresight
