// SPDX-License-Identifier: Apache-2.0
#include "sessions/io/cameras/pose_text.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <array>

#include "tests/support/random_pose.h"

namespace boresight::sessions {
namespace {

TEST(PoseText, ReadsBackWhatItWrites) {
  Random random = test::randomFor("PoseText");
  for (int i = 0; i < 50; ++i) {
    const Pose pose = test::randomPose(random);
    for (const PoseForm form :
         {PoseForm::kRotationVector, PoseForm::kQuaternion, PoseForm::kMatrix}) {
      const std::string text = poseText(pose, form);
      const ParsedPose parsed = parsePose(text, guessReading(text));
      ASSERT_TRUE(parsed.valid) << text << '\n' << parsed.problem;
      EXPECT_EQ(parsed.form, form);
      EXPECT_THAT(parsed.camera_from_station, test::poseNear(pose, 1e-12, 1e-12)) << text;
    }
  }
}

TEST(PoseText, ShowsQuaternionsWithWNotNegative) {
  Random random = test::randomFor("ShowsQuaternions");
  for (int i = 0; i < 50; ++i) {
    const Eigen::Quaterniond q = test::randomRotation(random);
    EXPECT_GE(shownQuaternion(q).w(), 0.0);
    const Eigen::Quaterniond negative(-q.coeffs());
    EXPECT_EQ(shownQuaternion(q).coeffs(), shownQuaternion(negative).coeffs());
  }
  EXPECT_EQ(shownQuaternion(Eigen::Quaterniond(0.0, -1.0, 0.0, 0.0)).x(), 1.0);
}

TEST(ParsePose, OrderDirectionAndUnit_AreApplied) {
  // A quarter turn about z, then 1, 2, 3 mm.
  PoseReading reading;
  reading.millimetres = true;
  const std::string rows = "0 -1 0 1; 1 0 0 2; 0 0 1 3; 0 0 0 1";
  const ParsedPose plain = parsePose(rows, reading);
  ASSERT_TRUE(plain.valid) << plain.problem;
  EXPECT_EQ(plain.camera_from_station.translation_m, Eigen::Vector3d(1e-3, 2e-3, 3e-3));
  EXPECT_NEAR((plain.camera_from_station.rotation * Eigen::Vector3d::UnitX()).y(), 1.0, 1e-12);

  const std::string columns = "0 1 0 0, -1 0 0 0, 0 0 1 0, 1 2 3 1";
  EXPECT_FALSE(parsePose(columns, reading).valid);
  EXPECT_TRUE(guessReading(columns).column_major);
  reading.column_major = true;
  const auto expectRead = [&](const std::string& text, const Pose& expected, double rotation_rad) {
    EXPECT_THAT(parsePose(text, reading).camera_from_station,
                test::poseNear(expected, rotation_rad, 1e-12));
  };
  const Pose& pose = plain.camera_from_station;
  expectRead(columns, pose, 1e-12);
  expectRead("0 1 0  -1 0 0  0 0 1  1 2 3", pose, 1e-12);

  reading.column_major = false;
  reading.station_from_camera = true;
  expectRead(rows, pose.inverse(), 1e-12);

  reading.station_from_camera = false;
  const std::string half = std::to_string(std::sqrt(0.5));
  reading.xyzw = true;
  expectRead("0 0 " + half + " " + half + " 1 2 3", pose, 1e-6);
  reading.xyzw = false;
  expectRead(half + " 0 0 " + half + " 1 2 3", pose, 1e-6);
  expectRead("0 0 90 1e0 +2 3", pose, 1e-12);
}

TEST(ParsePose, LeavesOutDigitsThatBelongToNames) {
  const ParsedPose parsed = parsePose("pose_2 of cam0: r=[0,0,0] t=[0.1,0.2,0.3]", PoseReading());
  ASSERT_TRUE(parsed.valid) << parsed.problem;
  EXPECT_EQ(parsed.camera_from_station.translation_m, Eigen::Vector3d(0.1, 0.2, 0.3));
}

TEST(ParsePose, RefusesWhatIsNoRotation) {
  for (const auto& [text, problem] :
       std::vector<std::array<const char*, 2>>{{"1.001 0 0 0 0 1 0 0 0 0 1 0", "not a rotation"},
                                               {"-1 0 0 0 0 1 0 0 0 0 1 0", "mirrors"},
                                               {"1 0 0 0.02 0 0 0", "unit length (it is 1.0002)"},
                                               {"1 0 0 0 0 1 0 0 0 0 1 0 0 0 0 2", "last row"},
                                               {"1 2 3", "holds 3 numbers"},
                                               {"", "holds 0 numbers"},
                                               {"0 0 0 1e300 0 0", "translation"},
                                               {"nan 0 0 0 0 0", "numbers"}})
    EXPECT_NE(parsePose(text, {}).problem.find(problem), std::string::npos) << text;
}

/// As text processors and PDF files have signs, and programs of countries with decimal commas.
TEST(ParsePose, SignsAndCommasOfOtherTexts_AreNamed) {
  const auto problem = [](std::string_view text) { return parsePose(text, {}).problem; };
  for (const char* text :
       {"0 0 0 \u22120.5 0 1", "0 0 0 \u20130.5 0 1", "0 0 0 \uff0d.5 0 1", "0 0 0 0\u00b75 0 1"})
    EXPECT_EQ(problem(text),
              "A character beyond ASCII is in front of a number: write signs and digits in ASCII.")
        << text;
  for (const char* text :
       {"0 0 0 1 2 - 3", "0 0 0 1 2 \u2212 3", "0 0 0 1 2 -\u00a03", "0 0 0 t = - [1 2 3]",
        "0 0 0 \u2212[1 2 3]", "0 0 0 -\n( .1 2 3", "0 0 0 1 2 -+3", "0 0 0 1 2 - -3"})
    EXPECT_EQ(problem(text),
              "A sign is separate from its number: write signs directly in front of digits.")
        << text;
  for (const char* text :
       {"0,5; 0,25; 0; 0; 0; 1,5", "0,5 0,25 0,1 0,0 0,0 1,5", "[0,5] [0,25] 0 0 0 1",
        "0 0 1 0,2 0 0", "0, 0, 1, 0,2, 0, 0", "Pose. 0 0 1 0,2 0 0"})
    EXPECT_THAT(problem(text), testing::HasSubstr("decimal commas: write decimal points")) << text;
  for (const char* text :
       {"1,2,3,4,5,6", "1, 2, 3; 4, 5, 6", "1,2,3 4,5,6", "1.5, 2,\u00a03 4\u202f5 6",
        "1,-2 3e-1 4 5 6", "0.5,1 2 3 4 5", "x-axis - y_axis: 1 2 3 4 5 6",
        "rotation_vector_deg [1,2,3] translation_mm [4,5,6]", "1\u00b0, 2\u00b0, 3\u00b0 4 5 6"})
    EXPECT_EQ(problem(text), "") << text;
}

TEST(ParsePose, DashesOfAYamlList_AreNoSigns) {
  const Pose plain = parsePose("1 -2 3 4 5 -6", {}).camera_from_station;
  for (const char* text :
       {"- 1\n- -2\n- 3\n- 4\n- 5\n- -6\n", "rotation:\n  - 1\n  - -2\n  - +3\nt:\n- 4\n- 5\n- -6",
        "- - 1.0\r\n  - -2.0\r\n  - 3.0\r\n- - 4.0\r\n  - 5.0\r\n  - -6.0\r\n",
        "pose:\n- [1, -2, 3]\n- [4, 5, -6]\n"}) {
    EXPECT_EQ(parsePose(text, {}).problem, "") << text;
    EXPECT_EQ(parsePose(text, {}).camera_from_station, plain) << text;
  }
  const std::string matrix =
      "- - 1.0\n  - 0.0\n  - 0\n  - 0.5\n- [0, 1, 0, -1]\n- [0, 0, 1, 2]\n- [0, 0, 0, 1]\n";
  EXPECT_EQ(parsePose(matrix, guessReading(matrix)).problem, "");
  for (const char* text : {"- 1 2 3\n- 4 5 6\n", "- 1 2 3 4 5 6", "- 1\n- 2\n3\n4\n5\n- 6",
                           "- 1\n- 2\n- 3\n- 4\n- 5\n-[6]", "- 1\n- 2\n- 3\n- 4\n- 5\n- [- 6]",
                           "- 1\n- 2\n- 3\n- 4\n- - 5\n- 6\n", "- 1\n- 2\n- 3\n- 4\n- 5\n- - 6",
                           "- - 1\n- - 2\n- - 3\n- - 4\n- - 5\n- - 6\n",
                           "- - 1\n  - 2\n  - - 3\n- - 4\n  - 5\n  - 6\n",
                           "  - 1\n  - - 2\n  - 3\n- - 4\n  - 5\n  - 6\n"})
    EXPECT_THAT(parsePose(text, {}).problem, testing::StartsWith("A sign is separate")) << text;
}

TEST(ParsePose, ProjectsAMatrixThatIsNearlyARotationAndSaysSo) {
  const ParsedPose parsed = parsePose("1.00001 0 0 0 0 1 0 0 0 0 1 0", PoseReading());
  ASSERT_TRUE(parsed.valid);
  EXPECT_GT(parsed.rotation_deviation, 1e-5);
  EXPECT_LT(parsed.rotation_deviation, 1e-4);
}

}  // namespace
}  // namespace boresight::sessions
