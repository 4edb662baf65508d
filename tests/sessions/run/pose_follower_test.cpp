// SPDX-License-Identifier: Apache-2.0
#include "sessions/run/pose_follower.h"

#include <gtest/gtest.h>

namespace boresight::sessions {
namespace {

DeclaredUncertainty box(double size_m, double size_deg, UncertaintyPivot pivot) {
  DeclaredUncertainty uncertainty;
  uncertainty.translation_m.setConstant(size_m);
  uncertainty.rotation_deg.setConstant(size_deg);
  uncertainty.pivot = pivot;
  return uncertainty;
}

const DeclaredUncertainty kFirst = box(0.03, 5.0, UncertaintyPivot::kCamera);
const DeclaredUncertainty kMotion = box(0.005, 1.0, UncertaintyPivot::kStation);

Pose at(double z_m) {
  Pose pose;
  pose.translation_m.z() = z_m;
  return pose;
}

TEST(PoseFollower, UntilAFirstPose_FramesStartFromTheFirstSeed) {
  PoseFollower follower(at(0.5), kFirst, kMotion);
  for (int i = 0; i < 3; ++i) {
    EXPECT_EQ(follower.camera_from_station(), at(0.5));
    EXPECT_EQ(follower.uncertainty(), kFirst);
    follower.take(std::nullopt);
  }
}

/// 10 mm and 2 deg, 20 mm and 4 deg; 40 mm would exceed the first seed's.
TEST(PoseFollower, AcceptedPose_IsTheNextSeedWithTheMotionWhichLostFramesDouble) {
  PoseFollower follower(at(0.5), kFirst, kMotion);
  follower.take(at(0.49));
  EXPECT_EQ(follower.camera_from_station(), at(0.49));
  EXPECT_EQ(follower.uncertainty(), kMotion);
  follower.take(std::nullopt);
  EXPECT_EQ(follower.uncertainty(), box(0.01, 2.0, UncertaintyPivot::kStation));
  follower.take(std::nullopt);
  EXPECT_EQ(follower.uncertainty(), box(0.02, 4.0, UncertaintyPivot::kStation));
  for (int i = 0; i < 100; ++i) {
    follower.take(std::nullopt);
    EXPECT_EQ(follower.uncertainty(), kFirst);
    EXPECT_EQ(follower.camera_from_station(), at(0.49));
  }
  follower.take(at(0.47));
  EXPECT_EQ(follower.uncertainty(), kMotion);
}

}  // namespace
}  // namespace boresight::sessions
