// SPDX-License-Identifier: Apache-2.0
#include "sessions/session/pose_quality.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "core/base/random.h"
#include "tests/sessions/session/random_session.h"

namespace boresight::sessions {
namespace {

using ::testing::HasSubstr;

class PoseQuality : public ::testing::Test {
 protected:
  PoseQuality() {
    Random random(1);
    case_ = test::randomCase(random, "a");
    case_.requirement = {0.4, 0.4, {}, {}};
    case_.camera_from_end_effector.reset();
    run_.status = LocalizationStatus::kConverged;
    run_.finished = true;
  }
  /// With this sigma along each of the camera's axes.
  std::string excessOf(double sigma_mm) {
    run_.covariance.setZero();
    run_.covariance.bottomRightCorner<3, 3>().diagonal().setConstant(1e-6 * sigma_mm * sigma_mm);
    return runSigmaExcess(session_, case_, run_);
  }
  Session session_;
  SessionCase case_;
  LocalizationTrace run_;
};

TEST_F(PoseQuality, ThreeSigmaMustFitIntoTheRequirement) {
  // Across the view axis three sigma are sqrt(2) times as much as along it.
  EXPECT_EQ(excessOf(0.09), "");
  EXPECT_THAT(excessOf(0.1),
              HasSubstr("across the view axis at the camera, 1.06 times the 0.4 mm"));
  session_.review.limits = {{"check.sigmas", 1.0}};
  EXPECT_EQ(excessOf(0.1), "");
}

TEST_F(PoseQuality, RunWithoutAPose_HasNoExcess) {
  run_.status = LocalizationStatus::kNotSupported;
  EXPECT_EQ(excessOf(100.0), "");
}

TEST_F(PoseQuality, AnnotationsAreJudgedBySigmaAndResiduals) {
  CaseAnnotationsSolution solution;
  EXPECT_EQ(annotationConcern(solution), "");
  solution.annotations.requirement = {0.4, 0.4, {}, {}};
  solution.result.solution.emplace();
  auto& solved = *solution.result.solution;
  solved.camera_from_station = {Pose()};
  solved.rig_from_station = Pose();
  solution.annotations.views.resize(1);
  solved.covariance.diagonal().tail<3>().setConstant(1e-10);
  EXPECT_EQ(annotationConcern(solution), "");
  solved.noise_factor = 4.8;
  EXPECT_EQ(annotationConcern(solution), "The residuals are 4.80 times the stated sigmas.");
  solved.covariance.diagonal().tail<3>().setConstant(1e-4);
  EXPECT_THAT(annotationConcern(solution), HasSubstr("times the 0.4 mm required."));
}

}  // namespace
}  // namespace boresight::sessions
