// SPDX-License-Identifier: Apache-2.0
#include "sessions/io/cameras/camera_conversion.h"

#include <cmath>
#include <random>

#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <nlohmann/json.hpp>
#include <opencv2/calib3d.hpp>

#include "core/geometry/cahv_model.h"
#include "sessions/io/cameras/camera_file.h"
#include "sessions/io/images/camera_of_file.h"
#include "tests/core/geometry/planetary_cameras.h"
#include "tests/support/random_pose.h"
#include "tests/support/temporary_folder.h"

namespace boresight::sessions {
namespace {

Camera cameraOf(const CahvModel& cahv, int width, int height) {
  return cameraOfVectors(cahv, width, height).value().camera;
}

/// A camera with its optical axis along z, where CAHVOR is Brown's radial distortion but for what
/// the inverse leaves of higher order.
Camera cahvor(const Eigen::Vector3d& optical_axis) {
  CahvModel cahv;
  cahv.model = CameraModel::kCahvor;
  cahv.h_px = {1000.0, 0.0, 510.0};
  cahv.v_px = {0.0, 990.0, 380.0};
  cahv.o = optical_axis.normalized();
  cahv.r = {0.0, -0.2, 0.05};
  return cameraOf(cahv, 1024, 768);
}

/// The pixel that OpenCV gives a point, by the file's own numbers.
Eigen::Vector2d byOpenCv(const nlohmann::json& json, const Eigen::Vector3d& point_m) {
  const cv::Matx33d intrinsic(json["fx"], 0, json["cx"], 0, json["fy"], json["cy"], 0, 0, 1);
  const auto dist = json["dist"].get<std::vector<double>>();
  std::vector<cv::Point2d> pixel;
  cv::projectPoints(std::vector<cv::Point3d>{{point_m.x(), point_m.y(), point_m.z()}},
                    cv::Vec3d(0, 0, 0), cv::Vec3d(0, 0, 0), intrinsic, dist, pixel);
  return {pixel[0].x, pixel[0].y};
}

/// A hazard camera of a rover, from the label of a published image: its corners lie about 90 deg
/// off the axis.
Camera hazardCamera() {
  CahvModel cahv;
  cahv.model = CameraModel::kCahvore;
  cahv.c_m = {0.609331, -0.041064, -0.233849};
  cahv.a = {0.7034469897398741, -0.005160999924724463, 0.7107289896336624};
  cahv.h_px = {351.362, 452.204, 353.494};
  cahv.v_px = {35.8065, -1.75143, 682.705};
  cahv.o = {0.7044021845276859, -0.00606200158802323, 0.7097751859352164};
  cahv.r = {3e-06, -0.012015, -0.007525};
  cahv.e_m = {0.001442, 0.001522, 0.000483};
  cahv.type = 3;
  cahv.parameter = 0.37;
  return cameraOf(cahv, 1024, 1024);
}

TEST(CameraConversion, OfAnOpticalAxisAlongTheCamerasIsExact) {
  const FittedCamera fitted =
      fitCamera(cahvor(Eigen::Vector3d::UnitZ()), CameraModel::kBrownConrady);
  EXPECT_LT(fitted.worst_error_px, 1e-6);
  EXPECT_NEAR(fitted.camera.fx, 1000.0, 1e-6);
  EXPECT_NEAR(fitted.camera.cy, 380.0, 1e-6);
  EXPECT_NEAR(fitted.camera.distortion[0], -0.2, 1e-6);
  EXPECT_NEAR(fitted.camera.distortion[1], 0.05, 1e-6);
  EXPECT_EQ(fitted.unseen_count, 0);
}

TEST(CameraConversion, StatesTheWorstErrorThatOpenCvMakesWithItsFile) {
  const Camera given = cahvor({0.01, -0.004, 1.0});
  const test::TemporaryFolder folder;
  const FittedCamera fitted = fitCamera(given, CameraModel::kBrownConrady);
  const double infinite_m = std::numeric_limits<double>::infinity();
  writeFittedCamera(folder / "fitted.json", fitted, {given}, "given.cahvor", infinite_m);
  const auto json = nlohmann::json::parse(folder.read("fitted.json"));
  double worst_px = 0.0;
  for (int y = 0; y < given.height; ++y)
    for (int x = 0; x < given.width; x += y % 97 == 0 || y == given.height - 1 ? 1 : 1023) {
      const Eigen::Vector2d pixel(x, y);
      Eigen::Vector3d ray;
      ASSERT_TRUE(unproject(given, pixel, ray));
      worst_px = std::max(worst_px, (byOpenCv(json, ray) - pixel).norm());
    }
  EXPECT_GT(worst_px, 1e-4);  // a tilted axis is not quite what tangential terms say
  EXPECT_NEAR(fitted.worst_error_px, worst_px, 0.02 * worst_px);
  EXPECT_EQ(json["fitted_from"]["file"], "given.cahvor");
  EXPECT_EQ(json["fitted_from"]["model"], "cahvor");
  EXPECT_EQ(json["fitted_from"]["worst_error_px"], fitted.worst_error_px);
  EXPECT_EQ(readCamera(folder / "fitted.json"), fitted.camera);
  writeFittedCamera(folder / "near.json", fitted, {given}, "given.cahvor", 0.5);
  EXPECT_EQ(readCamera(folder / "near.json"), fitted.camera) << "with its distance";
}

TEST(CameraConversion, KeepsWhatIsStatedOfTheCalibration) {
  const test::TemporaryFolder folder;
  CameraFile given{cahvor(Eigen::Vector3d::UnitZ())};
  const auto sigmaAfter = [&] {
    const FittedCamera fitted = fitCamera(given.camera, CameraModel::kBrownConrady);
    writeFittedCamera(folder / "fitted.json", fitted, given, "given.cahvor", 0.5);
    return readCameraFile(folder / "fitted.json").calibration_sigma;
  };
  EXPECT_FALSE(sigmaAfter()) << "nothing is stated";
  given.calibration_sigma = StatedCalibration{{}, 0.3};
  EXPECT_EQ(sigmaAfter(), given.calibration_sigma);
  given.covariance = CameraCovariance{1e-8 * Eigen::MatrixXd::Identity(18, 18)};
  const CalibrationSigma derived = calibrationSigmaOf(given.camera, *given.covariance);
  EXPECT_EQ(sigmaAfter(), (StatedCalibration{derived.focal_relative, derived.principal_point_px}));
}

TEST(CameraConversion, IsNoWorseThanAPinhole) {
  for (const auto& item : test::planetaryCameras()) {
    const Camera given = cameraOf(item.cahv, item.width, item.height);
    if (isMirrored(given)) continue;
    const FittedCamera pinhole = fitCamera(given, CameraModel::kPinhole, 1.0);
    const FittedCamera brown = fitCamera(given, CameraModel::kBrownConrady, 1.0);
    EXPECT_LE(brown.worst_error_px, pinhole.worst_error_px + 1e-9) << item.name;
    EXPECT_GE(pinhole.worst_error_px, pinhole.rms_error_px) << item.name;
  }
}

TEST(CameraConversion, OfAMovingPupilHoldsAtItsDistance) {
  CahvModel cahv;
  cahv.model = CameraModel::kCahvore;
  cahv.h_px = {600.0, 0.0, 320.0};
  cahv.v_px = {0.0, 600.0, 240.0};
  cahv.e_m = {0.02, 0.0, 0.0};
  cahv.type = 3;
  cahv.parameter = 0.5;
  const Camera given = cameraOf(cahv, 640, 480);
  const FittedCamera near = fitCamera(given, CameraModel::kBrownConrady, 0.2);
  EXPECT_LT(near.worst_error_px, 0.05);
  EXPECT_GT(near.worst_error_far_px, 5.0 * near.worst_error_px);
  // A point of a ray 0.2 m from the centre, by plain projection.
  Ray ray;
  ASSERT_TRUE(unprojectRay(given, {600.0, 400.0}, ray));
  double low = 0.0, high = 1.0;
  for (int i = 0; i < 60; ++i)
    (ray.at(0.5 * (low + high)).norm() < 0.2 ? low : high) = 0.5 * (low + high);
  Eigen::Vector2d pixel;
  ASSERT_TRUE(project(near.camera, ray.at(low), pixel));
  EXPECT_LT((pixel - Eigen::Vector2d(600.0, 400.0)).norm(), near.worst_error_px + 1e-9);
}

TEST(CameraConversion, OfAHazardCameraIsAsGoodAtEveryDistance) {
  for (const double distance_m : {0.3, 0.5, 2.0, 100.0}) {
    SCOPED_TRACE(distance_m);
    const FittedCamera brown = fitCamera(hazardCamera(), CameraModel::kBrownConrady, distance_m);
    EXPECT_LT(brown.rms_error_px, 1.5);
    EXPECT_LT(brown.worst_error_px, 30.0);
    EXPECT_LT(brown.unseen_count, 0.01 * brown.checked_count);
    const FittedCamera fisheye = fitCamera(hazardCamera(), CameraModel::kKannalaBrandt, distance_m);
    EXPECT_LT(fisheye.rms_error_px, 0.7);
    EXPECT_LT(fisheye.worst_error_px, 3.5);
    EXPECT_EQ(fisheye.unseen_count, 0);
  }
}

/// A fisheye whose axis is the camera's, with a field up to the pole of (x/z, y/z): where a
/// point is seen needs no model.
TEST(CameraConversion, OfAnEquidistantCameraIsWithinTwoPixelsUpToEightyDegrees) {
  const Camera given = test::makeCamera(CameraModel::kKannalaBrandt, 1024, 1024, 455.0);
  const FittedCamera fitted = fitCamera(given, CameraModel::kBrownConrady);
  const Eigen::Vector2d middle(given.cx, given.cy);
  for (double angle_rad = 0.05; angle_rad < 1.396; angle_rad += 0.05) {
    const Eigen::Vector3d ray(0.6 * std::tan(angle_rad), 0.8 * std::tan(angle_rad), 1.0);
    Eigen::Vector2d pixel;
    ASSERT_TRUE(project(fitted.camera, ray, pixel)) << angle_rad;
    EXPECT_LT((pixel - middle - 455.0 * angle_rad * Eigen::Vector2d(0.6, 0.8)).norm(), 2.0)
        << angle_rad;
  }
}

TEST(CameraConversion, ImpossibleFit_IsRefused) {
  Camera mirrored = cahvor(Eigen::Vector3d::UnitZ());
  mirrored.fy = -mirrored.fy;
  ASSERT_EQ(prepareCamera(mirrored), Status::kOk);
  EXPECT_THROW((void)fitCamera(mirrored, CameraModel::kBrownConrady), std::runtime_error);
  EXPECT_THROW((void)fitCamera(cahvor(Eigen::Vector3d::UnitZ()), CameraModel::kCahv),
               std::invalid_argument);
}

}  // namespace
}  // namespace boresight::sessions
