// SPDX-License-Identifier: Apache-2.0
#include "sessions/calibration/calibrated_values.h"

#include <limits>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

namespace boresight::sessions {
namespace {

/// From 1500 px and (640, 480): the focal length 0.2 % longer, known to 0.1 %.
struct CalibratedValuesTest : testing::Test {
  Camera before;
  CameraCalibration calibration;

  CalibratedValuesTest() {
    before.model = CameraModel::kBrownConrady;
    before.fx = before.fy = 1500.0;
    before.cx = 640.0;
    before.cy = 480.0;
    before.distortion = {-0.1, 0.03};
    calibration.camera = before;
    calibration.camera.fx = 1503.0;
    calibration.camera.cx = 641.0;
    calibration.camera.distortion[1] = 0.02;
    calibration.parameters = {{"focal_relative", "", 0.002, 0.001, 0.05},
                              {"centre_x_px", "px", 1.0, 0.8, 50.0},
                              {"centre_y_px", "px", 0.0, 0.5, 50.0},
                              {"k1", "", -0.1, 0.01, 0.5},
                              {"k2", "", 0.02, 0.02, 0.5}};
  }
};

TEST_F(CalibratedValuesTest, HaveBothCamerasAndTheChangeInSigmas) {
  const auto values = calibratedValues(before, calibration);
  ASSERT_EQ(values.size(), 5u);
  EXPECT_EQ(values[0].name, "focal length");
  EXPECT_EQ(values[0].before, 1500.0);
  EXPECT_EQ(values[0].after, 1503.0);
  EXPECT_DOUBLE_EQ(values[0].sigma, 1.5);
  EXPECT_DOUBLE_EQ(values[0].changeInSigmas(), 2.0);
  EXPECT_DOUBLE_EQ(values[1].changeInSigmas(), 1.25);
  EXPECT_EQ(values[2].changeInSigmas(), 0.0);
  EXPECT_EQ(values[3].name, "distortion k1");
  EXPECT_EQ(values[4].before, 0.03);
  EXPECT_DOUBLE_EQ(values[4].changeInSigmas(), -0.5);
}

TEST_F(CalibratedValuesTest, ChangeWithinThreeSigma_IsNotNeededAndWithoutSigmasNotMentioned) {
  EXPECT_EQ(changeText(calibratedValues(before, calibration)),
            "No change is needed: the largest, of the focal length, is 2.0 sigma.");
  calibration.camera.distortion[1] = -0.07;  // minus 5 sigma
  EXPECT_THAT(changeText(calibratedValues(before, calibration)),
              testing::StartsWith("The distortion k2 changes by 5.0 sigma"));
  for (CalibrationParameter& parameter : calibration.parameters)
    parameter.sigma = std::numeric_limits<double>::infinity();
  const auto undetermined = calibratedValues(before, calibration);
  EXPECT_FALSE(undetermined[0].isDetermined());
  EXPECT_EQ(undetermined[0].changeInSigmas(), 0.0);
  EXPECT_EQ(changeText(undetermined), "");
}

TEST(DirectionText, NamesTheParametersForPeople) {
  EXPECT_EQ(directionText({1.0, "focal_relative with centre_x_px: 2"}),
            "focal length with principal point x: 2");
  EXPECT_EQ(directionText({1.0, "k1"}), "k1");
}

}  // namespace
}  // namespace boresight::sessions
