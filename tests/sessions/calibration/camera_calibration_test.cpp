// SPDX-License-Identifier: Apache-2.0
#include "sessions/calibration/camera_calibration.h"

#include <cmath>
#include <map>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "core/base/random.h"
#include "tests/support/random_pose.h"

namespace boresight::sessions {
namespace {

Camera trueCamera(CameraModel model = CameraModel::kPinhole) {
  if (model == CameraModel::kPinhole) return test::makePinhole(1280, 960, 1500.0);
  return test::makeCamera(model, 1280, 960, 1500.0, {-0.1, 0.03, 1e-4, -2e-4, 0.0});
}

/// A station of 30 points seen from `count` places at 0.3 to 0.8 m, all around and rolled.
std::vector<CalibrationView> viewsOf(const Camera& camera, int count, double noise_px,
                                     Random& random) {
  std::vector<Eigen::Vector3d> points;
  for (int i = 0; i < 30; ++i)
    points.emplace_back(random.uniform(-0.08, 0.08), random.uniform(-0.06, 0.06),
                        random.uniform(-0.03, 0.03));
  std::vector<CalibrationView> views;
  for (int v = 0; v < count; ++v) {
    Vector6d xi;
    xi << random.uniform(-0.6, 0.6), random.uniform(-0.6, 0.6), random.uniform(-3.0, 3.0), 0, 0, 0;
    Pose pose = perturbed(xi, Pose());
    pose.translation_m = {random.uniform(-0.02, 0.02), random.uniform(-0.02, 0.02),
                          random.uniform(0.3, 0.8)};
    CalibrationView& view = views.emplace_back();
    for (const Eigen::Vector3d& point : points) {
      Eigen::Vector2d pixel;
      if (!project(camera, pose * point, pixel)) continue;
      pixel += noise_px * Eigen::Vector2d(random.normal(), random.normal());
      view.points.push_back({point, pixel, Eigen::Vector2d::Zero(), noise_px});
    }
    // Where the adjustment begins.
    view.camera_from_station = perturbed(0.003 * test::normalVector6(random), pose);
  }
  return views;
}

/// Errors in units of the stated sigma, of 200 sets.
TEST(CameraCalibration, TruthLiesWithinThreeSigma) {
  Random random = test::randomFor("CameraCalibration.ThreeSigma");
  const Camera truth = trueCamera();
  Camera start = truth;
  start.fx = start.fy = truth.fx * 1.01;
  start.cx += 4.0;
  start.cy -= 3.0;
  const std::map<std::string, double> expected = {
      {"focal_relative", 1.0 / 1.01 - 1.0}, {"centre_x_px", -4.0}, {"centre_y_px", 3.0}};
  std::map<std::string, int> outside;
  std::map<std::string, double> squares;
  constexpr int kTrials = 200;
  for (int trial = 0; trial < kTrials; ++trial) {
    const auto views = viewsOf(truth, 8, 0.3, random);
    const CameraCalibration result = calibrateCamera(start, views, {});
    EXPECT_TRUE(result.undetermined.empty());
    for (const CalibrationParameter& parameter : result.parameters) {
      const double error = (parameter.value - expected.at(parameter.name)) / parameter.sigma;
      outside[parameter.name] += std::abs(error) > 3.0;
      squares[parameter.name] += error * error;
    }
  }
  for (const auto& [name, count] : outside) {
    EXPECT_LE(count, kTrials / 100) << name;
    // Neither too small nor too large: the mean square is 1, within four of its deviations.
    EXPECT_NEAR(squares[name] / kTrials, 1.0, 4.0 * std::sqrt(2.0 / kTrials)) << name;
  }
}

TEST(CameraCalibration, DistortionIsFound) {
  Random random = test::randomFor("CameraCalibration.Distortion");
  const Camera truth = trueCamera(CameraModel::kBrownConrady);
  Camera start = truth;
  start.distortion = {-0.08, 0.0, 0.0, 0.0, 0.0};
  ASSERT_EQ(prepareCamera(start), Status::kOk);
  const auto views = viewsOf(truth, 12, 0.05, random);
  const CameraCalibration result = calibrateCamera(start, views, {true, true, true});
  for (const CalibrationParameter& parameter : result.parameters)
    if (parameter.name == "k1") {
      EXPECT_NEAR(parameter.value, -0.1, 4.0 * parameter.sigma);
    }
  EXPECT_NEAR(result.rms_px, 0.05 * std::sqrt(2.0), 0.02);
  EXPECT_NEAR(result.noise_factor, 1.0, 0.1);
}

/// From straight above a flat station at one distance, a longer focal length looks like a smaller
/// distance.
TEST(CameraCalibration, WhatTheImagesCannotDetermineIsNamed) {
  Random random = test::randomFor("CameraCalibration.Undetermined");
  const Camera truth = trueCamera();
  auto views = viewsOf(truth, 4, 0.3, random);
  for (CalibrationView& view : views) {
    const Pose pose{Eigen::Quaterniond::Identity(), {0.0, 0.0, 0.5}};
    view.camera_from_station = pose;
    for (PointObservation& observation : view.points) {
      observation.point_in_station_m.z() = 0.0;
      EXPECT_TRUE(project(truth, pose * observation.point_in_station_m, observation.pixel));
      observation.pixel += 0.3 * Eigen::Vector2d(random.normal(), random.normal());
    }
  }
  const CameraCalibration result = calibrateCamera(truth, views, {true, false, false});
  ASSERT_EQ(result.undetermined.size(), 1u);
  EXPECT_EQ(result.undetermined[0].text, "focal_relative");
  EXPECT_FALSE(std::isfinite(result.parameters[0].sigma));
  EXPECT_FALSE(result.sigma());
}

TEST(CameraCalibration, IsUsedForTheCasesOfTheCamera) {
  Session session;
  for (const char* id : {"a", "b", "c"}) {
    SessionCase session_case;
    session_case.id = id;
    session_case.camera = trueCamera();
    if (session_case.id == "b") session_case.camera.fx = 1000.0;
    session.cases.push_back(session_case);
  }
  Random random = test::randomFor("CameraCalibration.Used");
  const CameraCalibration calibration =
      calibrateCamera(trueCamera(), viewsOf(trueCamera(), 8, 0.3, random), {});
  const Session next = withCalibration(session, "a", calibration);
  EXPECT_TRUE(next.cases[0]->camera == calibration.camera);
  EXPECT_TRUE(next.cases[0]->calibration_sigma);
  EXPECT_TRUE(next.cases[1]->camera == session.cases[1]->camera);
  EXPECT_TRUE(next.cases[2]->camera == calibration.camera);
  EXPECT_THROW((void)calibrateCameraOf(session, "a", ObservationSource::kAnnotations, {}),
               std::invalid_argument)
      << "nothing is annotated";
}

TEST(CameraCalibration, TooLittleIsRefused) {
  Random random = test::randomFor("CameraCalibration.Refused");
  const Camera camera = trueCamera();
  auto views = viewsOf(camera, 1, 0.3, random);
  EXPECT_THROW((void)calibrateCamera(camera, views, {false, false, false}), std::invalid_argument);
  EXPECT_THROW((void)calibrateCamera(camera, {}, {}), std::invalid_argument);
  views[0].points.resize(4);
  EXPECT_THROW((void)calibrateCamera(camera, views, {}), std::invalid_argument);
}

}  // namespace
}  // namespace boresight::sessions
