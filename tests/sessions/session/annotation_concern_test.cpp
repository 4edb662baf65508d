// SPDX-License-Identifier: Apache-2.0
#include "sessions/session/annotation_concern.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

namespace boresight::sessions {
namespace {

using ::testing::HasSubstr;

TEST(AnnotationConcern, NamesSigmaBeyondTheRequirementThenResiduals) {
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
