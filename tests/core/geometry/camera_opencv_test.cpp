// SPDX-License-Identifier: Apache-2.0
#include <vector>

#include <gtest/gtest.h>
#include <opencv2/calib3d.hpp>

#include "core/geometry/camera.h"
#include "tests/core/geometry/example_cameras.h"

namespace boresight::test {
namespace {

struct Projection {
  std::vector<cv::Point2d> pixels;
  cv::Mat by_translation;  ///< rows 2 i and 2 i + 1: d pixel i / d translation
};

/// OpenCV's projection without a rotation: the derivative by its translation is that by the point.
Projection projectWithOpenCv(const Camera& camera, const std::vector<cv::Point3d>& points) {
  const cv::Matx33d k(camera.fx, 0.0, camera.cx, 0.0, camera.fy, camera.cy, 0.0, 0.0, 1.0);
  const cv::Vec3d zero(0.0, 0.0, 0.0);
  Projection result;
  cv::Mat jacobian;
  if (camera.model == CameraModel::kKannalaBrandt) {
    const cv::Vec4d distortion(camera.distortion[0], camera.distortion[1], camera.distortion[2],
                               camera.distortion[3]);
    cv::fisheye::projectPoints(points, result.pixels, zero, zero, k, distortion, 0.0, jacobian);
    result.by_translation = jacobian.colRange(11, 14).clone();  // f c k r t alpha
  } else {
    const std::vector<double> distortion(camera.distortion.begin(), camera.distortion.end());
    cv::projectPoints(points, zero, zero, k, distortion, result.pixels, jacobian);
    result.by_translation = jacobian.colRange(3, 6).clone();  // r t f c distortion
  }
  return result;
}

void expectSameAsOpenCv(const Camera& camera, Random& random) {
  std::vector<cv::Point3d> points;
  for (int i = 0; i < 500; ++i) {
    const Eigen::Vector3d ray = rayOf(camera, randomPixel(camera, random)).direction;
    const Eigen::Vector3d point = ray * random.uniform(0.2, 5.0);
    points.emplace_back(point.x(), point.y(), point.z());
  }
  const Projection oracle = projectWithOpenCv(camera, points);
  for (std::size_t i = 0; i < points.size(); ++i) {
    Eigen::Vector2d pixel;
    Eigen::Matrix<double, 2, 3> jacobian;
    ASSERT_TRUE(
        projectWithJacobian(camera, {points[i].x, points[i].y, points[i].z}, pixel, jacobian));
    EXPECT_NEAR(pixel.x(), oracle.pixels[i].x, 1e-9);
    EXPECT_NEAR(pixel.y(), oracle.pixels[i].y, 1e-9);
    for (int row = 0; row < 2; ++row)
      for (int column = 0; column < 3; ++column)
        EXPECT_NEAR(jacobian(row, column),
                    oracle.by_translation.at<double>(2 * static_cast<int>(i) + row, column),
                    1e-9 * (1.0 + jacobian.norm()));
  }
}

TEST(ProjectAgainstOpenCv, AgreesForExampleAndRandomCameras) {
  for (const NamedCamera& named : exampleCameras()) {
    SCOPED_TRACE(named.name);
    Random random = randomFor("AgreesForTheExampleCameras" + named.name);
    expectSameAsOpenCv(named.camera, random);
  }
  Random random = randomFor("AgreesForRandomCameras");
  for (int i = 0; i < 60; ++i) {
    SCOPED_TRACE(i);
    expectSameAsOpenCv(randomCamera(random, static_cast<CameraModel>(i % 3)), random);
  }
}

}  // namespace
}  // namespace boresight::test
