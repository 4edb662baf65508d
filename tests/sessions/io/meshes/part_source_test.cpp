// SPDX-License-Identifier: Apache-2.0
#include "sessions/io/meshes/part_source.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <nlohmann/json.hpp>

#include "sessions/io/files/errors.h"
#include "sessions/io/json/json_reader.h"
#include "tests/sessions/io/cameras/joined_frames.h"
#include "tests/support/matchers.h"
#include "tests/support/random_pose.h"
#include "tests/support/temporary_folder.h"

namespace boresight::sessions {
namespace {

using test::joining;
using test::randomPose;

const FrameName kArmBase{"ARM_BASE", {}};
const FrameName kFinger{"FINGER", {2}};

PartSource occluderIn(const FrameName& frame) {
  PartSource part;
  part.mesh = "/station/gripper.ply";
  part.frame = frame;
  part.state.role = PartRole::kOccludes;
  return part;
}

TEST(PartState, Changes_AreOfRolesAndOfPresence) {
  const PartState occluder{PartRole::kOccludes, true};
  EXPECT_EQ(changedState(occluder, "off"), (PartState{PartRole::kOccludes, false}));
  EXPECT_EQ(changedState({PartRole::kOccludes, false}, "on"), occluder);
  EXPECT_EQ(changedState({PartRole::kMatched, false}, "occludes"), occluder);
  EXPECT_EQ(changedState(occluder, "matched"), PartState());
  EXPECT_EQ(changedState(occluder, "ignored"), (PartState{PartRole::kIgnored, true}));
  for (const char* other : {"", "Off", "match", "occludes "})
    EXPECT_EQ(changedState(occluder, other), std::nullopt) << other;
  EXPECT_EQ(partStateText(occluder), "occludes");
  EXPECT_EQ(partStateText({PartRole::kMatched, false}), "off");
  EXPECT_TRUE(PartState().used() && PartState().matched());
  EXPECT_FALSE(PartState({PartRole::kMatched, false}).matched());
  EXPECT_FALSE(PartState({PartRole::kIgnored, true}).used());
}

TEST(PartSource, Name_IsTheFilesStemByDefault) {
  PartSource part = occluderIn(kStationFrame);
  EXPECT_EQ(partName(part), "gripper");
  part.name = "left hand";
  part.state.present = false;
  EXPECT_EQ(partText(part), "left hand: occludes, fixed to STATION, off");
}

TEST(PartOfName, RefusesAmbiguousNames) {
  std::vector<PartSource> parts(3, occluderIn(kStationFrame));
  parts[1].name = "lid";
  EXPECT_EQ(partOfName(parts, "lid", "d.json", "state"), 1u);
  EXPECT_THAT(test::TemporaryFolder().message(
                  [&] { (void)partOfName(parts, "gripper", "d.json", "state"); }),
              HasSubstr("several parts are called 'gripper'"));
}

TEST(PlacedPart, ChainLeadsToTheFrameThatThePartMovesWith) {
  Random random = test::randomFor("PlacedPart");
  const Pose camera_from_effector = randomPose(random);
  const Pose finger_from_effector = randomPose(random);
  const Pose base_from_station = randomPose(random);
  // The camera on an arm whose telemetry joins it to the station.
  const FrameTree arm({joining(kCameraFrame, kEndEffectorFrame, camera_from_effector),
                       joining(kFinger, kEndEffectorFrame, finger_from_effector),
                       joining(kEndEffectorFrame, kArmBase, randomPose(random)),
                       joining(kArmBase, kStationFrame, base_from_station),
                       joining(kStationFrame, {"DECK", {}}, randomPose(random))});
  PartSource part = occluderIn(kFinger);
  part.frame_from_mesh = randomPose(random);
  const PartSource finger = placedPart(part, arm);
  EXPECT_EQ(finger.frame, kCameraFrame);
  const Pose expected =
      camera_from_effector * finger_from_effector.inverse() * part.frame_from_mesh;
  const Eigen::Vector3d point_m(0.1, -0.2, 0.3);
  EXPECT_TRUE((finger.frame_from_mesh * point_m).isApprox(expected * point_m, 1e-12));
  EXPECT_EQ(placedPart(occluderIn({"DECK", {}}), arm).frame, kStationFrame);
  EXPECT_EQ(placedPart(occluderIn(kArmBase), arm).frame, kStationFrame);
  for (const FrameName& fixed : {kStationFrame, kCameraFrame}) {
    part.frame = fixed;
    EXPECT_EQ(placedPart(part, FrameTree()), part) << "it keeps its bits";
  }
  // As many transforms to either side.
  const FrameTree even({joining(kCameraFrame, kArmBase, randomPose(random)),
                        joining(kArmBase, kStationFrame, base_from_station)});
  EXPECT_THAT(partConcern(occluderIn(kArmBase), even).reason,
              HasSubstr("as many transforms from CAMERA as from STATION"));
}

TEST(PlacedPart, FrameThatIsNotJoined_IsRefused) {
  EXPECT_EQ(
      test::TemporaryFolder().message([] { (void)placedPart(occluderIn(kFinger), FrameTree()); }),
      "/station/gripper.ply: frame: FINGER (2) is joined to neither CAMERA nor STATION: add "
      "the transform that joins it (--frames, or transforms of dataset.json)");
}

TEST(PartFrame, Json_RoundTrips) {
  for (const FrameName& frame : {kCameraFrame, kFinger})
    EXPECT_EQ(readPartFrame(JsonReader("f.json", partFrameJson(frame), "frame")), frame);
  EXPECT_EQ(partFrameJson(kCameraFrame), "CAMERA");
}

}  // namespace
}  // namespace boresight::sessions
