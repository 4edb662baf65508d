// SPDX-License-Identifier: Apache-2.0
#include "core/views/joint_competing_poses.h"

#include <array>
#include <vector>

#include <gtest/gtest.h>

#include "tests/core/localizer/scene.h"

namespace boresight::test {
namespace {

/// A pose found at 0.4 m, seen by a camera in the first view's place and by one next to it.
struct JointCompetingPosesTest : testing::Test {
  Case scene = stationCase(1);
  Pose found = scene.truth;  // first_from_station
  Pose second_from_first{rotationExp({0.02, -0.2, 0.03}), {0.09, 0.005, 0.01}};
  std::vector<CompetingPose> first, second;

  Pose slid(double x_m) const {
    Pose pose = found;
    pose.translation_m.x() += x_m;
    return pose;
  }
  JointCompetingPoses joint() const {
    const std::array<CompetingPosesOfView, 2> views = {
        CompetingPosesOfView{first, Pose(), &scene.camera},
        CompetingPosesOfView{second, second_from_first, &scene.camera}};
    return jointCompetingPoses(views, found, matchedBounds(scene.solid.view()));
  }
};

TEST_F(JointCompetingPosesTest, PoseThatCompetesInBothViews_HasTheSumOfMargins) {
  first = {{slid(0.02), 0.9, 4.0}};
  second = {{second_from_first * slid(-0.02), 0.7, -8.0},
            {second_from_first * slid(0.021), 0.8, -1.5}};
  const JointCompetingPoses poses = joint();
  ASSERT_EQ(poses.size(), 1);
  EXPECT_DOUBLE_EQ(poses[0].margin_nats, 2.5);
  EXPECT_DOUBLE_EQ(poses[0].similarity, 0.8);
  EXPECT_NEAR(poses[0].camera_from_station.translation_m.x(), slid(0.02).translation_m.x(), 1e-12);
}

CompetingPose mirrorImage(const Pose& found, double margin_nats) {
  CompetingPose mirror{found, 0.0, margin_nats};
  mirror.mirrored = true;
  return mirror;
}

TEST_F(JointCompetingPosesTest, PoseInOneViewOnly_DoesNotCompete) {
  first = {{slid(0.02), 0.9, -4.0}};
  second = {{second_from_first * slid(0.03), 0.8, -1.5}};
  EXPECT_EQ(joint().size(), 0) << "the other view excludes it";
  first.clear();
  second = {{second_from_first * slid(0.02), 0.8, -1.5}};
  EXPECT_EQ(joint().size(), 0);
  first = {{slid(0.02), 0.9, 4.0}};
  second = {mirrorImage(second_from_first * slid(0.02), -2.0)};
  EXPECT_EQ(joint().size(), 0) << "a mirror image is not a pose of the mesh";
}

TEST_F(JointCompetingPosesTest, MirrorImage_CompetesWhereEveryViewShowsIt) {
  first = {mirrorImage(found, -5.0)};
  second = {{second_from_first * slid(0.001), 0.7, -8.0},
            mirrorImage(second_from_first * found, -2.0)};
  ASSERT_EQ(joint().size(), 1);
  EXPECT_TRUE(joint()[0].mirrored);
  EXPECT_DOUBLE_EQ(joint()[0].margin_nats, -7.0);
  second.pop_back();
  EXPECT_EQ(joint().size(), 0);
}

}  // namespace
}  // namespace boresight::test
