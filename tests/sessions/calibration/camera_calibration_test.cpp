// SPDX-License-Identifier: Apache-2.0
#include "sessions/calibration/camera_calibration.h"

#include <cmath>
#include <map>
#include <string>
#include <utility>
#include <vector>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "core/base/random.h"
#include "sessions/session/stated_inputs.h"
#include "tests/support/coverage.h"
#include "tests/support/matchers.h"
#include "tests/support/random_pose.h"

namespace boresight::sessions {
namespace {

Camera trueCamera(CameraModel model = CameraModel::kPinhole) {
  if (model == CameraModel::kPinhole) return test::makePinhole(1280, 960, 1500.0);
  return test::makeCamera(model, 1280, 960, 1500.0, {-0.1, 0.03, 1e-4, -2e-4, 0.0});
}

/// A station of `points` points seen from `count` places at 0.3 to 0.8 m, all around and rolled.
std::vector<CalibrationView> viewsOf(const Camera& camera, int count, double noise_px,
                                     Random& random, int points = 30) {
  std::vector<Eigen::Vector3d> places;
  for (int i = 0; i < points; ++i)
    places.emplace_back(random.uniform(-0.08, 0.08), random.uniform(-0.06, 0.06),
                        random.uniform(-0.03, 0.03));
  std::vector<CalibrationView> views;
  for (int v = 0; v < count; ++v) {
    Vector6d xi;
    xi << random.uniform(-0.6, 0.6), random.uniform(-0.6, 0.6), random.uniform(-3.0, 3.0), 0, 0, 0;
    Pose pose = perturbed(xi, Pose());
    pose.translation_m = {random.uniform(-0.02, 0.02), random.uniform(-0.02, 0.02),
                          random.uniform(0.3, 0.8)};
    CalibrationView& view = views.emplace_back();
    view.case_id = "c" + std::to_string(v);
    for (const Eigen::Vector3d& place : places) {
      Eigen::Vector2d pixel;
      if (!project(camera, pose * place, pixel)) continue;
      pixel += noise_px * Eigen::Vector2d(random.normal(), random.normal());
      view.points.push_back({place, pixel, Eigen::Vector2d::Zero(), noise_px});
    }
    // Where the adjustment begins.
    view.camera_from_station = perturbed(0.003 * test::normalVector6(random), pose);
  }
  return views;
}

TEST(CameraCalibration, SigmasHoldTheErrors) {
  Random random = test::randomFor("CameraCalibration.Sigmas");
  const Camera truth = trueCamera();
  Camera start = truth;
  start.fx = start.fy = truth.fx * 1.01;
  start.cx += 4.0;
  start.cy -= 3.0;
  const std::map<std::string, double> expected = {
      {"focal_relative", 1.0 / 1.01 - 1.0}, {"centre_x_px", -4.0}, {"centre_y_px", 3.0}};
  std::map<std::string, std::vector<double>> errors;
  for (int draw = 0; draw < 1000; ++draw) {
    const CameraCalibration result = calibrateCamera(start, viewsOf(truth, 4, 0.3, random, 12), {});
    EXPECT_TRUE(result.undetermined.empty());
    EXPECT_TRUE(result.outlying.empty());
    for (const CalibrationParameter& parameter : result.parameters)
      errors[parameter.name].push_back((parameter.value - expected.at(parameter.name)) /
                                       parameter.sigma);
  }
  ASSERT_EQ(errors.size(), 3u);
  for (const auto& [name, of_draws] : errors) {
    SCOPED_TRACE(name);
    test::expectGaussianCoverage(of_draws);
  }
}

TEST(CameraCalibration, SwappedPair_IsNamedAndDoesNotLoseTheSigmas) {
  Random random = test::randomFor("CameraCalibration.Swapped");
  const Camera truth = trueCamera();
  auto views = viewsOf(truth, 8, 0.3, random);
  const CameraCalibration clean = calibrateCamera(truth, views, {});
  std::swap(views[3].points[5].pixel, views[3].points[17].pixel);
  const CameraCalibration result = calibrateCamera(truth, views, {});
  ASSERT_EQ(result.outlying.size(), 1u);
  EXPECT_THAT(outlyingText(result.outlying[0]),
              testing::HasSubstr("c3: 2 of 30 observations are far out"));
  EXPECT_TRUE(result.undetermined.empty());
  for (std::size_t i = 0; i < 3; ++i) {
    EXPECT_LT(result.parameters[i].sigma, 1.5 * clean.parameters[i].sigma);
    EXPECT_LT(std::abs(result.parameters[i].value - clean.parameters[i].value),
              2.0 * clean.parameters[i].sigma);
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
  EXPECT_FALSE(result.sigma({1e-3, 0.7}));
}

TEST(CameraCalibration, SigmaOfWhatIsNotAdjusted_StaysTheFormerOne) {
  Random random = test::randomFor("CameraCalibration.Former");
  const auto views = viewsOf(trueCamera(), 4, 0.3, random);
  const CameraCalibration result = calibrateCamera(trueCamera(), views, {true, false, false});
  const auto sigma = result.sigma({0.1, 0.7});
  ASSERT_TRUE(sigma);
  EXPECT_EQ(sigma->focal_relative, result.parameters[0].sigma);
  EXPECT_EQ(sigma->principal_point_px, 0.7);
}

TEST(CameraCalibration, AssumedSigmaOfWhatIsNotAdjusted_StaysAssumed) {
  Random random = test::randomFor("CameraCalibration.Assumed");
  const auto views = viewsOf(trueCamera(), 4, 0.3, random);
  const CameraCalibration focal = calibrateCamera(trueCamera(), views, {true, false, false});
  Session session;
  SessionCase one;
  one.id = "a";
  one.camera = trueCamera();
  session.cases.push_back(one);
  session = withCalibration(session, "a", focal);
  ASSERT_TRUE(session.cases[0]->calibration_sigma);
  EXPECT_EQ(session.cases[0]->calibration_sigma->focal_relative, focal.parameters[0].sigma);
  EXPECT_FALSE(session.cases[0]->calibration_sigma->principal_point_px);
  EXPECT_THAT(calibrationText(InputSigmas(*session.cases[0])), testing::EndsWith(" px (assumed)"));
  const Camera brown = trueCamera(CameraModel::kBrownConrady);
  const CameraCalibration distortion =
      calibrateCamera(brown, viewsOf(brown, 6, 0.3, random), {false, false, true});
  EXPECT_FALSE(distortion.sigma({})) << "nothing is stated";
  EXPECT_EQ(distortion.sigma({{}, 0.7}), (StatedCalibration{{}, 0.7}));
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
  EXPECT_THROW((void)calibrateCamera(camera, views, {true, true, true}), std::invalid_argument)
      << "a pinhole has no distortion";
  views[0].points.resize(4);
  EXPECT_THROW((void)calibrateCamera(camera, views, {}), std::invalid_argument);
}

}  // namespace
}  // namespace boresight::sessions
