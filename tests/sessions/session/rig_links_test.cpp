// SPDX-License-Identifier: Apache-2.0
#include "sessions/session/rig_links.h"

#include <gtest/gtest.h>

#include <string>
#include <utility>
#include <vector>

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

TEST(LinkOfTruths, NeedsBothAndMapsOneCameraIntoTheOther) {
  SessionCase one;
  SessionCase other;
  EXPECT_FALSE(linkOfTruths(one, other));
  one.camera_from_station_truth.emplace().translation_m = {0.1, 0.0, 0.0};
  EXPECT_FALSE(linkOfTruths(one, other));
  EXPECT_FALSE(linkOfTruths(other, one));
  other.camera_from_station_truth.emplace().translation_m = {0.4, 0.0, 0.0};
  ASSERT_TRUE(linkOfTruths(one, other));
  EXPECT_NEAR(linkOfTruths(one, other)->translation_m.x(), 0.3, 1e-12);
}

/// Three cases in one rig, one in another, one in none.
Session fiveCases() {
  Session session;
  const std::pair<const char*, const char*> rigs[] = {
      {"a", "arm"}, {"b", "arm"}, {"c", "mast"}, {"d", ""}, {"e", "arm"}};
  for (const auto& [id, rig] : rigs) {
    SessionCase session_case = inRig(rig, 0.0);
    session_case.id = id;
    if (session_case.rig->id.empty()) session_case.rig.reset();
    session.cases.push_back(session_case);
  }
  return session;
}

TEST(CasesOfRig, AreTheOthersOfTheSameRig) {
  const Session session = fiveCases();
  const std::vector<std::string> of_a = {"b", "e"};
  const std::vector<std::string> of_e = {"a", "b"};
  EXPECT_EQ(casesOfRig(session, "a"), of_a);
  EXPECT_EQ(casesOfRig(session, "e"), of_e);
  for (const char* alone : {"c", "d", "none"}) EXPECT_TRUE(casesOfRig(session, alone).empty());
}

TEST(OwnRunOf, IsTheLastWithoutAPartOfTheOtherCase) {
  Session session = fiveCases();
  EXPECT_EQ(ownRunOf(session, "b", "a"), nullptr);
  const auto add = [&session](const char* id, const char* digest, bool together) {
    RunRecord run;
    run.case_id = id;
    run.digest = digest;
    if (together) run.together = TogetherRecord{{{"b", "converged"}, {"a", "converged"}}, ""};
    session.runs.push_back(run);
  };
  add("b", "1", true);
  EXPECT_EQ(ownRunOf(session, "b", "a"), nullptr);
  add("b", "2", false);
  add("b", "3", false);
  add("b", "4", true);
  add("e", "5", false);
  ASSERT_NE(ownRunOf(session, "b", "a"), nullptr);
  EXPECT_EQ(ownRunOf(session, "b", "a")->digest, "3");
  EXPECT_EQ(ownRunOf(session, "b", "e")->digest, "4") << "of another pair";
}

TEST(RigLink, NewRig_HasANameOfItsOwn) {
  Session session = fiveCases();
  const auto name = [&session](const char* id) { return session.findCase(id)->rig->id; };
  session = withChanged(session, "c", [](SessionCase& item) { item.rig->id = "d"; });
  session = withRigLink(session, "d", "e", Pose());
  EXPECT_EQ(name("d"), "d-2");
  EXPECT_EQ(name("e"), "d-2");
  EXPECT_EQ(name("a"), "arm") << "two of the former rig remain";
  session = withChanged(session, "b", [](SessionCase& item) { item.rig->id = "x-2"; });
  session = withoutRigLink(session, "b");
  EXPECT_FALSE(session.findCase("b")->rig);
}

}  // namespace
}  // namespace boresight::sessions
