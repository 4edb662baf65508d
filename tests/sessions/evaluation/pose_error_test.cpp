// SPDX-License-Identifier: Apache-2.0
#include "sessions/evaluation/pose_error.h"

#include <gtest/gtest.h>

#include <cmath>
#include <limits>
#include <vector>

#include "core/base/math.h"
#include "core/base/random.h"
#include "tests/support/random_pose.h"

namespace boresight::sessions {
namespace {

using Eigen::Vector3d;

Pose poseOf(const Vector3d& rotation_rad, const Vector3d& translation_m) {
  Pose pose;
  pose.rotation = rotationExp(rotation_rad);
  pose.translation_m = translation_m;
  return pose;
}

/// The estimate for which E = camera_true_from_camera_estimated is the given one.
Pose estimateFor(const Pose& truth, const Pose& true_from_estimated) {
  return true_from_estimated.inverse() * truth;
}

const Pose kTruth = poseOf(Vector3d(0.3, -0.7, 1.1), Vector3d(0.02, -0.03, 0.4));

/// Of an estimate that is turned against the truth and not moved.
PoseError errorOfTurn(const Vector3d& rotation_rad) {
  return poseError(kTruth, estimateFor(kTruth, poseOf(rotation_rad, Vector3d::Zero())),
                   std::nullopt);
}

TEST(PoseError, IsMeasuredAtTheEndEffector) {
  // A tilt of 10 mrad about x moves a point 0.4 m ahead by (0, -0.4 sin, 0.4 (cos - 1)).
  const Pose effector = poseOf(Vector3d(1, 2, 3), Vector3d(0, 0, 0.4));
  const PoseError error = poseError(
      kTruth, estimateFor(kTruth, poseOf(Vector3d(0.01, 0, 0), Vector3d::Zero())), effector);
  EXPECT_NEAR(error.lateral_mm, 400.0 * std::sin(0.01), 1e-9);
  EXPECT_NEAR(error.normal_mm, 400.0 * (std::cos(0.01) - 1.0), 1e-9);
  // A compensating shift makes it vanish there, and appear at the camera.
  const Pose compensated =
      poseOf(Vector3d(0.01, 0, 0), Vector3d(0, 0.4 * std::sin(0.01), 0.4 * (1.0 - std::cos(0.01))));
  EXPECT_NEAR(poseError(kTruth, estimateFor(kTruth, compensated), effector).lateral_mm, 0.0, 1e-9);
  EXPECT_NEAR(poseError(kTruth, estimateFor(kTruth, compensated), std::nullopt).lateral_mm,
              400.0 * std::sin(0.01), 1e-9);
}

TEST(PoseError, KeepsTinyAnglesAndHalfTurnsExact) {
  const PoseError tiny = errorOfTurn(Vector3d(1e-9, 0, 0));
  EXPECT_NEAR(tiny.rotation_mrad, 1e-6, 1e-11);
  const PoseError half = errorOfTurn(Vector3d(0, 0, 3.1));
  EXPECT_NEAR(half.in_plane_mrad, 3100.0, 1e-9);
  const PoseError back = errorOfTurn(Vector3d(0, 0, -3.1));
  EXPECT_NEAR(back.in_plane_mrad, -3100.0, 1e-9);
  const PoseError flipped = errorOfTurn(Vector3d(kPi, 0, 0));
  EXPECT_NEAR(flipped.rotation_mrad, 1000.0 * kPi, 1e-9);
}

/// Independent of the formulas above: the tilt is the angle between the optical axes, the whole
/// rotation follows from the trace.
TEST(PoseError, AgreesWithAnglesTakenFromMatrices) {
  Random random(9);
  for (int i = 0; i < 1000; ++i) {
    const Pose e =
        poseOf(Vector3d(random.uniform(-1, 1), random.uniform(-1, 1), random.uniform(-1, 1)),
               Vector3d(random.uniform(-1, 1), random.uniform(-1, 1), 0.3));
    const PoseError error = poseError(kTruth, estimateFor(kTruth, e), std::nullopt);
    const Eigen::Matrix3d r = e.matrix();
    EXPECT_NEAR(error.rotation_mrad, 1e3 * std::acos(r(2, 2)), 1e-6);
    EXPECT_NEAR(error.geodesic_mrad, 1e3 * std::acos((r.trace() - 1.0) / 2.0), 1e-6);
    // Taking the tilt away leaves the twist: R = swing * twist, and swing turns z to R z.
    const Vector3d rz = r.col(2);
    const Eigen::Quaterniond swing = Eigen::Quaterniond::FromTwoVectors(Vector3d::UnitZ(), rz);
    const Eigen::Matrix3d twist = swing.toRotationMatrix().transpose() * r;
    EXPECT_NEAR(error.in_plane_mrad, 1e3 * std::atan2(twist(1, 0), twist(0, 0)), 1e-6);
    EXPECT_NEAR(error.normal_mm, 300.0, 1e-9);
    EXPECT_NEAR(error.lateral_mm, 1e3 * e.translation_m.head<2>().norm(), 1e-9);
    EXPECT_FALSE(error.projection_px);
  }
}

struct ProjectionError : testing::Test {
  const Camera camera_ = test::makePinhole(640, 480, 1000.0);
  const Pose front_ = poseOf(Vector3d::Zero(), Vector3d(0, 0, 2));
};

TEST_F(ProjectionError, AveragesDistancesOfVertices) {
  // Shifted by 1 mm in x at 1 m and 4 m: 1 px and 0.25 px.
  const std::vector<Eigen::Vector3f> vertices = {{0, 0, -1}, {0.5F, 0.25F, 2}};
  const Pose shifted = poseOf(Vector3d::Zero(), Vector3d(0.001, 0, 2));
  const auto error = projectionError(camera_, front_, shifted, vertices);
  ASSERT_TRUE(error.has_value());
  EXPECT_NEAR(*error, 0.625, 1e-9);
  EXPECT_NEAR(*projectionError(camera_, front_, front_, vertices), 0.0, 1e-12);
}

TEST_F(ProjectionError, CountsADiagonalWhereOnlyTheEstimateCannotProject) {
  const std::vector<Eigen::Vector3f> vertices = {{0, 0, 0}};
  const Pose behind = poseOf(Vector3d::Zero(), Vector3d(0, 0, -2));
  EXPECT_NEAR(*projectionError(camera_, front_, behind, vertices), 800.0, 1e-12);
  EXPECT_FALSE(projectionError(camera_, behind, front_, vertices).has_value());
  EXPECT_FALSE(projectionError(camera_, front_, front_, {}).has_value());
}

TEST(MeetsRequirement, JudgesWhatIsNamed) {
  struct Judged {
    PoseError error;
    Requirement requirement;
    bool meets, gross;
  };
  const Requirement normal{0.4, {}, {}, {}}, rotation{{}, {}, 0.25, {}}, pixels{{}, {}, {}, 5.0};
  const Judged cases[] = {{{-0.4, 100.0, 0.0, 0.0, 0.0, {}}, normal, true, false},
                          {{-0.41, 0.0, 0.0, 0.0, 0.0, {}}, normal, false, false},
                          {{0.41, 0.0, 0.0, 0.0, 0.0, {}}, normal, false, false},
                          {{-1.21, 0.0, 0.0, 0.0, 0.0, {}}, normal, false, true},
                          {{-9.0, 9.0, 4.36, 0.0, 0.0, {}}, rotation, true, false},
                          {{-9.0, 9.0, 4.37, 0.0, 0.0, {}}, rotation, false, false},
                          {{-9.0, 9.0, 13.1, 0.0, 0.0, {}}, rotation, false, true},
                          {{-9.0, 100.0, 0.0, 0.0, 0.0, {}}, {{}, 100.0, {}, {}}, true, false},
                          {{-9.0, 100.0, 0.0, 0.0, 0.0, {}}, {{}, 99.0, {}, {}}, false, false},
                          {{0.0, 0.0, 0.0, 0.0, 0.0, {}}, pixels, false, true},  // it is not known
                          {{0.0, 0.0, 0.0, 0.0, 0.0, 5.0}, pixels, true, false},
                          {{0.0, 0.0, 0.0, 0.0, 0.0, 15.1}, pixels, false, true}};
  for (const Judged& judged : cases) {
    EXPECT_EQ(meetsRequirement(judged.error, judged.requirement), judged.meets) << &judged - cases;
    EXPECT_EQ(isGross(judged.error, judged.requirement), judged.gross) << &judged - cases;
  }
}

TEST(StatisticsOf, HandComputedValues) {
  const std::vector<double> values = {2.0, -4.0, 4.0, 4.0, -5.0, 5.0, 1.0, 9.0};
  const Statistics result = statistics(values);
  EXPECT_EQ(result.count, 8);
  EXPECT_DOUBLE_EQ(result.mean, 2.0);
  EXPECT_DOUBLE_EQ(result.deviation, std::sqrt((0.0 + 36 + 4 + 4 + 49 + 9 + 1 + 49) / 8.0));
  EXPECT_DOUBLE_EQ(result.maximum, 9.0);
  const std::vector<double> negative = {-3.0, 1.0};
  EXPECT_DOUBLE_EQ(statistics(negative).maximum, 3.0);
  EXPECT_EQ(statistics({}).count, 0);
  EXPECT_EQ(statistics({}).mean, 0.0);
}

TEST(PoseSigma, IsWhatPoseErrorsOfRandomPosesSpread) {
  Random random = test::randomFor("PoseSigma");
  const Pose pose = test::randomCameraFromStation(random, 0.5);
  Pose effector;
  effector.translation_m = {0.02, -0.05, 0.4};
  Matrix6d root = Matrix6d::Zero();  // covariance = root root', correlated
  for (int row = 0; row < 6; ++row)
    for (int column = 0; column < 6; ++column) root(row, column) = 1e-4 * random.normal();
  const auto sigma = poseSigma(root * root.transpose(), effector);
  ASSERT_TRUE(sigma);
  double normal = 0.0;
  double lateral = 0.0;
  double rotation = 0.0;
  constexpr int kCount = 20000;
  for (int i = 0; i < kCount; ++i) {
    const Vector6d unit = test::normalVector6(random);
    // The estimate is the truth displaced; seen from the truth that is the displacement back.
    const PoseError error = poseError(perturbed(root * unit, pose), pose, effector);
    normal += error.normal_mm * error.normal_mm / kCount;
    lateral += error.lateral_mm * error.lateral_mm / kCount;
    rotation += error.rotation_mrad * error.rotation_mrad / kCount;
  }
  EXPECT_NEAR(sigma->normal_mm / std::sqrt(normal), 1.0, 0.03);
  EXPECT_NEAR(sigma->lateral_mm / std::sqrt(lateral), 1.0, 0.03);
  EXPECT_NEAR(sigma->out_of_plane_mrad / std::sqrt(rotation), 1.0, 0.03);
}

TEST(PoseSigma, IsNothingWithoutACovariance) {
  EXPECT_FALSE(poseSigma(Matrix6d::Zero(), std::nullopt));
  Matrix6d covariance = Matrix6d::Identity();
  covariance(2, 2) = -1.0;
  EXPECT_FALSE(poseSigma(covariance, std::nullopt));
  covariance(2, 2) = std::numeric_limits<double>::infinity();
  EXPECT_FALSE(poseSigma(covariance, std::nullopt));
}

TEST(SigmaExcess, NamesWhatIsWorstByFiguresAndWhere) {
  Vector6d sigma;
  sigma << 1e-3, 0.0, 0.0, 3e-3, 0.0, 10.4e-3;
  const Matrix6d covariance = sigma.cwiseAbs2().asDiagonal();
  EXPECT_EQ(sigmaExcessText(covariance, {}, {0.4, 0.4, 0.25, {}}),
            "10.4 mm along the view axis at the camera, 26 times the 0.4 mm required");
  Pose effector;
  EXPECT_EQ(sigmaExcessText(covariance, effector, {11.0, 0.5, 0.25, {}}),
            "3 mm across the view axis at the end effector, 6 times the 0.5 mm required");
  EXPECT_EQ(sigmaExcessText(covariance, effector, {11.0, {}, 0.01, {}}),
            "0.0573 deg of the view axis, 5.73 times the 0.01 deg required");
  EXPECT_EQ(sigmaExcessText(covariance, effector, {11.0, 4.0, 0.25, {}}), "");
  EXPECT_EQ(sigmaExcessText(Matrix6d::Zero(), effector, {0.0, 0.0, 0.0, {}}), "");
}

}  // namespace
}  // namespace boresight::sessions
