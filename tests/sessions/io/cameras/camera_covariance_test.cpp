// SPDX-License-Identifier: Apache-2.0
#include "sessions/io/cameras/camera_covariance.h"

#include <cmath>

#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <nlohmann/json.hpp>

#include "core/geometry/cahv_model.h"
#include "sessions/io/cameras/cahvor_file.h"
#include "sessions/io/cameras/camera_file.h"
#include "sessions/io/images/camera_of_file.h"
#include "tests/core/geometry/planetary_cameras.h"
#include "tests/sessions/io/folder_test.h"
#include "tests/support/matchers.h"
#include "tests/support/random_pose.h"

namespace boresight::sessions {
namespace {

using CameraCovarianceTest = FolderTest;
using boresight::test::PlanetaryCamera;

/// A covariance with correlations between all components, small enough for every model.
Eigen::MatrixXd randomCovariance(CameraModel model) {
  const Eigen::Index size = vectorComponents(model);
  Random random = test::randomFor("CameraCovariance");
  Eigen::MatrixXd root(size, size);
  for (Eigen::Index i = 0; i < size; ++i)
    for (Eigen::Index j = 0; j < size; ++j)
      root(i, j) = (i >= 6 && i < 12 ? 0.1 : 1e-5) * random.normal();
  return root * root.transpose();
}

/// A file that states the covariance of a published camera.
CahvorFile fileOf(const PlanetaryCamera& camera) {
  return {camera.cahv, camera.width, camera.height, randomCovariance(camera.cahv.model), {}};
}

/// Variance of the pixel of a point that is fixed in the vectors' own frame, by differences in that
/// frame: nothing of the camera's own frame is used.
Eigen::Matrix2d variance_px(const CahvorFile& file, const Eigen::Vector3d& point_m) {
  Eigen::MatrixXd by(2, file.covariance.rows());
  for (Eigen::Index i = 0; i < by.cols(); ++i) {
    const double half = i >= 6 && i < 12 ? 1e-3 : 1e-6;
    Eigen::Vector2d pixel[2];
    for (int side = 0; side < 2; ++side) {
      CahvModel vectors = file.cahv;
      Eigen::Index first = 0;
      forVectors(vectors, [&](const char*, Eigen::Vector3d& vector) {
        if (i >= first && i < first + 3) vector[i - first] += side == 0 ? -half : half;
        first += 3;
      });
      const auto moved = cameraOfVectors(vectors, file.width, file.height);
      EXPECT_TRUE(moved);
      EXPECT_TRUE(
          project(moved->camera, moved->reference->camera_from_reference * point_m, pixel[side]));
    }
    by.col(i) = (pixel[1] - pixel[0]) / (2.0 * half);
  }
  return by * file.covariance * by.transpose();
}

/// The same from a camera file, in the camera's own frame.
Eigen::Matrix2d variance_px(const CameraFile& file, const Eigen::Vector3d& point_in_camera_m) {
  const std::vector<VectorStep> steps = vectorSteps(file.camera);
  Eigen::MatrixXd by(2, static_cast<Eigen::Index>(steps.size()));
  for (std::size_t i = 0; i < steps.size(); ++i) {
    const auto& [before, after, width] = steps[i];
    Eigen::Vector2d from, to;
    EXPECT_TRUE(project(before.camera, before.displaced_from_camera * point_in_camera_m, from));
    EXPECT_TRUE(project(after.camera, after.displaced_from_camera * point_in_camera_m, to));
    by.col(static_cast<Eigen::Index>(i)) = (to - from) / width;
  }
  return by * file.covariance.value().of_vectors * by.transpose();
}

TEST_F(CameraCovarianceTest, OfATextFile_GivesThePixelsTheSameVarianceInTheCamerasOwnFrame) {
  for (const PlanetaryCamera& camera : test::planetaryCameras()) {
    SCOPED_TRACE(camera.name);
    const CahvorFile file = fileOf(camera);
    writeCahvorFile(folder_ / "a.cahvore", file);
    const CameraFile read = readCameraFile(folder_ / "a.cahvore");
    ASSERT_TRUE(read.covariance);
    for (const PlanetaryCamera::Sight& sight : camera.sights) {
      const Eigen::Matrix2d expected = variance_px(file, sight.point_m);
      const Eigen::Matrix2d found =
          variance_px(read, read.reference->camera_from_reference * sight.point_m);
      EXPECT_LT((found - expected).norm(), 2e-3 * expected.norm());
    }
    // camera.json states it in the frame of its vectors.
    writeCamera(folder_ / "a.json", read);
    const auto json = nlohmann::json::parse(folder_.read("a.json"));
    EXPECT_NEAR(json["covariance"][0][4].get<double>(), file.covariance(0, 4),
                1e-9 * std::sqrt(file.covariance(0, 0) * file.covariance(4, 4)));
    const CameraFile again = readCameraFile(folder_ / "a.json");
    ASSERT_TRUE(again.covariance);
    EXPECT_LT((again.covariance->of_vectors - read.covariance->of_vectors).norm(),
              1e-12 * read.covariance->of_vectors.norm());
  }
}

TEST_F(CameraCovarianceTest, OfAPartOfTheImageAtAnotherScale_IsThatOfItsPixels) {
  const PlanetaryCamera camera = test::planetaryCameras().front();
  writeCahvorFile(folder_ / "a.cahvore", fileOf(camera));
  const CameraFile whole = readCameraFile(folder_ / "a.cahvore");
  nlohmann::ordered_json json = toJson(whole);
  json["subframe"] = {{"first_sample", 100}, {"first_line", 40}, {"scale", 2}};
  json["format"] = "boresight-camera";
  json["version"] = 1;
  const CameraFile part = readCameraFile(folder_.write("part.json", json.dump()));
  const Eigen::Vector3d point_in_camera_m =
      whole.reference->camera_from_reference * camera.sights.front().point_m;
  const Eigen::Matrix2d expected = variance_px(whole, point_in_camera_m) / 4.0;
  EXPECT_LT((variance_px(part, point_in_camera_m) - expected).norm(), 1e-4 * expected.norm());
}

TEST_F(CameraCovarianceTest, OfNothingButTheFocalLength_IsItsSigma) {
  CahvModel vectors;
  vectors.h_px = {800.0, 0.0, 400.0};
  vectors.v_px = {0.0, 800.0, 300.0};
  const CameraFile camera = cameraOfVectors(vectors, 800, 600).value();
  CameraCovariance covariance{Eigen::MatrixXd::Zero(12, 12)};
  covariance.of_vectors(6, 6) = covariance.of_vectors(10, 10) = covariance.of_vectors(6, 10) =
      covariance.of_vectors(10, 6) = 0.64;
  covariance.of_vectors(8, 8) = 0.25;
  const CalibrationSigma sigma = calibrationSigmaOf(camera.camera, covariance);
  EXPECT_NEAR(sigma.focal_relative, 0.8 / 800.0, 1e-9);
  EXPECT_NEAR(sigma.principal_point_px, 0.5, 1e-9);
}

TEST_F(CameraCovarianceTest, ThatIsNone_IsRefusedByItsMember) {
  auto json = nlohmann::json::parse(
      R"({"format": "boresight-camera", "version": 1, "model": "cahv", "width": 800, "height": 600,
          "C": [0, 0, 0], "A": [0, 0, 1], "H": [800, 0, 400], "V": [0, 800, 300]})");
  const auto error = [&](const nlohmann::json& covariance) {
    json["covariance"] = covariance;
    return folder_.message([&] { (void)readCameraFile(folder_.write("a.json", json.dump())); });
  };
  nlohmann::json rows = nlohmann::json::array();
  for (int i = 0; i < 12; ++i) rows.push_back(std::vector<double>(12, 0.0));
  EXPECT_EQ(error(rows), "(nothing)") << "it says nothing, but is one";
  rows[3][4] = 1.0;
  EXPECT_THAT(error(rows), HasSubstr("covariance: is not a covariance"));
  rows.erase(0);
  EXPECT_THAT(error(rows), HasSubstr("covariance: 12 rows of as many numbers are needed"));
}

}  // namespace
}  // namespace boresight::sessions
