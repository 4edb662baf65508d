// SPDX-License-Identifier: Apache-2.0
#include "sessions/evaluation/model_error.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

#include "core/base/math.h"
#include "tests/support/random_pose.h"

namespace boresight::sessions {
namespace {

using test::randomFor;
using test::randomPose;

/// The corners of a cube of side 2 mm about the origin.
std::vector<Eigen::Vector3f> cube() {
  std::vector<Eigen::Vector3f> corners;
  for (int i = 0; i < 8; ++i)
    corners.emplace_back(i & 1 ? 1e-3f : -1e-3f, i & 2 ? 1e-3f : -1e-3f, i & 4 ? 1e-3f : -1e-3f);
  return corners;
}

Pose at(const Eigen::Vector3d& translation_m, const Eigen::Vector3d& rotation_rad) {
  return {rotationExp(rotation_rad), translation_m};
}

std::vector<Eigen::Vector3f> randomVertices(Random& random, int count) {
  std::vector<Eigen::Vector3f> vertices;
  for (int i = 0; i < count; ++i)
    vertices.emplace_back(static_cast<float>(random.uniform(-0.05, 0.05)),
                          static_cast<float>(random.uniform(-0.05, 0.05)),
                          static_cast<float>(random.uniform(-0.05, 0.05)));
  return vertices;
}

TEST(ModelError, ShiftMovesEveryVertexByItself) {
  const std::vector<Eigen::Vector3f> vertices = cube();
  const Pose truth = at({0.0, 0.0, 2.0}, {0.0, 0.0, 0.0});
  const Pose estimate = at({0.3e-3, 0.0, 2.0 + 0.4e-3}, {0.0, 0.0, 0.0});
  const PoseError error = wholeError(test::makePinhole(200, 200, 100.0), truth, estimate,
                                     std::nullopt, {vertices, nullptr});
  EXPECT_NEAR(*error.mssd_mm, 0.5, 1e-9);
  EXPECT_NEAR(*error.add_mm, 0.5, 1e-9);
  // A corner's nearest is its own: all others are at least 1.7 mm away.
  EXPECT_NEAR(*error.adi_mm, 0.5, 1e-9);
  EXPECT_NEAR(error.lateral_mm, 0.3, 1e-9);
  EXPECT_NEAR(error.normal_mm, -0.4, 1e-9);
}

TEST(ModelError, QuarterTurnOfACube) {
  const std::vector<Eigen::Vector3f> vertices = cube();
  const Pose truth = at({0.0, 0.0, 1.0}, {0.0, 0.0, 0.0});
  const Pose estimate = at({0.0, 0.0, 1.0}, {0.0, 0.0, 0.5 * kPi});
  const ModelView model{vertices, nullptr};
  // Every corner goes to the next one, a side away; none lies where none was.
  EXPECT_NEAR(surfaceDistance_m(truth, estimate, model), 2e-3, 1e-9);
  EXPECT_NEAR(meanDistance_m(truth, estimate, model), 2e-3, 1e-9);
  EXPECT_NEAR(meanNearestDistance_m(truth, estimate, model), 0.0, 1e-9);
  // The nearer corners, at 0.999 m, move farthest: 100 px * 2 mm / 0.999 m.
  EXPECT_NEAR(*projectionDistance_px(test::makePinhole(200, 200, 100.0), truth, estimate, model),
              0.2 / 0.999, 1e-6);
}

TEST(ModelError, DiscreteSymmetryCountsInEveryError) {
  const std::vector<Eigen::Vector3f> vertices = cube();
  Symmetries symmetries;
  symmetries.discrete = {at({0.0, 0.0, 0.0}, {0.0, 0.0, 0.5 * kPi})};
  const Pose truth = at({0.01, -0.02, 1.0}, {0.4, 0.1, -0.3});
  const Pose turned = truth * symmetries.discrete[0];
  const PoseError none = wholeError(test::makePinhole(200, 200, 100.0), truth, turned, std::nullopt,
                                    {vertices, &symmetries});
  for (const double value :
       {none.normal_mm, none.lateral_mm, none.rotation_mrad, none.in_plane_mrad, none.geodesic_mrad,
        *none.projection_px, *none.mssd_mm, *none.mspd_px, *none.add_mm, *none.adi_mm})
    EXPECT_NEAR(value, 0.0, 1e-6);
  // Not the other way about: the symmetry that is not listed is an error.
  const Pose back = truth * symmetries.discrete[0].inverse();
  EXPECT_NEAR(1e3 * surfaceDistance_m(truth, back, {vertices, &symmetries}), 2.0, 1e-6);
}

/// BOP's own list: turns in 315 steps after each discrete symmetry.
double bruteForceSurfaceDistance(const Pose& truth, const Pose& estimate,
                                 const std::vector<Eigen::Vector3f>& vertices,
                                 const Symmetries& symmetries) {
  double best = 1e9;
  std::vector<Pose> discrete = symmetries.discrete;
  discrete.emplace_back();
  for (const Pose& pose : discrete)
    for (int i = 0; i < 315; ++i) {
      const AxisSymmetry& axis = symmetries.continuous[0];
      const Eigen::Matrix3d turn =
          Eigen::AngleAxisd(i * 2.0 * kPi / 315, axis.axis).toRotationMatrix();
      double largest = 0.0;
      for (const Eigen::Vector3f& vertex : vertices) {
        const Eigen::Vector3d p = pose * vertex.cast<double>();
        const Eigen::Vector3d same = turn * (p - axis.point_m) + axis.point_m;
        largest = std::max(largest, (truth * same - estimate * vertex.cast<double>()).norm());
      }
      best = std::min(best, largest);
    }
  return best;
}

TEST(ModelError, TurnsAboutAnAxisAreTheChallengesAndFiner) {
  Random random = randomFor("ModelError.Turns");
  for (int i = 0; i < 10; ++i) {
    const auto vertices = randomVertices(random, 40);
    Symmetries symmetries;
    symmetries.discrete = {at({0.0, 0.002, 0.0}, {kPi, 0.0, 0.0})};
    symmetries.continuous = {{Eigen::Vector3d(0.0, 0.6, 0.8), Eigen::Vector3d(0.01, 0.0, 0.003)}};
    const Pose truth = randomPose(random);
    const Pose equal = truth * turnAbout(symmetries.continuous[0], random.uniform(0.0, 2.0 * kPi)) *
                       symmetries.discrete[0];
    const ModelView model{vertices, &symmetries};
    EXPECT_NEAR(surfaceDistance_m(truth, equal, model), 0.0, 1e-9);
    EXPECT_NEAR(meanDistance_m(truth, equal, model), 0.0, 1e-9);
    Vector6d offset;
    for (int k = 0; k < 6; ++k) offset[k] = random.uniform(-0.03, 0.03);
    const Pose estimate = perturbed(offset, equal);
    const double sampled = bruteForceSurfaceDistance(truth, estimate, vertices, symmetries);
    const double found = surfaceDistance_m(truth, estimate, model);
    EXPECT_LE(found, sampled + 1e-12);
    // Half a step of 0.02 rad moves nothing by more than 0.01 times its distance from the axis.
    EXPECT_GE(found, sampled - 0.01 * 0.1);
  }
}

TEST(ModelError, TubeTurnedAboutItsAxisIsNoError) {
  Random random = randomFor("ModelError.Tube");
  const auto vertices = randomVertices(random, 60);
  Symmetries symmetries;
  symmetries.continuous = {{Eigen::Vector3d::UnitZ(), Eigen::Vector3d::Zero()}};
  const Pose truth = at({0.01, 0.02, 0.5}, {0.1, -0.2, 0.0});
  const Pose estimate = truth * at({0.0, 0.0, 0.0}, {0.0, 0.0, 1.2345});
  const PoseError error = wholeError(test::makePinhole(200, 200, 100.0), truth, estimate,
                                     std::nullopt, {vertices, &symmetries});
  EXPECT_NEAR(error.geodesic_mrad, 0.0, 1e-5);
  EXPECT_NEAR(error.in_plane_mrad, 0.0, 1e-5);
  EXPECT_NEAR(*error.projection_px, 0.0, 1e-6);
  EXPECT_NEAR(*error.mspd_px, 0.0, 1e-6);
}

TEST(ModelError, HiddenVertexCountsAsADiagonal) {
  const std::vector<Eigen::Vector3f> vertices = cube();
  const Pose truth = at({0.0, 0.0, 1.0}, {0.0, 0.0, 0.0});
  const Pose behind = at({0.0, 0.0, -1.0}, {0.0, 0.0, 0.0});
  EXPECT_NEAR(*projectionDistance_px(test::makePinhole(200, 200, 100.0), truth, behind,
                                     {vertices, nullptr}),
              std::hypot(200.0, 200.0), 1e-9);
  EXPECT_FALSE(projectionDistance_px(test::makePinhole(200, 200, 100.0), behind, truth,
                                     {vertices, nullptr}));
}

TEST(NearestPoint, IsWhatBruteForceFinds) {
  Random random = randomFor("NearestPoint");
  for (const int count : {1, 2, 3, 50, 777}) {
    std::vector<Eigen::Vector3d> points;
    for (const Eigen::Vector3f& v : randomVertices(random, count))
      points.push_back(v.cast<double>());
    points.push_back(points.front());  // the same twice
    const NearestPoint nearest(points);
    for (int i = 0; i < 100; ++i) {
      const Eigen::Vector3d query = 1.5 * randomVertices(random, 1)[0].cast<double>();
      double expected = 1e9;
      for (const Eigen::Vector3d& p : points) expected = std::min(expected, (p - query).norm());
      EXPECT_DOUBLE_EQ(nearest.distance(query), expected);
    }
  }
  EXPECT_TRUE(std::isinf(NearestPoint({}).distance({0.0, 0.0, 0.0})));
}

}  // namespace
}  // namespace boresight::sessions
