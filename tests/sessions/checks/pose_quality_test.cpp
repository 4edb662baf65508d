// SPDX-License-Identifier: Apache-2.0
#include "sessions/checks/pose_quality.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "sessions/checks/checks.h"
#include "tests/sessions/checks/drawn_box.h"
#include "tests/sessions/checks/find_check.h"

namespace boresight::sessions {
namespace {

/// A pose whose image gives this sigma along each of the camera's axes.
class PoseQualityTest : public testing::Test {
 protected:
  void setSigma(double sigma_mm) {
    subject_.covariance.picture = test::translationCovariance(1e-3 * sigma_mm);
  }
  PoseQuality quality(double sigmas = 3.0) const { return poseQuality(subject_, sigmas); }

  const test::DrawnBox box_;
  ReviewSubject subject_ = box_.subject(box_.camera_from_station_);
};

TEST(OfLimitText, HasTwoDigitsOfTheLimitAndTellsTheNumbersApart) {
  EXPECT_EQ(ofLimitText(0.3676, 0.4, "mm"), "0.37 of 0.40 mm");
  EXPECT_EQ(ofLimitText(1.2, 0.4, "mm"), "1.20 of 0.40 mm");
  EXPECT_EQ(ofLimitText(1.04, 4.363, "mrad"), "1.0 of 4.4 mrad");
  EXPECT_EQ(ofLimitText(7.0, 25.0, "px"), "7 of 25 px");
  EXPECT_EQ(ofLimitText(0.402, 0.4, "mm"), "0.402 of 0.400 mm") << "which is beyond it";
  EXPECT_EQ(ofLimitText(0.4, 0.4, "mm"), "0.40 of 0.40 mm");
}

TEST_F(PoseQualityTest, HoldsAsLongAsTheWorstFigureDoes) {
  subject_.requirement = {0.4, 0.4, {}, {}};
  setSigma(0.09);  // across the view axis sqrt(2) times as much as along it
  EXPECT_TRUE(quality().holds());
  EXPECT_EQ(quality().text(), "0.38 of 0.40 mm (3 sigma across the view axis at the camera)");
  setSigma(0.1);
  EXPECT_FALSE(quality().holds());
  EXPECT_EQ(quality().text(), "0.42 of 0.40 mm (3 sigma across the view axis at the camera)");
  EXPECT_TRUE(quality(1.0).holds());
}

TEST_F(PoseQualityTest, ScaleAndCalibration_AreIncluded) {
  subject_.requirement = {0.4, 0.4, {}, {}};
  setSigma(0.01);
  EXPECT_TRUE(quality().holds());
  subject_.covariance.mesh_scale(5, 5) = 0.2e-3 * 0.2e-3;
  EXPECT_FALSE(quality().holds());
  const PoseQuality limited = quality();
  const PrecisionFigure* worst = limited.worst();
  ASSERT_NE(worst, nullptr);
  EXPECT_STREQ(worst->check.id, "covariance_normal");
  EXPECT_NEAR(*worst->by_image, 0.03, 1e-9);
  EXPECT_NEAR(*worst->found, 3.0 * std::hypot(0.2, 0.01), 1e-9);
}

TEST_F(PoseQualityTest, FiguresAreThoseOfTheChecks) {
  subject_.requirement = {0.5, 0.5, 0.25, 3.5};
  setSigma(0.1);
  const auto checks = test::addedChecks(addPrecisionChecks, subject_, CheckLimits());
  for (const PrecisionFigure& figure : quality().figures) {
    const Check check = test::findCheck(checks, figure.check.id);
    EXPECT_EQ(check.figure, figure.found) << figure.check.id;
    EXPECT_EQ(check.limit, figure.required) << figure.check.id;
    EXPECT_EQ(check.state == CheckState::kPassed, figure.holds()) << figure.check.id;
  }
}

TEST_F(PoseQualityTest, WithoutCovarianceOrLimits_NothingHolds) {
  subject_.requirement = {0.4, 0.4, {}, {}};
  EXPECT_FALSE(quality().holds());
  EXPECT_EQ(quality().text(), "The pose has no covariance");
  setSigma(0.01);
  subject_.requirement = {};
  EXPECT_FALSE(quality().holds());
  EXPECT_EQ(quality().text(), "The requirement has no limits");
}

}  // namespace
}  // namespace boresight::sessions
