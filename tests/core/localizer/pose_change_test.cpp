// SPDX-License-Identifier: Apache-2.0
#include "core/localizer/pose_change.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

#include "tests/support/random_pose.h"

namespace boresight {
namespace {

using test::randomCameraFromStation;
using test::randomFor;
using test::randomOffset;

Camera pinhole() { return test::makePinhole(640, 480, 500.0); }

TEST(PoseChange, Translation_IsMeasuredAtTheChosenPoint) {
  const BoundingBox scene{{0.9, -0.1, -0.1}, {1.1, 0.1, 0.1}};  // a metre from the origin
  const Pose before;
  Pose turned;
  turned.rotation = rotationExp(Eigen::Vector3d(0.0, 0.0, kPi / 2.0));
  const Camera camera = pinhole();
  const Eigen::Vector3d end_effector_in_camera_m{0.3, 0.4, 2.0};
  LocalizerOptions options;
  const RunContext run{options, camera, scene, {}, end_effector_in_camera_m};
  const auto translation_m = [&](CorrectionPoint point) {
    options.loop.correction_point = point;
    return translationBetween_m(before, turned, run);
  };
  EXPECT_NEAR(translation_m(CorrectionPoint::kCamera), 0.0, 1e-15);
  EXPECT_NEAR(translation_m(CorrectionPoint::kStation), std::sqrt(2.0), 1e-12);
  // Half a metre from the axis, turned by a quarter.
  EXPECT_NEAR(translation_m(CorrectionPoint::kEndEffector), 0.5 * std::sqrt(2.0), 1e-12);
  EXPECT_NEAR(rotationBetween_rad(before, turned), kPi / 2.0, 1e-12);
}

/// 3 and 4 mm across the view at 2 m: 0.75 and 1 px.
TEST(PoseChange, MotionWithinAnUncertainty_AddsTheSquaresOfItsAxes) {
  const BoundingBox scene{{-0.1, -0.1, 0.0}, {0.1, 0.1, 0.0}};
  Seed seed;
  seed.camera_from_station.translation_m = {0.0, 0.0, 2.0};
  seed.uncertainty.translation_m = {0.003, 0.004, 0.0};
  seed.uncertainty.rotation_rad.setZero();
  EXPECT_NEAR(motionWithin_px(seed, scene, pinhole()), 1.25, 1e-12);
  // A corner 0.1 sqrt(2) m from the pivot moves by that times the angle.
  seed.uncertainty.translation_m.setZero();
  seed.uncertainty.rotation_rad = {0.0, 0.0, 0.001};
  seed.uncertainty.pivot_in_camera_m = {0.0, 0.0, 2.0};
  EXPECT_NEAR(motionWithin_px(seed, scene, pinhole()), 250.0 * 0.1 * std::sqrt(2.0) * 0.001, 1e-6);
}

TEST(PoseChange, DisplacementAcrossTheView_IsFocalLengthOverDepth) {
  // Flat, so that every corner is two metres away.
  const BoundingBox scene{{-0.1, -0.1, 0.0}, {0.1, 0.1, 0.0}};
  Pose before;
  before.translation_m = {0.0, 0.0, 2.0};
  Pose after = before;
  after.translation_m.x() += 0.004;
  EXPECT_NEAR(displacementBetween_px(before, after, scene, pinhole()), 500.0 * 0.004 / 2.0, 1e-12);
  after.translation_m.z() = -2.0;
  EXPECT_EQ(displacementBetween_px(before, after, scene, pinhole()), 1e6);
}

TEST(PoseChange, Roll_KeepsTheCentreOfTheScene) {
  Random random = randomFor("PoseChange.Rolling");
  for (int trial = 0; trial < 100; ++trial) {
    const Pose before = randomCameraFromStation(random, 0.5, 0.3);
    const double roll_rad = random.uniform(-3.0, 3.0);
    const BoundingBox scene{Eigen::Vector3d::Constant(-0.05), Eigen::Vector3d::Constant(0.05)};
    const Pose rolled = rolledAboutScene(before, roll_rad, scene);
    EXPECT_LT((rolled * scene.centre() - before * scene.centre()).norm(), 1e-14);
    EXPECT_NEAR(rotationBetween_rad(before, rolled), std::abs(roll_rad), 1e-12);
  }
}

TEST(PoseChange, PosesInsideTheUncertainty_StayAndOthersMoveToItsEdge) {
  Random random = randomFor("PoseChange.Uncertainty");
  Seed seed;
  seed.uncertainty.translation_m = {0.01, 0.02, 0.03};
  seed.uncertainty.rotation_rad = {0.05, 0.1, 0.15};
  Vector6d limits;
  limits << seed.uncertainty.rotation_rad, seed.uncertainty.translation_m;
  for (int trial = 0; trial < 200; ++trial) {
    seed.camera_from_station = randomCameraFromStation(random, 0.5);
    Eigen::Vector3d& pivot = seed.uncertainty.pivot_in_camera_m;
    pivot =
        trial % 2 == 0 ? Eigen::Vector3d::Zero() : seed.camera_from_station.translation_m.eval();
    const double scale = random.uniform(0.1, 3.0);
    const Vector6d offset = scale * randomOffset(random, seed.uncertainty);
    const Pose pose = displacedAboutPivot(seed.camera_from_station, offset, pivot);
    const double most = offset.cwiseAbs().cwiseQuotient(limits).maxCoeff();  // in half-widths
    EXPECT_FALSE(leftUncertainty(seed, pose, most * 1.000001));
    EXPECT_TRUE(leftUncertainty(seed, pose, most * 0.99));
    const Pose back = pulledBack(seed, pose);
    if (most < 1.0) {
      EXPECT_EQ(back, pose);
    } else {
      EXPECT_FALSE(leftUncertainty(seed, back, 1.000001));
      const Vector6d clamped = offset.cwiseMax(-limits).cwiseMin(limits);
      EXPECT_THAT(
          back, test::poseNear(displacedAboutPivot(seed.camera_from_station, clamped, pivot), 1e-9,
                               1e-12));
    }
  }
}

}  // namespace
}  // namespace boresight
