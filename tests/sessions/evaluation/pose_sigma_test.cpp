// SPDX-License-Identifier: Apache-2.0
#include "sessions/evaluation/pose_sigma.h"

#include <gtest/gtest.h>

#include <cmath>
#include <limits>

#include "sessions/evaluation/pose_error.h"
#include "sessions/evaluation/requirement_share.h"
#include "tests/support/random_pose.h"

namespace boresight::sessions {
namespace {

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
    Vector6d unit;
    for (int axis = 0; axis < 6; ++axis) unit[axis] = random.normal();
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
