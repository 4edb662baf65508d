// SPDX-License-Identifier: Apache-2.0
#include "sessions/review/precision_checks.h"

#include <gtest/gtest.h>

#include "sessions/review/pose_uncertainty.h"
#include "tests/sessions/review/drawn_box.h"
#include "tests/sessions/review/find_check.h"

namespace boresight::sessions {
namespace {

using test::DrawnBox;
using test::findCheck;

/// Independent sigmas: 1 mrad about every axis, 0.1, 0.1 and 0.2 mm along them.
Matrix6d someCovariance() {
  Vector6d sigma;
  sigma << 1e-3, 1e-3, 1e-3, 1e-4, 1e-4, 2e-4;
  return sigma.cwiseAbs2().asDiagonal();
}

std::vector<Check> checksOf(const ReviewSubject& subject, const CheckLimits& limits) {
  std::vector<Check> checks;
  addPrecisionChecks(subject, limits, checks);
  return checks;
}

TEST(PrecisionChecks, SigmasAreSetAgainstWhatTheRequirementNames) {
  const DrawnBox box;
  ReviewSubject subject = box.subject(box.camera_from_station_);
  subject.covariance.picture = someCovariance();
  subject.requirement = {0.5, 0.5, {}, {}};
  const auto checks = checksOf(subject, CheckLimits());
  EXPECT_NEAR(findCheck(checks, "covariance_normal").figure.value(), 0.6, 1e-9);
  EXPECT_EQ(findCheck(checks, "covariance_normal").state, CheckState::kFailed);
  EXPECT_NEAR(findCheck(checks, "covariance_lateral").figure.value(), 0.3 * std::sqrt(2.0), 1e-9);
  EXPECT_EQ(findCheck(checks, "covariance_lateral").state, CheckState::kPassed);
  EXPECT_EQ(findCheck(checks, "covariance_rotation").state, CheckState::kNotApplicable);
}

TEST(PrecisionChecks, InTheImageTheyAreTheSpreadOfTheEdges) {
  const DrawnBox box;
  ReviewSubject subject = box.subject(box.camera_from_station_);
  // 0.5 mm along x at half a metre with f = 1000 px: a pixel, whatever the place's depth makes of
  // it.
  subject.covariance.picture(3, 3) = 0.5e-3 * 0.5e-3;
  subject.requirement = {{}, {}, {}, 3.5};
  const Check check = findCheck(checksOf(subject, CheckLimits()), "covariance_projection");
  EXPECT_NEAR(check.figure.value(), 3.0, 0.25);
  EXPECT_EQ(check.state, CheckState::kPassed);
}

TEST(PrecisionChecks, WithoutACovarianceThereIsNothingToAsk) {
  const DrawnBox box;
  ReviewSubject subject = box.subject(box.camera_from_station_);
  EXPECT_EQ(findCheck(checksOf(subject, CheckLimits()), "covariance_normal").state,
            CheckState::kNotApplicable);
}

TEST(PrecisionChecks, ScaleAndCalibrationCountWhereNobodyStatedThem) {
  const DrawnBox box;
  ReviewSubject subject = box.subject(box.camera_from_station_);
  const SessionCase& one = subject.loaded->source;
  subject.covariance = poseCovariance(one, subject.loaded->scene.view(),
                                      subject.camera_from_station, 1e-12 * Matrix6d::Identity());
  // 0.02 % of half a metre twice over, less what the box's own depth tells of the focal length.
  const Check check = findCheck(checksOf(subject, CheckLimits()), "covariance_normal");
  EXPECT_NEAR(check.figure.value(), 3.0 * 0.1 * std::sqrt(2.0), 0.02);
  EXPECT_EQ(check.state, CheckState::kFailed) << "0.4 mm are required";
  EXPECT_NE(check.sentence.find("no better than the mesh's scale (0.02 %, assumed) and the "
                                "camera's calibration (0.02 % and "),
            std::string::npos)
      << check.sentence;
  EXPECT_NE(check.sentence.find(" px, assumed) allow: 0.4"), std::string::npos) << check.sentence;
  EXPECT_NE(check.sentence.find("state how well"), std::string::npos) << check.sentence;
}

TEST(PrecisionChecks, WhatIsStatedTakesThePlaceOfWhatIsAssumed) {
  const DrawnBox box;
  ReviewSubject subject = box.subject(box.camera_from_station_);
  SessionCase one = subject.loaded->source;
  const auto figure = [&](double mesh_scale, const CalibrationSigma& calibration) {
    one.mesh_scale_sigma = mesh_scale;
    one.calibration_sigma = calibration;
    subject.covariance = poseCovariance(one, subject.loaded->scene.view(),
                                        subject.camera_from_station, 1e-12 * Matrix6d::Identity());
    return findCheck(checksOf(subject, CheckLimits()), "covariance_normal").figure.value();
  };
  EXPECT_NEAR(figure(0.0, {0.0, 0.0}), 0.003, 1e-6);
  EXPECT_NEAR(figure(0.005, {0.0, 0.0}), 3.0 * 2.5, 1e-3) << "half a percent of half a metre";
  EXPECT_NEAR(figure(0.0, {0.001, 0.0}), 3.0 * 0.5, 0.15);
}

TEST(PrecisionChecks, TheSentenceSaysWhere) {
  const DrawnBox box;
  ReviewSubject subject = box.subject(box.camera_from_station_);
  subject.covariance.picture = someCovariance();
  const auto sentence = [&] {
    return findCheck(checksOf(subject, CheckLimits()), "covariance_normal").sentence;
  };
  EXPECT_EQ(sentence().rfind("3 sigma at the camera are ", 0), 0U) << sentence();
  auto loaded = std::make_shared<LoadedCase>();
  loaded->source.camera_from_end_effector = Pose();
  subject.loaded = loaded;
  EXPECT_EQ(sentence().rfind("3 sigma at the end effector are ", 0), 0U) << sentence();
}

}  // namespace
}  // namespace boresight::sessions
