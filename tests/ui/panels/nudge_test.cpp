// SPDX-License-Identifier: Apache-2.0
#include "ui/panels/nudge_controller.h"

#include <gtest/gtest.h>

#include "tests/support/random_pose.h"

namespace boresight::ui {
namespace {

using test::poseNear;

NudgeFrame frameOf(NudgeAxes axes, NudgePivot pivot) { return {axes, pivot, {0.1, -0.2, 0.05}}; }

constexpr NudgeAxes kAxes[] = {NudgeAxes::kCamera, NudgeAxes::kStation};
constexpr NudgePivot kPivots[] = {NudgePivot::kStationCentre, NudgePivot::kCameraCentre};

TEST(Nudge, GoesBetweenAnyTwoPoses) {
  Random random = test::randomFor("Nudge");
  for (const NudgeAxes axes : kAxes)
    for (const NudgePivot pivot : kPivots)
      for (int i = 0; i < 30; ++i) {
        const NudgeFrame frame = frameOf(axes, pivot);
        const Pose from = test::randomPose(random);
        const Pose to = test::randomPose(random);
        EXPECT_THAT(nudged(from, nudgeBetween(from, to, frame), frame), poseNear(to, 1e-9, 1e-9));
      }
}

TEST(Nudge, TurnsAboutAPivotThatStays) {
  Random random = test::randomFor("TurnsAboutAPivot");
  for (const NudgeAxes axes : kAxes)
    for (const NudgePivot pivot : kPivots) {
      const NudgeFrame frame = frameOf(axes, pivot);
      const Pose before = test::randomPose(random);
      Vector6d turn = Vector6d::Zero();
      turn.head<3>() = test::randomVector(random, 0.5);
      const Pose after = nudged(before, turn, frame);
      const Eigen::Vector3d pivot_in_station_m = pivot == NudgePivot::kStationCentre
                                                     ? frame.centre_in_station_m
                                                     : before.inverse().translation_m;
      EXPECT_LT((after * pivot_in_station_m - before * pivot_in_station_m).norm(), 1e-12);
      EXPECT_NEAR(rotationLog(after.rotation * before.rotation.conjugate()).norm(),
                  turn.head<3>().norm(), 1e-12);
    }
}

TEST(Nudge, MovesAlongTheAxesThatAreChosen) {
  Random random = test::randomFor("MovesAlong");
  const Pose before = test::randomPose(random);
  for (int axis = 0; axis < 3; ++axis) {
    Vector6d move = Vector6d::Zero();
    move[3 + axis] = 0.01;
    const Pose camera =
        nudged(before, move, frameOf(NudgeAxes::kCamera, NudgePivot::kStationCentre));
    EXPECT_LT((camera.translation_m - before.translation_m - move.tail<3>()).norm(), 1e-12);
    const Pose station =
        nudged(before, move, frameOf(NudgeAxes::kStation, NudgePivot::kStationCentre));
    const Eigen::Vector3d moved_in_station_m =
        before.rotation.conjugate() * (station.translation_m - before.translation_m);
    EXPECT_LT((moved_in_station_m - move.tail<3>()).norm(), 1e-12);
  }
}

}  // namespace
}  // namespace boresight::ui
