// SPDX-License-Identifier: Apache-2.0
#include "core/geometry/camera.h"

#include <cmath>
#include <limits>
#include <string>
#include <vector>

#include <gtest/gtest.h>

#include "tests/core/geometry/example_cameras.h"
#include "tests/support/not_finite.h"
#include "tests/support/random_pose.h"

namespace boresight::test {
namespace {

class EveryCamera : public ::testing::TestWithParam<NamedCamera> {};
INSTANTIATE_TEST_SUITE_P(Camera, EveryCamera, ::testing::ValuesIn(exampleCameras()),
                         [](const auto& instance) { return instance.param.name; });

/// Over the image, a pixel beyond its borders included.
std::vector<Eigen::Vector2d> pixelGrid(const Camera& camera, int per_axis) {
  std::vector<Eigen::Vector2d> pixels;
  for (int j = 0; j <= per_axis; ++j)
    for (int i = 0; i <= per_axis; ++i)
      pixels.emplace_back(-1.0 + (camera.width + 1.0) * i / per_axis,
                          -1.0 + (camera.height + 1.0) * j / per_axis);
  return pixels;
}

TEST_P(EveryCamera, ProjectsEveryUnprojectedPixelBackOntoItself) {
  const Camera& camera = GetParam().camera;
  double worst_px = 0.0;
  for (const Eigen::Vector2d& pixel : pixelGrid(camera, 200)) {
    Eigen::Vector3d ray;
    Eigen::Vector2d back;
    ASSERT_TRUE(unproject(camera, pixel, ray)) << pixel.transpose();
    ASSERT_EQ(ray.z(), 1.0);
    ASSERT_TRUE(project(camera, ray, back)) << pixel.transpose();
    worst_px = std::max(worst_px, (back - pixel).norm());
  }
  EXPECT_LT(worst_px, 1e-9);
  RecordProperty("worst_px", std::to_string(worst_px));
}

TEST_P(EveryCamera, UnprojectsEveryProjectedRayBackOntoItself) {
  const Camera& camera = GetParam().camera;
  Random random = randomFor("UnprojectsEveryProjectedRay" + GetParam().name);
  for (int i = 0; i < 5000; ++i) {
    const Eigen::Vector2d pixel(random.uniform(0.0, camera.width - 1.0),
                                random.uniform(0.0, camera.height - 1.0));
    Eigen::Vector3d ray;
    ASSERT_TRUE(unproject(camera, pixel, ray));
    const Eigen::Vector2d projected = pixelOf(camera, ray * random.uniform(0.01, 100.0));
    Eigen::Vector3d again;
    ASSERT_TRUE(unproject(camera, projected, again));
    EXPECT_LT((again - ray).norm(), 1e-12 * ray.squaredNorm()) << pixel.transpose();
  }
}

TEST_P(EveryCamera, JacobianAgreesWithFiniteDifferences) {
  const Camera& camera = GetParam().camera;
  Random random = randomFor("JacobianAgrees" + GetParam().name);
  for (int i = 0; i < 1000; ++i) {
    const Eigen::Vector2d at(random.uniform(0.0, camera.width - 1.0),
                             random.uniform(0.0, camera.height - 1.0));
    Eigen::Vector3d ray;
    ASSERT_TRUE(unproject(camera, at, ray));
    const Eigen::Vector3d point = ray * random.uniform(0.2, 5.0);
    Eigen::Vector2d pixel;
    Eigen::Matrix<double, 2, 3> jacobian;
    ASSERT_TRUE(projectWithJacobian(camera, point, pixel, jacobian));
    expectDerivatives(camera, point, jacobian, 1e-5 * point.z(), 1e-6 * (1.0 + jacobian.norm()));
  }
}

TEST_P(EveryCamera, BothProjectionsGiveTheSamePixel) {
  const Camera& camera = GetParam().camera;
  Random random = randomFor("BothProjections" + GetParam().name);
  for (int i = 0; i < 2000; ++i) {
    const Eigen::Vector3d point(random.uniform(-2.0, 2.0), random.uniform(-2.0, 2.0),
                                random.uniform(-0.2, 2.0));
    Eigen::Vector2d plain;
    Eigen::Vector2d pixel;
    Eigen::Matrix<double, 2, 3> jacobian;
    const bool valid = project(camera, point, plain);
    ASSERT_EQ(projectWithJacobian(camera, point, pixel, jacobian), valid);
    if (valid) {
      EXPECT_LT((pixel - plain).norm(), 1e-12 * (1000.0 + plain.norm()));
    }
  }
}

TEST_P(EveryCamera, PrincipalPoint_HasTheRayAlongZ) {
  const Camera& camera = GetParam().camera;
  Eigen::Vector2d pixel;
  Eigen::Matrix<double, 2, 3> jacobian;
  ASSERT_TRUE(projectWithJacobian(camera, {0.0, 0.0, 2.0}, pixel, jacobian));
  EXPECT_EQ(pixel, Eigen::Vector2d(camera.cx, camera.cy));
  Eigen::Matrix<double, 2, 3> expected;
  expected << camera.fx / 2.0, 0.0, 0.0, 0.0, camera.fy / 2.0, 0.0;
  EXPECT_LT((jacobian - expected).norm(), 1e-10);
  Eigen::Vector3d ray;
  ASSERT_TRUE(unproject(camera, {camera.cx, camera.cy}, ray));
  EXPECT_EQ(ray, Eigen::Vector3d(0.0, 0.0, 1.0));
}

TEST_P(EveryCamera, RefusesPointsBehindAndNonFiniteInput) {
  const Camera& camera = GetParam().camera;
  Eigen::Vector2d pixel;
  Eigen::Vector3d ray;
  Eigen::Matrix<double, 2, 3> jacobian;
  for (const Eigen::Vector3d& point :
       {Eigen::Vector3d(0.1, 0.1, 0.0), Eigen::Vector3d(0.1, 0.1, -1.0),
        Eigen::Vector3d(0.0, 0.0, -1e-300), Eigen::Vector3d(0.1, 0.1, 1e-320),
        Eigen::Vector3d(0.0, kNan, 1.0), Eigen::Vector3d(0.0, 0.0, kNan),
        Eigen::Vector3d(kInfinity, 0.0, 1.0), Eigen::Vector3d(kInfinity, 0.0, kInfinity)}) {
    EXPECT_FALSE(project(camera, point, pixel)) << point.transpose();
    EXPECT_FALSE(projectWithJacobian(camera, point, pixel, jacobian)) << point.transpose();
  }
  for (const Eigen::Vector2d& bad : {Eigen::Vector2d(kNan, 0.0), Eigen::Vector2d(0.0, kInfinity),
                                     Eigen::Vector2d(1e300, -1e300)})
    EXPECT_FALSE(unproject(camera, bad, ray)) << bad.transpose();
}

TEST_P(EveryCamera, CameraAtLevel_HasTheSameRayAtTheScaledPixel) {
  const Camera& camera = GetParam().camera;
  for (int level = 0; level <= 5; ++level) {
    const Camera pooled = cameraAtLevel(camera, level);
    const double size = std::ldexp(1.0, level);
    EXPECT_EQ(pooled.width, static_cast<int>(std::ceil(camera.width / size)));
    EXPECT_EQ(pooled.height, static_cast<int>(std::ceil(camera.height / size)));
    const Eigen::Vector3d point(0.05, -0.1, 1.0);
    const Eigen::Vector2d full = pixelOf(camera, point);
    const Eigen::Vector2d small = pixelOf(pooled, point);
    const Eigen::Vector2d half(0.5, 0.5);
    EXPECT_LT((small - ((full + half) / size - half)).norm(), 1e-10);
  }
}

TEST(PrepareCamera, RefusesInvalidParameters) {
  const Camera good = makeCamera(CameraModel::kBrownConrady, 640, 480, 500.0, {-0.1});
  ASSERT_GT(good.valid_radius, 0.0);
  const auto status = [&good](auto&& change) {
    Camera camera = good;
    change(camera);
    return prepareCamera(camera);
  };
  EXPECT_EQ(status([](Camera&) {}), Status::kOk);
  for (const double bad : {0.0, -500.0, kNan, kInfinity, -kInfinity}) {
    EXPECT_EQ(status([bad](Camera& c) { c.fx = bad; }), Status::kInvalidCamera) << bad;
    EXPECT_EQ(status([bad](Camera& c) { c.fy = bad; }), Status::kInvalidCamera) << bad;
  }
  for (const double bad : {kNan, kInfinity, -kInfinity}) {
    EXPECT_EQ(status([bad](Camera& c) { c.cx = bad; }), Status::kInvalidCamera) << bad;
    EXPECT_EQ(status([bad](Camera& c) { c.cy = bad; }), Status::kInvalidCamera) << bad;
    for (std::size_t i = 0; i < 8; ++i)
      EXPECT_EQ(status([bad, i](Camera& c) { c.distortion[i] = bad; }), Status::kInvalidCamera);
  }
  for (const int bad : {0, -1, std::numeric_limits<int>::min()}) {
    EXPECT_EQ(status([bad](Camera& c) { c.width = bad; }), Status::kInvalidCamera);
    EXPECT_EQ(status([bad](Camera& c) { c.height = bad; }), Status::kInvalidCamera);
  }
  EXPECT_EQ(status([](Camera& c) { c.model = static_cast<CameraModel>(7); }),
            Status::kInvalidCamera);
}

TEST(PrepareCamera, AcceptsAnyPrincipalPointAndHugeCoefficients) {
  Camera camera = makeCamera(CameraModel::kBrownConrady, 640, 480, 500.0);
  camera.cx = -1e4;
  camera.distortion = {-1e9, 1e12, 1e3, -1e3, -1e12, 1e12, -1e12, 1e12};
  EXPECT_EQ(prepareCamera(camera), Status::kOk);
  EXPECT_GT(camera.valid_radius, 0.0);
  EXPECT_LT(camera.valid_radius, 1e-3);
}

}  // namespace
}  // namespace boresight::test
