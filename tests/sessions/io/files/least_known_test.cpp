// SPDX-License-Identifier: Apache-2.0
#include "sessions/io/files/least_known.h"

#include <gtest/gtest.h>

#include <Eigen/Geometry>

#include "core/base/math.h"
#include "tests/support/random_pose.h"

namespace boresight::sessions {
namespace {

/// The covariance, about the camera's centre, of small independent errors and one large motion of
/// the station: (rotation, translation) about a point, in the camera frame.
Matrix6d covarianceOf(const Eigen::Vector3d& turn_rad, const Eigen::Vector3d& slide_m,
                      const Eigen::Vector3d& point_in_camera_m) {
  Vector6d motion;
  motion << turn_rad, slide_m - turn_rad.cross(point_in_camera_m);
  Matrix6d covariance = motion * motion.transpose();
  for (int i = 0; i < 6; ++i) covariance(i, i) += i < 3 ? 1e-8 : 1e-10;
  return covariance;
}

TEST(LeastKnown, TurnAboutAnAxisOfTheStation_IsNamed) {
  Random random = test::randomFor("LeastKnown.Turn");
  static constexpr const char* kAxes[] = {"x", "y", "z"};
  for (int trial = 0; trial < 30; ++trial) {
    const Pose pose = test::randomPose(random);
    const int axis = trial % 3;
    const Eigen::Vector3d turn = pose.rotation * Eigen::Vector3d::Unit(axis);
    const Matrix6d covariance = covarianceOf(4.6 * kDegree_rad * turn, Eigen::Vector3d::Zero(),
                                             test::randomPose(random).translation_m);
    EXPECT_EQ(leastKnownText(covariance, pose),
              std::string("4.6 deg (1 sigma) about the station's ") + kAxes[axis] + " axis");
  }
}

TEST(LeastKnown, SlideAlongADirection_IsNamed) {
  Random random = test::randomFor("LeastKnown.Slide");
  const Pose pose = test::randomPose(random);
  const Eigen::Vector3d slide = pose.rotation * Eigen::Vector3d(2.0, -1.0, 0.0).normalized();
  EXPECT_EQ(
      leastKnownText(covarianceOf(Eigen::Vector3d::Zero(), 0.012 * slide, {0.1, 0.2, 0.9}), pose),
      "12.0 mm (1 sigma) along the station's direction (0.89, -0.45, 0.00)");
}

TEST(LeastKnown, MotionsKnownAboutAsWell_AreNotNamed) {
  for (const double variance : {0.0, 1e-8, 1.0})
    EXPECT_EQ(leastKnownText(variance * Matrix6d::Identity(), Pose()), "") << variance;
  EXPECT_EQ(leastKnownText(Matrix6d::Constant(std::nan("")), Pose()), "");
  // 0.2 deg are too little to be named.
  EXPECT_EQ(leastKnownText(covarianceOf({0.2 * kDegree_rad, 0, 0}, {0, 0, 0}, {0, 0, 1}), Pose()),
            "");
}

}  // namespace
}  // namespace boresight::sessions
