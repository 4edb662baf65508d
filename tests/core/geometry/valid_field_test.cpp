// SPDX-License-Identifier: Apache-2.0
#include <algorithm>
#include <cmath>

#include <gtest/gtest.h>

#include "core/geometry/camera.h"
#include "core/geometry/polynomial.h"
#include "tests/support/random_pose.h"

namespace boresight::test {
namespace {

/// Unit focal length and no offset: pixels are points of the plane z = 1.
Camera unitCamera(CameraModel model, const std::array<double, 8>& distortion) {
  Camera camera;
  camera.model = model;
  camera.width = camera.height = 10;
  camera.fx = camera.fy = 1.0;
  camera.distortion = distortion;
  EXPECT_EQ(prepareCamera(camera), Status::kOk);
  return camera;
}

/// Coefficients wild enough that most models fold somewhere between 0.2 and 5.
std::array<double, 8> wildDistortion(Random& random, bool tangential) {
  const double p = tangential ? 0.03 : 0.0;
  return {random.uniform(-0.6, 0.6), random.uniform(-0.3, 0.3), random.uniform(-p, p),
          random.uniform(-p, p),     random.uniform(-0.1, 0.1), random.uniform(-0.4, 0.6),
          random.uniform(-0.2, 0.3), random.uniform(-0.1, 0.1)};
}

Eigen::Vector3d rayAt(double radius, double azimuth_rad) {
  return {radius * std::cos(azimuth_rad), radius * std::sin(azimuth_rad), 1.0};
}

bool projects(const Camera& camera, const Eigen::Vector3d& ray) {
  Eigen::Vector2d pixel;
  return project(camera, ray, pixel);
}

bool unprojects(const Camera& camera, const Eigen::Vector2d& pixel) {
  Eigen::Vector3d ray;
  return unproject(camera, pixel, ray);
}

/// The written-out definition of the radial factor times r.
double distortedRadius(const Camera& camera, double r) {
  const auto& k = camera.distortion;
  const double s = r * r;
  return r * (1.0 + k[0] * s + k[1] * s * s + k[4] * s * s * s) /
         (1.0 + k[5] * s + k[6] * s * s + k[7] * s * s * s);
}

TEST(ValidField, EndsWhereTheBarrelStopsIncreasing) {
  const Camera camera = unitCamera(CameraModel::kBrownConrady, {-0.3});
  EXPECT_NEAR(camera.valid_radius, 1.0 / std::sqrt(0.9), 1e-12);
  EXPECT_TRUE(projects(camera, rayAt(camera.valid_radius * 0.9999, 0.7)));
  EXPECT_FALSE(projects(camera, rayAt(camera.valid_radius * 1.0001, 0.7)));
  const double edge = distortedRadius(camera, camera.valid_radius);
  EXPECT_TRUE(unprojects(camera, {edge * 0.99999, 0.0}));
  EXPECT_FALSE(unprojects(camera, {edge * 1.00001, 0.0}));
  EXPECT_FALSE(unprojects(camera, {0.0, -10.0 * edge}));
}

TEST(ValidField, IsUnlimitedForAnIncreasingModel_EndsBeforeThePoleOfARationalOne) {
  EXPECT_GT(unitCamera(CameraModel::kPinhole, {}).valid_radius, 1e3);
  EXPECT_GT(unitCamera(CameraModel::kBrownConrady, {}).valid_radius, 1e3);
  // 1 - 0.36 s + 0.3 s^2 has no real root; the field ends where |q| becomes absurd.
  const Camera camera = unitCamera(CameraModel::kBrownConrady, {-0.12, 0.06});
  EXPECT_GT(camera.valid_radius, 10.0);
  EXPECT_NEAR(distortedRadius(camera, camera.valid_radius), 1e4, 1e-3);
  const Camera rational = unitCamera(CameraModel::kBrownConrady, {0.0, 0.0, 0.0, 0.0, 0.0, -0.25});
  EXPECT_LT(rational.valid_radius, 2.0);
  EXPECT_GT(rational.valid_radius, 1.999);
  EXPECT_FALSE(projects(rational, rayAt(2.5, 0.0)));
}

TEST(ValidField, AgreesWithADenseScanOfTheRadialFactor) {
  Random random = randomFor("AgreesWithADenseScan");
  int folding = 0;
  for (int i = 0; i < 300; ++i) {
    const Camera camera = unitCamera(CameraModel::kBrownConrady, wildDistortion(random, false));
    constexpr double kStep = 1e-3;
    double scanned = kStep;
    while (scanned < 5.0 && distortedRadius(camera, scanned) < 1e4 &&
           distortedRadius(camera, scanned + kStep) > distortedRadius(camera, scanned))
      scanned += kStep;
    if (scanned >= 5.0) {
      EXPECT_GT(camera.valid_radius, 5.0 - 2.0 * kStep);
    } else {
      EXPECT_NEAR(camera.valid_radius, scanned, 2.0 * kStep);
      ++folding;
    }
  }
  EXPECT_GT(folding, 100);
}

/// Smallest eigenvalue of the Jacobian of the plane's map, which is symmetric.
double smallestEigenvalue(const Camera& camera, const Eigen::Vector3d& ray) {
  Eigen::Vector2d pixel;
  Eigen::Matrix<double, 2, 3> jacobian;
  EXPECT_TRUE(projectWithJacobian(camera, ray, pixel, jacobian));
  EXPECT_NEAR(jacobian(0, 1), jacobian(1, 0), 1e-12 * jacobian.norm());
  const double mean = 0.5 * (jacobian(0, 0) + jacobian(1, 1));
  const double half = 0.5 * (jacobian(0, 0) - jacobian(1, 1));
  return mean - std::hypot(half, jacobian(0, 1));
}

TEST(ValidField, IsOneToOneWithTangentialTerms) {
  Random random = randomFor("IsOneToOneWithTangentialTerms");
  for (int i = 0; i < 300; ++i) {
    const Camera camera = unitCamera(CameraModel::kBrownConrady, wildDistortion(random, true));
    for (int j = 0; j < 200; ++j) {
      const double radius = camera.valid_radius * std::sqrt(random.uniform());
      EXPECT_GT(smallestEigenvalue(camera, rayAt(radius, random.uniform(-kPi, kPi))), 0.0);
    }
  }
}

TEST(ValidField, TangentialTermsEndItWhereTheFirstDirectionFolds) {
  const Camera camera = unitCamera(CameraModel::kBrownConrady, {-0.3, 0.0, 0.02, -0.01});
  EXPECT_LT(camera.valid_radius, 1.0 / std::sqrt(0.9));
  // The worst direction is opposite to (p2, p1); there the last eigenvalue is just used up.
  const double azimuth_rad = std::atan2(-0.02, 0.01);
  const Eigen::Vector3d last = rayAt(camera.valid_radius * (1.0 - 1e-12), azimuth_rad);
  EXPECT_NEAR(smallestEigenvalue(camera, last), 0.0, 1e-10);
}

TEST(ValidField, EveryPointInside_IsRecoveredFromItsPixel) {
  Random random = randomFor("EveryPointInsideIsFoundAgain");
  for (int i = 0; i < 2000; ++i) {
    const bool fisheye = i % 4 == 0;
    const Camera camera =
        fisheye ? unitCamera(CameraModel::kKannalaBrandt, wildDistortion(random, false))
                : unitCamera(CameraModel::kBrownConrady, wildDistortion(random, i % 4 > 1));
    const double end =
        std::min(fisheye ? std::tan(camera.valid_radius) : camera.valid_radius, 20.0);
    for (int j = 0; j < 20; ++j) {
      // Half of them hard against the end of the field, where the Jacobian vanishes.
      const double inside = j % 2 == 0 ? random.uniform() : 1.0 - 1e-3 * random.uniform();
      const Eigen::Vector3d ray = rayAt(end * inside, random.uniform(-kPi, kPi));
      Eigen::Vector2d pixel, again;
      Eigen::Vector3d found;
      ASSERT_TRUE(project(camera, ray, pixel));
      ASSERT_TRUE(unproject(camera, pixel, found)) << "camera " << i << ", ray " << ray.transpose();
      ASSERT_TRUE(project(camera, found, again));
      EXPECT_LT((again - pixel).norm(), 1e-11 * (1.0 + pixel.norm()));
      const double slope = smallestEigenvalue(camera, ray);
      EXPECT_LT((found - ray).norm() * slope, 1e-9 * (1.0 + ray.squaredNorm()));
    }
  }
}

TEST(ValidField, Unproject_IsCorrectOrFails) {
  Random random = randomFor("UnprojectNeverAnswersWrongly");
  int refused = 0;
  for (int i = 0; i < 2000; ++i) {
    const auto model = i % 4 == 0 ? CameraModel::kKannalaBrandt : CameraModel::kBrownConrady;
    const Camera camera = unitCamera(model, wildDistortion(random, true));
    for (int j = 0; j < 20; ++j) {
      const double far = j % 4 == 0 ? 1000.0 : 3.0;
      const Eigen::Vector2d pixel(random.uniform(-far, far), random.uniform(-far, far));
      Eigen::Vector3d ray;
      Eigen::Vector2d back;
      if (!unproject(camera, pixel, ray)) {
        ++refused;
        continue;
      }
      ASSERT_TRUE(project(camera, ray, back)) << "camera " << i << ", pixel " << pixel.transpose();
      EXPECT_LT((back - pixel).norm(), 1e-10 * (1.0 + pixel.norm()));
    }
  }
  EXPECT_GT(refused, 1000);
}

TEST(ValidField, FisheyeEndsWhereItsPolynomialDoesOrAtARightAngle) {
  // d theta_d / d theta = 1 - 3 * 0.4 theta^2.
  const Camera folding = unitCamera(CameraModel::kKannalaBrandt, {-0.4});
  EXPECT_NEAR(folding.valid_radius, 1.0 / std::sqrt(1.2), 1e-12);
  EXPECT_TRUE(projects(folding, rayAt(std::tan(folding.valid_radius) * 0.9999, 2.0)));
  EXPECT_FALSE(projects(folding, rayAt(std::tan(folding.valid_radius) * 1.0001, 2.0)));

  const Camera wide = unitCamera(CameraModel::kKannalaBrandt, {});
  EXPECT_NEAR(wide.valid_radius, kPi / 2.0, 2e-4);
  Eigen::Vector3d ray;
  EXPECT_TRUE(unproject(wide, {1.57, 0.0}, ray));
  EXPECT_NEAR(ray.x(), std::tan(1.57), 1e-9 * std::tan(1.57));
  EXPECT_FALSE(unprojects(wide, {1.5708, 0.0}));  // sideways and backwards
  EXPECT_FALSE(unprojects(wide, {2.0, 2.0}));
}

TEST(ValidField, FisheyeIsSmoothThroughItsCentre) {
  const Camera camera = unitCamera(CameraModel::kKannalaBrandt, {0.1, 0.02, 0.0, 0.0});
  for (const double radius : {1e-150, 1e-80, 1e-20, 1e-9, 1e-5}) {
    Eigen::Vector2d pixel;
    Eigen::Matrix<double, 2, 3> jacobian;
    ASSERT_TRUE(projectWithJacobian(camera, rayAt(radius, 0.3), pixel, jacobian));
    EXPECT_NEAR(pixel.norm(), radius, 1e-8 * radius);
    EXPECT_NEAR(jacobian(0, 0), 1.0, 2.0 * radius * radius + 1e-15);
    EXPECT_NEAR(jacobian(0, 1), 0.0, 2.0 * radius * radius + 1e-15);
    Eigen::Vector3d ray;
    ASSERT_TRUE(unproject(camera, pixel, ray));
    EXPECT_NEAR(ray.head<2>().norm(), radius, 1e-8 * radius);
  }
}

TEST(Polynomial, EvaluatesMultipliesAndDifferentiates) {
  const Polynomial a{{1.0, 2.0, 3.0}};
  const Polynomial b{{-1.0, 0.0, 0.0, 4.0}};
  for (const double x : {-1.5, 0.0, 0.3, 2.0}) {
    const double at_a = 1.0 + 2.0 * x + 3.0 * x * x;
    const double at_b = -1.0 + 4.0 * x * x * x;
    EXPECT_NEAR(a(x), at_a, 1e-12);
    EXPECT_NEAR((a * b)(x), at_a * at_b, 1e-10);
    EXPECT_NEAR((a + 2.5 * b)(x), at_a + 2.5 * at_b, 1e-11);
    EXPECT_NEAR(b.derivative()(x), 12.0 * x * x, 1e-11);
  }
}

TEST(PositiveUpTo, FindsTheFirstOfManyRoots) {
  Random random = randomFor("FindsTheFirstOfManyRoots");
  for (int i = 0; i < 500; ++i) {
    Polynomial polynomial{{1.0}};
    double first = 10.0;
    const int roots = static_cast<int>(random.below(6));
    for (int k = 0; k < roots; ++k) {
      const double root = random.uniform(0.05, 5.0);
      first = std::min(first, root);
      polynomial = polynomial * Polynomial{{1.0, -1.0 / root}};
      // A pair of complex roots: bends without reaching zero.
      const double centre = random.uniform(0.1, 5.0);
      polynomial = polynomial * Polynomial{{centre * centre + 0.5, -2.0 * centre, 1.0}};
    }
    // Roots that nearly coincide lose digits; with neighbours far apart all remain.
    EXPECT_NEAR(positiveUpTo(polynomial, 10.0), first, 1e-5 * first) << i;
  }
}

TEST(PositiveUpTo, NeverReturnsAPointThatIsNotPositive) {
  Random random = randomFor("NeverReturnsAPointThatIsNotPositive");
  for (int i = 0; i < 500; ++i) {
    Polynomial polynomial{{1.0}};
    for (std::size_t k = 1; k < 14; ++k) polynomial.c[k] = random.uniform(-1.0, 1.0);
    const double end = positiveUpTo(polynomial, 1e4);
    EXPECT_GT(polynomial(end), 0.0);
    if (end < 1e4) {
      EXPECT_LE(polynomial(std::nextafter(end, 1e5)), 0.0);
    }
    for (int j = 0; j < 200; ++j) EXPECT_GT(polynomial(random.uniform(0.0, end)), 0.0);
  }
}

TEST(PositiveUpTo, FindsTheFirstOfTwoCloseRoots_IsTheLimitWithoutRootsAndZeroWithoutAStart) {
  // (x - 1) (x - 1.0001): negative on a ten-thousandth only.
  EXPECT_NEAR(positiveUpTo({{1.0001, -2.0001, 1.0}}, 100.0), 1.0, 1e-9);
  EXPECT_EQ(positiveUpTo({{1.0}}, 7.0), 7.0);
  EXPECT_EQ(positiveUpTo({{1.0, 0.0, 3.0}}, 7.0), 7.0);
  EXPECT_EQ(positiveUpTo({{1.0, -0.1}}, 7.0), 7.0);  // its root is beyond
  EXPECT_EQ(positiveUpTo({{0.0, 1.0}}, 7.0), 0.0);
  EXPECT_EQ(positiveUpTo({{-1.0, 5.0}}, 7.0), 0.0);
}

}  // namespace
}  // namespace boresight::test
