// SPDX-License-Identifier: Apache-2.0
#include "sessions/session/rig_links.h"

#include <gtest/gtest.h>

namespace boresight::sessions {
namespace {

SessionCase cameraIn(const std::string& frame, double x_m) {
  SessionCase session_case;
  session_case.camera_reference.emplace();
  session_case.camera_reference->frame.name = frame;
  session_case.camera_reference->camera_from_reference.translation_m = {-x_m, 0.0, 0.0};
  return session_case;
}

TEST(LinkOfLabels, IsBetweenCamerasInOneNamedFrame) {
  const auto link = linkOfLabels(cameraIn("ROVER_FRAME", 0.0), cameraIn("ROVER_FRAME", 0.2));
  ASSERT_TRUE(link);
  EXPECT_LT((link->translation_m - Eigen::Vector3d(-0.2, 0.0, 0.0)).norm(), 1e-12);
}

TEST(LinkOfLabels, IsNothingAcrossFramesOrWithoutAName) {
  EXPECT_FALSE(linkOfLabels(cameraIn("ROVER_FRAME", 0.0), cameraIn("SITE_FRAME", 0.2)));
  EXPECT_FALSE(linkOfLabels(cameraIn("", 0.0), cameraIn("", 0.2)));
  EXPECT_FALSE(linkOfLabels(SessionCase(), cameraIn("ROVER_FRAME", 0.2)));
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
