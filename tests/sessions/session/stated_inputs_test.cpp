// SPDX-License-Identifier: Apache-2.0
#include "sessions/session/stated_inputs.h"

#include <gtest/gtest.h>

#include "sessions/io/cameras/frame_tree.h"
#include "sessions/io/files/errors.h"
#include "tests/sessions/session/example_session.h"

namespace boresight::sessions {
namespace {

using test::shifted;

Session oneCase() {
  Session session;
  SessionCase session_case;
  session_case.id = "a";
  session_case.requirement.emplace().lateral_mm = 1.0;
  session.cases.push_back(session_case);
  return session;
}

TEST(StatedInputs, WhatIsNotStatedStays) {
  StatedInputs stated;
  EXPECT_TRUE(stated.empty());
  EXPECT_TRUE(withStated(oneCase(), "a", stated) == oneCase());
  stated.camera_from_end_effector.emplace().translation_m = {0.0, 0.0, 0.3};
  const Session next = withStated(oneCase(), "a", stated);
  EXPECT_EQ(next.cases[0]->camera_from_end_effector, stated.camera_from_end_effector);
  EXPECT_EQ(next.cases[0]->requirement, oneCase().cases[0]->requirement);
  EXPECT_THROW((void)withStated(oneCase(), "b", stated), InputError);
}

TEST(StatedInputs, SymmetriesAreStatedAndTakenBack) {
  StatedInputs stated;
  stated.symmetries = symmetriesIn("z 90");
  EXPECT_FALSE(stated.empty());
  const Session next = withStated(oneCase(), "a", stated);
  EXPECT_EQ(next.cases[0]->symmetries.discrete.size(), 3u);
  EXPECT_EQ(inputsDigest(*next.cases[0]), inputsDigest(*oneCase().cases[0]))
      << "no run depends on them";
  SessionCase other = *next.cases[0];
  other.id = "b";
  const Session two = withSymmetries(withCase(next, other), "b", symmetriesIn("z"));
  for (const auto& session_case : two.cases)
    EXPECT_EQ(symmetriesText(session_case->symmetries), "z") << "of the same mesh";
  stated.symmetries = symmetriesIn("none");
  EXPECT_FALSE(stated.empty());
  EXPECT_TRUE(withStated(next, "a", stated) == oneCase());
}

TEST(StatedInputs, TransformsGiveTheEndEffectorAndReplaceFormerOnes) {
  StatedInputs stated;
  stated.frames = {shifted(kCameraFrame, kEndEffectorFrame, 0.1)};
  Session session = withStated(oneCase(), "a", stated);
  EXPECT_NEAR(session.cases[0]->camera_from_end_effector->translation_m.x(), 0.1, 1e-12);
  EXPECT_EQ(session.cases[0]->frames[0].file, "/folder/t.json") << "its bytes belong to the case";
  // The other way round is the same two frames.
  stated.frames = {shifted(kEndEffectorFrame, kCameraFrame, -0.4)};
  session = withStated(session, "a", stated);
  EXPECT_EQ(session.cases[0]->frames.size(), 1u);
  EXPECT_NEAR(session.cases[0]->camera_from_end_effector->translation_m.x(), 0.4, 1e-12);
}

TEST(StatedInputs, LoopIsRefused) {
  const FrameName arm{"ARM_BASE", {}};
  StatedInputs stated;
  stated.frames = {shifted(kCameraFrame, kEndEffectorFrame, 0.1),
                   shifted(arm, kEndEffectorFrame, 0.2), shifted(arm, kCameraFrame, 0.7)};
  EXPECT_THROW((void)withStated(oneCase(), "a", stated), InputError);
}

TEST(InputSigmas, OnlyAChangedMemberIsWrittenToOtherCases) {
  Session session = oneCase();
  SessionCase other = *session.cases[0];
  other.id = "b";
  other.mesh_scale_sigma = 1e-3;
  other.calibration_sigma = StatedCalibration{std::nullopt, 0.7};
  session.cases.push_back(other);
  EXPECT_TRUE(withInputSigmas(session, "a", {}, {}) == session);
  const Session focal = withInputSigmas(session, "a", {}, StatedCalibration{1e-3, std::nullopt});
  EXPECT_EQ(focal.cases[0]->calibration_sigma, (StatedCalibration{1e-3, std::nullopt}));
  EXPECT_EQ(focal.cases[1]->calibration_sigma, (StatedCalibration{1e-3, 0.7}));
  EXPECT_EQ(focal.cases[1]->mesh_scale_sigma, 1e-3);
  EXPECT_TRUE(withInputSigmas(focal, "a", {}, {}) == session);
  const Session scale = withInputSigmas(session, "a", 2e-3, {});
  EXPECT_EQ(scale.cases[1]->mesh_scale_sigma, 2e-3);
  EXPECT_EQ(scale.cases[1]->calibration_sigma, other.calibration_sigma);
  EXPECT_FALSE(withInputSigmas(scale, "b", 2e-3, {}).cases[0]->calibration_sigma);
}

}  // namespace
}  // namespace boresight::sessions
