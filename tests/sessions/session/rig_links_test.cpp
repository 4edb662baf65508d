// SPDX-License-Identifier: Apache-2.0
#include "sessions/session/rig_links.h"

#include <gtest/gtest.h>

#include "tests/sessions/session/example_session.h"

namespace boresight::sessions {
namespace {

using test::shifted;

SessionCase cameraIn(const std::string& frame, double x_m) {
  SessionCase session_case;
  session_case.camera_reference.emplace();
  session_case.camera_reference->frame.name = frame;
  session_case.camera_reference->camera_from_reference.translation_m = {-x_m, 0.0, 0.0};
  return session_case;
}

void expectLink(const SessionCase& one, const SessionCase& other, double x_m,
                const std::string& frame) {
  const auto link = linkOfFrames(one, other);
  ASSERT_TRUE(link);
  EXPECT_EQ(link->frame.name, frame);
  EXPECT_LT((link->other_from_case.translation_m - Eigen::Vector3d(x_m, 0.0, 0.0)).norm(), 1e-12);
}

TEST(LinkOfFrames, IsBetweenCamerasInOneNamedFrame) {
  expectLink(cameraIn("ROVER_FRAME", 0.0), cameraIn("ROVER_FRAME", 0.2), -0.2, "ROVER_FRAME");
  EXPECT_FALSE(linkOfFrames(cameraIn("ROVER_FRAME", 0.0), cameraIn("SITE_FRAME", 0.2)));
  EXPECT_FALSE(linkOfFrames(cameraIn("", 0.0), cameraIn("", 0.2)));
  EXPECT_FALSE(linkOfFrames(SessionCase(), cameraIn("ROVER_FRAME", 0.2)));
}

/// A camera on an arm: where its wrist is in the rover's frame.
SessionCase onArm(double wrist_in_rover_m) {
  const FrameName wrist{"WRIST", {}};
  SessionCase session_case;
  session_case.frames = {shifted(kCameraFrame, wrist, 0.05),
                         shifted(wrist, {"ROVER", {}}, -wrist_in_rover_m),
                         shifted(kEndEffectorFrame, kCameraFrame, 0.01)};
  return session_case;
}

/// The wrist moves with the camera: the rover's frame, beyond it, joins the two images.
TEST(LinkOfFrames, IsByTheFrameFarthestFromTheCameraWithoutPassingTheStation) {
  SessionCase first = onArm(0.0);
  SessionCase second = onArm(0.3);
  expectLink(first, second, -0.3, "ROVER");
  // A part is placed in the station's frame, which the telemetry joins with the rover's.
  double station_in_rover_m = 0.7;
  for (SessionCase* each : {&first, &second}) {
    each->frames.push_back(shifted({"ROVER", {}}, kStationFrame, station_in_rover_m));
    each->frames.push_back(shifted(kStationFrame, {"PART", {}}, 0.02));
    station_in_rover_m += 0.01;  // as another seed says
  }
  expectLink(first, second, -0.3, "ROVER");
}

SessionCase inRig(const std::string& name, double x_m) {
  SessionCase session_case;
  session_case.rig.emplace();
  session_case.rig->id = name;
  session_case.rig->camera_from_rig.translation_m = {-x_m, 0.0, 0.0};
  return session_case;
}

TEST(LinkOfRig, IsBetweenCamerasOfOneRig) {
  const auto link = linkOfRig(inRig("arm", 0.1), inRig("arm", 0.3));
  ASSERT_TRUE(link);
  EXPECT_LT((link->translation_m - Eigen::Vector3d(-0.2, 0.0, 0.0)).norm(), 1e-12);
  EXPECT_FALSE(linkOfRig(inRig("arm", 0.1), inRig("mast", 0.3)));
  EXPECT_FALSE(linkOfRig(SessionCase(), inRig("arm", 0.3)));
}

}  // namespace
}  // namespace boresight::sessions
