// SPDX-License-Identifier: Apache-2.0
#include "sessions/review/precision_checks.h"

#include <gtest/gtest.h>

#include <Eigen/Dense>

#include "sessions/review/calibration_share.h"
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
  const PredictedEdges edges = predictEdges(
      subject.loaded->source.camera, subject.loaded->scene.view(), subject.camera_from_station);
  std::vector<Check> checks;
  addPrecisionChecks(subject, limits, edges, checks);
  return checks;
}

TEST(PrecisionChecks, SigmasAreSetAgainstWhatTheRequirementNames) {
  const DrawnBox box;
  ReviewSubject subject = box.subject(box.camera_from_station_);
  subject.covariance = someCovariance();
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
  subject.covariance(3, 3) = 0.5e-3 * 0.5e-3;
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

TEST(PrecisionChecks, TheCalibrationsShareIsAddedAndTold) {
  const DrawnBox box;
  ReviewSubject subject = box.subject(box.camera_from_station_);
  subject.covariance = 1e-12 * Matrix6d::Identity();
  CheckLimits limits;
  limits.focal_sigma_px = 1.0;
  // A per mille of the focal length is one of the distance: 0.5 mm, less what the box's own depth
  // tells otherwise.
  const Check check = findCheck(checksOf(subject, limits), "covariance_normal");
  EXPECT_NEAR(check.figure.value(), 1.5, 0.15);
  EXPECT_EQ(check.state, CheckState::kFailed);
  EXPECT_NE(check.sentence.find("calibrat"), std::string::npos) << check.sentence;
}

/// Distances along the normals between what a wrong camera predicts from a pose and the true
/// places.
Eigen::VectorXd misfit(const PredictedEdges& edges, const Camera& camera, const Pose& pose) {
  Eigen::VectorXd distances(static_cast<Eigen::Index>(edges.places.size()));
  for (std::size_t i = 0; i < edges.places.size(); ++i) {
    Eigen::Vector2d pixel;
    EXPECT_TRUE(project(camera, pose * edges.places[i].point_in_station_m, pixel));
    distances(static_cast<Eigen::Index>(i)) =
        edges.places[i].normal.dot(pixel - edges.places[i].pixel);
  }
  return distances;
}

/// The pose of least squares, by derivatives that are differences.
Pose fitted(const PredictedEdges& edges, const Camera& camera, Pose pose) {
  for (int round = 0; round < 8; ++round) {
    const Eigen::VectorXd now = misfit(edges, camera, pose);
    Eigen::MatrixXd slopes(now.size(), 6);
    for (int i = 0; i < 6; ++i)
      slopes.col(i) =
          (misfit(edges, camera, perturbed(1e-6 * Vector6d::Unit(i), pose)) - now) / 1e-6;
    const Eigen::VectorXd step = slopes.colPivHouseholderQr().solve(-now);
    pose = perturbed(Vector6d(step), pose);
  }
  return pose;
}

TEST(CalibrationShare, ThePoseFollowsTheCameraAsAFitWithTheWrongCameraDoes) {
  const DrawnBox box;
  const PredictedEdges edges =
      predictEdges(box.camera_, box.scene_.view(), box.camera_from_station_);
  const auto follow = poseByCamera(edges.places, box.camera_, box.camera_from_station_);
  ASSERT_TRUE(follow);
  for (int parameter = 0; parameter < 3; ++parameter) {
    Camera wrong = box.camera_;
    const double change_px = 0.2;
    if (parameter == 0) wrong.fx = wrong.fy = box.camera_.fx + change_px;
    if (parameter == 1) wrong.cx += change_px;
    if (parameter == 2) wrong.cy += change_px;
    ASSERT_EQ(prepareCamera(wrong), Status::kOk);
    const Vector6d found = perturbationBetween(box.camera_from_station_,
                                               fitted(edges, wrong, box.camera_from_station_));
    const Vector6d expected = change_px * follow->col(parameter);
    EXPECT_LT((found - expected).norm(), 0.01 * expected.norm()) << parameter;
  }
}

}  // namespace
}  // namespace boresight::sessions
