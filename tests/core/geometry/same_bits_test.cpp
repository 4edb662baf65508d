// SPDX-License-Identifier: Apache-2.0
#include <string>

#include <gtest/gtest.h>

#include "core/base/digest.h"
#include "core/geometry/camera.h"
#include "core/geometry/pose.h"
#include "tests/core/geometry/example_cameras.h"
#include "tests/core/geometry/planetary_cameras.h"

namespace boresight::test {
namespace {

template <class Values>
void writeAll(DigestWriter& writer, const Values& values) {
  for (const double value : values) writer.f64(value);
}

/// Row by row.
void writeAll(DigestWriter& writer, const Eigen::Matrix<double, 2, 3>& jacobian) {
  for (int k = 0; k < 6; ++k) writer.f64(jacobian(k / 3, k % 3));
}

/// Every machine, compiler and optimization level must give these bits: a digest that changes
/// means that localizations recorded before can no longer be reproduced.
template <class Fill>
std::string digestOf(Fill fill) {
  DigestWriter writer;
  fill(writer);
  return hexText(writer.digest()).data();
}

TEST(SameBits, OfElementaryFunctions) {
  const std::string digest = digestOf([](DigestWriter& writer) {
    Random random(2024);
    for (int i = 0; i < 20000; ++i) {
      const double x = random.uniform(-100.0, 100.0);
      const double y = random.uniform(-1.0, 1.0);
      const double values[] = {
          sin(x),      cos(x),      tan(x),  atan(x),
          atan2(x, y), atan2(y, x), asin(y), atan2(std::sqrt((1.0 - y) * (1.0 + y)), y),
          exp(x),      exp(y),      log(-x), log(1.0 + y)};
      writeAll(writer, values);
    }
  });
  EXPECT_EQ(digest, "35e969f2b3f0a1b59bb7af6ffc14e8f0cc2910da612871841a46cae4e8a68317");
}

TEST(SameBits, OfRandomNumbers) {
  const std::string digest = digestOf([](DigestWriter& writer) {
    Random random(2024, 7);
    for (int i = 0; i < 5000; ++i) {
      writer.u32(random.next());
      writer.u32(random.below(1000));
      writer.f64(random.uniform(-3.0, 4.0));
      writer.f64(random.normal());
    }
  });
  EXPECT_EQ(digest, "6de2c0677f2de6a16714f6ef0796394c24026df2a1a3cb91549f7e094b111dc8");
}

TEST(SameBits, OfPoses) {
  const std::string digest = digestOf([](DigestWriter& writer) {
    Random random(2024, 8);
    for (int i = 0; i < 2000; ++i) {
      const Pose a = randomPose(random);
      const Pose b = randomPose(random);
      Pose orthogonal;
      double deviation = 0.0;
      Eigen::Matrix3d matrix = a.matrix();
      matrix(i % 3, 1) += 1e-5;
      ASSERT_EQ(poseFromMatrix(matrix, b.translation_m, orthogonal, deviation), Status::kOk);
      for (const Pose& pose : {a * b, a.inverse(), orthogonal}) {
        writeAll(writer, pose.rotation.coeffs());
        writeAll(writer, pose.translation_m);
      }
      writeAll(writer, perturbationBetween(a, b));
      writeAll(writer, offsetAboutPivot(a, b, a.translation_m));
      writeAll(writer, perturbed(perturbationBetween(b, a), b).rotation.coeffs());
      writer.f64(deviation);
    }
  });
  EXPECT_EQ(digest, "58482e630d11e225089cc47d1ab1646c8c048f4016220f6084650545650906db");
}

TEST(SameBits, OfProjections) {
  const std::string digest = digestOf([](DigestWriter& writer) {
    Random random(2024, 9);
    for (const NamedCamera& named : exampleCameras()) {
      const Camera& camera = named.camera;
      writer.f64(camera.valid_radius);
      for (int i = 0; i < 1000; ++i) {
        Eigen::Vector2d pixel;
        pixel.x() = random.uniform(0.0, camera.width - 1.0);  // one by one: the order counts
        pixel.y() = random.uniform(0.0, camera.height - 1.0);
        Eigen::Vector3d ray;
        Eigen::Matrix<double, 2, 3> jacobian;
        ASSERT_TRUE(unproject(camera, pixel, ray));
        ASSERT_TRUE(projectWithJacobian(camera, 0.7 * ray, pixel, jacobian));
        writeAll(writer, ray);
        writeAll(writer, jacobian);
        ASSERT_TRUE(project(camera, 0.3 * ray, pixel));
        writeAll(writer, pixel);
      }
    }
  });
  EXPECT_EQ(digest, "f862229e8bdabe8def70515c561fc709fa8f475fb811436eebd1b382de989503");
}

TEST(SameBits, OfPlanetaryCameras) {
  const std::string digest = digestOf([](DigestWriter& writer) {
    Random random(2024, 10);
    for (const PlanetaryCamera& planetary : planetaryCameras()) {
      const Camera camera = planetary.camera();
      writer.f64(camera.valid_radius);
      writer.f64(camera.cahv.pupil_low_m);
      writer.f64(camera.cahv.pupil_high_m);
      for (int i = 0; i < 300; ++i) {
        Eigen::Vector3d point;
        point.x() = random.uniform(-1.0, 1.0);
        point.y() = random.uniform(-1.0, 1.0);
        point.z() = random.uniform(0.3, 2.0);
        Eigen::Vector2d pixel = Eigen::Vector2d::Zero();
        Eigen::Matrix<double, 2, 3> jacobian = Eigen::Matrix<double, 2, 3>::Zero();
        Ray ray;
        const bool projects = projectWithJacobian(camera, point, pixel, jacobian);
        writer.u8(projects ? 1 : 0);
        if (!projects) continue;
        writeAll(writer, pixel);
        writeAll(writer, jacobian);
        writer.u8(unprojectRay(camera, pixel, ray) ? 1 : 0);
        writeAll(writer, ray.direction);
        writeAll(writer, ray.origin_m);
      }
    }
  });
  EXPECT_EQ(digest, "db4342836b8acbeef2ac9d0b36a7fcb3230d8a7b067395eda35d34d51b6bd68e");
}

}  // namespace
}  // namespace boresight::test
