// SPDX-License-Identifier: Apache-2.0
#include "core/geometry/camera.h"

#include <algorithm>
#include <cmath>
#include <limits>

#include <gtest/gtest.h>

#include "tests/core/geometry/planetary_cameras.h"
#include "tests/support/not_finite.h"
#include "tests/support/random_pose.h"

namespace boresight::test {
namespace {

class EveryCamera : public ::testing::TestWithParam<NamedCamera> {};
INSTANTIATE_TEST_SUITE_P(Camera, EveryCamera, ::testing::ValuesIn(exampleAndPlanetaryCameras()),
                         [](const auto& instance) { return instance.param.name; });

class ExampleCamera : public ::testing::TestWithParam<NamedCamera> {};
INSTANTIATE_TEST_SUITE_P(Camera, ExampleCamera, ::testing::ValuesIn(exampleCameras()),
                         [](const auto& instance) { return instance.param.name; });

TEST_P(EveryCamera, ProjectsEveryRayBackOntoItsPixel) {
  const Camera& camera = GetParam().camera;
  double worst_px = 0.0;
  for (int j = 0; j <= 100; ++j) {
    for (int i = 0; i <= 100; ++i) {
      const Eigen::Vector2d pixel(-1.0 + (camera.width + 1.0) * i / 100.0,
                                  -1.0 + (camera.height + 1.0) * j / 100.0);
      const Ray ray = rayOf(camera, pixel);
      ASSERT_EQ(ray.direction.z(), 1.0);
      for (const double depth_m : {0.1, 0.5, 20.0})
        worst_px = std::max(worst_px, (pixelOf(camera, ray.at(depth_m)) - pixel).norm());
      Eigen::Vector3d direction;
      Eigen::Vector2d back;
      ASSERT_TRUE(unproject(camera, pixel, direction));
      EXPECT_EQ(direction, ray.direction);
      ASSERT_TRUE(projectDirection(camera, 3.0 * direction, back));
      worst_px = std::max(worst_px, (back - pixel).norm());
    }
  }
  EXPECT_LT(worst_px, 1e-9);
}

TEST_P(ExampleCamera, UnprojectsEveryProjectedRayBackOntoItself) {
  const Camera& camera = GetParam().camera;
  Random random = randomFor("UnprojectsEveryProjectedRay" + GetParam().name);
  for (int i = 0; i < 5000; ++i) {
    const Eigen::Vector2d pixel = randomPixel(camera, random);
    const Eigen::Vector3d ray = rayOf(camera, pixel).direction;
    const Eigen::Vector2d projected = pixelOf(camera, ray * random.uniform(0.01, 100.0));
    EXPECT_LT((rayOf(camera, projected).direction - ray).norm(), 1e-12 * ray.squaredNorm())
        << pixel.transpose();
  }
}

TEST_P(EveryCamera, JacobianAgreesWithFiniteDifferences) {
  const Camera& camera = GetParam().camera;
  Random random = randomFor("JacobianAgrees" + GetParam().name);
  for (int i = 0; i < 1000; ++i) {
    const Ray ray = rayOf(camera, randomPixel(camera, random));
    const Eigen::Vector3d point = ray.at(random.uniform(0.1, 5.0));
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
    Eigen::Vector2d plain, pixel;
    Eigen::Matrix<double, 2, 3> jacobian;
    const bool valid = project(camera, point, plain);
    ASSERT_EQ(projectWithJacobian(camera, point, pixel, jacobian), valid);
    if (!valid) continue;
    EXPECT_LE((pixel - plain).norm(),
              isCahvFamily(camera.model) ? 0.0 : 1e-12 * (1000.0 + plain.norm()));
  }
}

TEST_P(ExampleCamera, PrincipalPoint_HasTheRayAlongZ) {
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
  Ray ray;
  Eigen::Matrix<double, 2, 3> jacobian;
  for (const Eigen::Vector3d& point :
       {Eigen::Vector3d(0.1, 0.1, 0.0), Eigen::Vector3d(0.1, 0.1, -1.0),
        Eigen::Vector3d(0.0, 0.0, -1e-300), Eigen::Vector3d(0.1, 0.1, 1e-320),
        Eigen::Vector3d(0.0, 0.0, 0.0), Eigen::Vector3d(0.0, kNan, 1.0),
        Eigen::Vector3d(0.0, 0.0, kNan), Eigen::Vector3d(kInfinity, 0.0, 1.0),
        Eigen::Vector3d(kInfinity, 0.0, kInfinity)}) {
    EXPECT_FALSE(project(camera, point, pixel)) << point.transpose();
    EXPECT_FALSE(projectDirection(camera, point, pixel)) << point.transpose();
    EXPECT_FALSE(projectWithJacobian(camera, point, pixel, jacobian)) << point.transpose();
  }
  for (const Eigen::Vector2d& bad : {Eigen::Vector2d(kNan, 0.0), Eigen::Vector2d(0.0, kInfinity),
                                     Eigen::Vector2d(1e300, -1e300)}) {
    EXPECT_FALSE(unproject(camera, bad, ray.direction)) << bad.transpose();
    EXPECT_FALSE(unprojectRay(camera, bad, ray)) << bad.transpose();
  }
}

TEST_P(EveryCamera, LevelsAndCrops_ProjectTheSamePoints) {
  const Camera& camera = GetParam().camera;
  Camera part = camera;
  ASSERT_EQ(cutToFrame(100, -37, 400, 300, part), Status::kOk);
  Random random = randomFor("LevelsAndCrops" + GetParam().name);
  for (int level = 0; level <= 5; ++level) {
    const Camera pooled = cameraAtLevel(camera, level);
    const double size = std::ldexp(1.0, level);
    EXPECT_EQ(pooled.width, static_cast<int>(std::ceil(camera.width / size)));
    EXPECT_EQ(pooled.height, static_cast<int>(std::ceil(camera.height / size)));
    for (int i = 0; i < 200; ++i) {
      const Eigen::Vector3d point = rayOf(camera, randomPixel(camera, random)).at(0.4);
      const Eigen::Vector2d full = pixelOf(camera, point);
      const Eigen::Vector2d half(0.5, 0.5);
      EXPECT_LT((pixelOf(pooled, point) - ((full + half) / size - half)).norm(), 1e-10);
      EXPECT_LT((pixelOf(part, point) - full + Eigen::Vector2d(100.0, -37.0)).norm(), 1e-9);
    }
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
  const auto refused = [&](auto&& change) { EXPECT_EQ(status(change), Status::kInvalidCamera); };
  for (const auto focal_length : {&Camera::fx, &Camera::fy})
    for (const double bad : {0.0, -500.0, kNan, kInfinity, -kInfinity})
      refused([=](Camera& c) { c.*focal_length = bad; });
  for (const double bad : {kNan, kInfinity, -kInfinity}) {
    refused([bad](Camera& c) { c.cx = bad; });
    refused([bad](Camera& c) { c.cy = bad; });
    for (std::size_t i = 0; i < 8; ++i) refused([=](Camera& c) { c.distortion[i] = bad; });
  }
  for (const int bad : {0, -1, std::numeric_limits<int>::min()}) {
    refused([bad](Camera& c) { c.width = bad; });
    refused([bad](Camera& c) { c.height = bad; });
  }
  refused([](Camera& c) { c.model = static_cast<CameraModel>(7); });
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
