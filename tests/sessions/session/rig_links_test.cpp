// SPDX-License-Identifier: Apache-2.0
#include "sessions/session/rig_links.h"

#include <gtest/gtest.h>

#include <stdexcept>

namespace boresight::sessions {
namespace {

Pose somePose(double x_m) {
  Pose pose;
  pose.rotation = Eigen::Quaterniond(0.9, 0.1, -0.2, 0.3).normalized();
  pose.translation_m = {x_m, 0.02, -0.01};
  return pose;
}

Session threeCases() {
  Session session;
  for (const char* id : {"left", "right", "top"}) {
    SessionCase one;
    one.id = id;
    session = withCase(session, one);
  }
  return session;
}

Pose between(const Session& session, const char* to, const char* from) {
  return session.findCase(to)->rig->camera_from_rig *
         session.findCase(from)->rig->camera_from_rig.inverse();
}

void expectNear(const Pose& a, const Pose& b) {
  EXPECT_LT((a.translation_m - b.translation_m).norm(), 1e-12);
  EXPECT_LT(a.rotation.angularDistance(b.rotation), 1e-12);
}

TEST(RigLinks, TheCameraThatIsLinkedLiesWhereItWasSaidFromTheOther) {
  Session session = withRigLink(threeCases(), "left", "right", somePose(0.1));
  EXPECT_EQ(casesOfRig(session, "left"), std::vector<std::string>{"right"});
  expectNear(between(session, "right", "left"), somePose(0.1));
  // A third one linked to the second is linked to the first as well.
  session = withRigLink(session, "right", "top", somePose(-0.3));
  EXPECT_EQ(casesOfRig(session, "left"), (std::vector<std::string>{"right", "top"}));
  expectNear(between(session, "top", "right"), somePose(-0.3));
  expectNear(between(session, "top", "left"), somePose(-0.3) * somePose(0.1));
}

TEST(RigLinks, ALinkThatIsDroppedLeavesTheOthersAndARigOfOneIsNone) {
  Session session = withRigLink(threeCases(), "left", "right", somePose(0.1));
  session = withRigLink(session, "left", "top", Pose());
  session = withoutRigLink(session, "left");
  EXPECT_FALSE(session.findCase("left")->rig);
  EXPECT_EQ(casesOfRig(session, "right"), std::vector<std::string>{"top"});
  session = withoutRigLink(session, "top");
  for (const auto& one : session.cases) EXPECT_FALSE(one->rig) << one->id;
  EXPECT_EQ(withoutRigLink(session, "top"), session);
}

TEST(RigLinks, ANewRigDoesNotTakeTheNameOfAnother) {
  Session session = withRigLink(threeCases(), "left", "right", Pose());
  session = withoutRigLink(withRigLink(session, "left", "top", Pose()), "left");
  ASSERT_EQ(session.findCase("top")->rig->id, "left");
  SessionCase fourth;
  fourth.id = "fourth";
  session = withRigLink(withCase(session, fourth), "left", "fourth", Pose());
  EXPECT_EQ(casesOfRig(session, "left"), std::vector<std::string>{"fourth"});
}

TEST(RigLinks, NonsenseIsRefused) {
  Pose broken;
  broken.translation_m.x() = std::numeric_limits<double>::quiet_NaN();
  const Session session = threeCases();
  EXPECT_THROW(withRigLink(session, "left", "left", Pose()), std::invalid_argument);
  EXPECT_THROW(withRigLink(session, "left", "none", Pose()), std::invalid_argument);
  EXPECT_THROW(withRigLink(session, "left", "right", broken), std::invalid_argument);
}

}  // namespace
}  // namespace boresight::sessions
