// SPDX-License-Identifier: Apache-2.0
#include "core/pnp/p3p.h"

#include <algorithm>
#include <cmath>
#include <limits>

#include <gtest/gtest.h>
#include <Eigen/LU>

#include "tests/support/random_pose.h"

namespace boresight::test {
namespace {

struct Triplet {
  Pose camera_from_station;
  std::array<Eigen::Vector3d, 3> bearing;
  std::array<Eigen::Vector3d, 3> point_in_station_m;
};

Triplet seen(const Pose& camera_from_station, const std::array<Eigen::Vector3d, 3>& in_camera_m) {
  Triplet made{camera_from_station, {}, {}};
  const Pose station_from_camera = camera_from_station.inverse();
  for (std::size_t i = 0; i < 3; ++i) {
    made.bearing[i] = in_camera_m[i].normalized();
    made.point_in_station_m[i] = station_from_camera * in_camera_m[i];
  }
  return made;
}

Triplet randomTriplet(Random& random) {
  std::array<Eigen::Vector3d, 3> in_camera_m;
  for (Eigen::Vector3d& point : in_camera_m) {
    const double x = random.uniform(-1.0, 1.0);
    const double y = random.uniform(-1.0, 1.0);
    point = {x, y, random.uniform(0.2, 3.0)};
  }
  return seen(randomPose(random), in_camera_m);
}

double distance(const Pose& a, const Pose& b) {
  return std::max(rotationLog(a.rotation * b.rotation.conjugate()).norm(),
                  (a.translation_m - b.translation_m).norm());
}

double nearest(const std::array<Pose, 4>& solutions, int count, const Pose& truth) {
  double best = std::numeric_limits<double>::infinity();
  for (int i = 0; i < count; ++i) {
    best = std::min(best, distance(solutions[static_cast<std::size_t>(i)], truth));
  }
  return best;
}

/// How well three distances determine three depths: the determinant of their Jacobian (zero at a
/// double root) and the triangle's area, both over its longest side.
double conditioning(const Triplet& triplet) {
  Eigen::Matrix3d jacobian = Eigen::Matrix3d::Zero();
  std::array<Eigen::Vector3d, 3> p;
  for (std::size_t i = 0; i < 3; ++i) {
    p[i] = triplet.camera_from_station * triplet.point_in_station_m[i];
  }
  double longest = 0.0;
  for (std::size_t row = 0; row < 3; ++row) {
    const std::size_t i = row;
    const std::size_t j = (row + 1) % 3;
    jacobian(static_cast<int>(row), static_cast<int>(i)) = (p[i] - p[j]).dot(triplet.bearing[i]);
    jacobian(static_cast<int>(row), static_cast<int>(j)) = (p[j] - p[i]).dot(triplet.bearing[j]);
    longest = std::max(longest, (p[i] - p[j]).norm());
  }
  const double area = (p[1] - p[0]).cross(p[2] - p[0]).norm() / (longest * longest);
  return std::min(std::abs(jacobian.determinant()) / (longest * longest * longest), area);
}

TEST(SolveP3p, FindsTheTruePoseAmongItsSolutions) {
  Random random = randomFor("SolveP3p.FindsTheTruePoseAmongItsSolutions");
  int ill_conditioned = 0;
  constexpr int kTrials = 20000;
  for (int trial = 0; trial < kTrials; ++trial) {
    const Triplet triplet = randomTriplet(random);
    std::array<Pose, 4> solutions;
    const int count = solveP3p(triplet.bearing, triplet.point_in_station_m, solutions);
    const bool ill = conditioning(triplet) < 1e-3;
    ill_conditioned += ill ? 1 : 0;
    ASSERT_LT(nearest(solutions, count, triplet.camera_from_station), ill ? 1e-5 : 1e-11)
        << "trial " << trial << ", conditioning " << conditioning(triplet);
  }
  EXPECT_LT(ill_conditioned, kTrials / 33);
}

TEST(SolveP3p, FindsTheTruePoseOfSmallFrontalTriangles) {
  Random random = randomFor("SolveP3p.FindsTheTruePoseOfSmallFrontalTriangles");
  for (int trial = 0; trial < 5000; ++trial) {
    std::array<Eigen::Vector3d, 3> in_camera_m;
    for (Eigen::Vector3d& point : in_camera_m) {
      const double x = random.uniform(-0.1, 0.1);
      const double y = random.uniform(-0.1, 0.1);
      point = {x, y, random.uniform(0.43, 0.47)};
    }
    const Triplet triplet = seen(randomPose(random), in_camera_m);
    if (conditioning(triplet) < 1e-2) continue;
    std::array<Pose, 4> solutions;
    const int count = solveP3p(triplet.bearing, triplet.point_in_station_m, solutions);
    ASSERT_LT(nearest(solutions, count, triplet.camera_from_station), 1e-9) << "trial " << trial;
  }
}

TEST(SolveP3p, EverySolutionSeesThePointsAlongTheBearings) {
  Random random = randomFor("SolveP3p.EverySolutionSeesThePointsAlongTheBearings");
  int found = 0;
  double worst = 0.0;
  for (int trial = 0; trial < 5000; ++trial) {
    const Triplet triplet = randomTriplet(random);
    std::array<Pose, 4> solutions;
    const int count = solveP3p(triplet.bearing, triplet.point_in_station_m, solutions);
    for (int i = 0; i < count; ++i) {
      const Pose& pose = solutions[static_cast<std::size_t>(i)];
      ASSERT_NEAR(pose.rotation.norm(), 1.0, 1e-14);
      for (std::size_t k = 0; k < 3; ++k) {
        const Eigen::Vector3d direction = (pose * triplet.point_in_station_m[k]).normalized();
        worst = std::max(worst, (direction - triplet.bearing[k]).norm());
      }
      ++found;
    }
  }
  EXPECT_LT(worst, 1e-10);
  EXPECT_GT(found, 5000);
}

TEST(SolveP3p, SolvesTheSymmetricPyramid) {
  // An equilateral triangle seen from its axis: coinciding roots.
  std::array<Eigen::Vector3d, 3> in_camera_m;
  for (int i = 0; i < 3; ++i) {
    const double azimuth_rad = 2.0 * kPi / 3.0 * i;
    in_camera_m[static_cast<std::size_t>(i)] = {0.3 * cosine(azimuth_rad), 0.3 * sine(azimuth_rad),
                                                1.0};
  }
  const Triplet triplet = seen(Pose(), in_camera_m);
  std::array<Pose, 4> solutions;
  const int count = solveP3p(triplet.bearing, triplet.point_in_station_m, solutions);
  EXPECT_LT(nearest(solutions, count, Pose()), 1e-7);
}

TEST(SolveP3p, SolvesSymmetricTriangles) {
  // Isosceles triangles before the camera, two corners mirrored in the plane x = 0, in every
  // numbering: determinants and coefficients that vanish exactly.
  for (const double height : {0.5, 1.0, 2.0}) {
    for (const double depth : {1.0, 1.5, 3.0}) {
      std::array<Eigen::Vector3d, 3> in_camera_m = {Eigen::Vector3d(-0.5, 0.0, 1.0),
                                                    Eigen::Vector3d(0.5, 0.0, 1.0),
                                                    Eigen::Vector3d(0.0, height, depth)};
      for (int turn = 0; turn < 3; ++turn) {
        std::rotate(in_camera_m.begin(), in_camera_m.begin() + 1, in_camera_m.end());
        const Triplet triplet = seen(Pose(), in_camera_m);
        if (conditioning(triplet) < 1e-3) continue;
        std::array<Pose, 4> solutions;
        const int count = solveP3p(triplet.bearing, triplet.point_in_station_m, solutions);
        EXPECT_LT(nearest(solutions, count, Pose()), 1e-9) << height << " " << depth;
      }
    }
  }
}

TEST(SolveP3p, DoesNotDependOnTheUnitOfLength) {
  Random random = randomFor("SolveP3p.DoesNotDependOnTheUnitOfLength");
  for (int trial = 0; trial < 500; ++trial) {
    Triplet triplet = randomTriplet(random);
    if (conditioning(triplet) < 1e-2) continue;
    for (const double scale : {1e-6, 1e6}) {
      Triplet scaled_triplet = triplet;
      for (Eigen::Vector3d& point : scaled_triplet.point_in_station_m) point *= scale;
      std::array<Pose, 4> solutions;
      const int count =
          solveP3p(scaled_triplet.bearing, scaled_triplet.point_in_station_m, solutions);
      for (Pose& pose : solutions) pose.translation_m /= scale;
      ASSERT_LT(nearest(solutions, count, triplet.camera_from_station), 1e-9);
    }
  }
}

TEST(SolveP3p, ImpossibleBearingsGiveNoPose) {
  // An equilateral triangle. The third bearing is 120 deg from the other two, so that a depth along
  // it leaves one depth, the same, for both; but these two are nearly parallel.
  const std::array<Eigen::Vector3d, 3> bearing = {Eigen::Vector3d(0.005, 0.0, 1.0).normalized(),
                                                  Eigen::Vector3d(-0.005, 0.0, 1.0).normalized(),
                                                  Eigen::Vector3d(0.0, std::sqrt(0.75), -0.5)};
  const std::array<Eigen::Vector3d, 3> point = {Eigen::Vector3d(0.0, 0.0, 0.0),
                                                Eigen::Vector3d(1.0, 0.0, 0.0),
                                                Eigen::Vector3d(0.5, std::sqrt(0.75), 0.0)};
  std::array<Pose, 4> solutions;
  EXPECT_EQ(solveP3p(bearing, point, solutions), 0);
}

TEST(SolveP3p, DegenerateInputGivesNoPose) {
  Random random = randomFor("SolveP3p.DegenerateInputGivesNoPose");
  const Triplet good = randomTriplet(random);
  std::array<Pose, 4> solutions;
  Triplet collinear = good;
  collinear.point_in_station_m[2] = 2.0 * good.point_in_station_m[1] - good.point_in_station_m[0];
  EXPECT_EQ(solveP3p(collinear.bearing, collinear.point_in_station_m, solutions), 0);
  Triplet repeated = good;
  repeated.point_in_station_m[1] = good.point_in_station_m[0];
  EXPECT_EQ(solveP3p(repeated.bearing, repeated.point_in_station_m, solutions), 0);
  for (const double bad :
       {std::numeric_limits<double>::quiet_NaN(), std::numeric_limits<double>::infinity(), 1e200}) {
    for (std::size_t i = 0; i < 3; ++i) {
      for (int axis = 0; axis < 3; ++axis) {
        Triplet broken = good;
        broken.point_in_station_m[i][axis] = bad;
        EXPECT_EQ(solveP3p(broken.bearing, broken.point_in_station_m, solutions), 0);
        broken = good;
        broken.bearing[i][axis] = bad;
        EXPECT_EQ(solveP3p(broken.bearing, broken.point_in_station_m, solutions), 0);
      }
    }
  }
}

TEST(SolveP3p, NeverGivesANonFinitePose) {
  Random random = randomFor("SolveP3p.NeverGivesANonFinitePose");
  for (int trial = 0; trial < 20000; ++trial) {
    // Small integers make coincidences, zeros and double roots common.
    std::array<Eigen::Vector3d, 3> bearing;
    std::array<Eigen::Vector3d, 3> point;
    for (std::size_t i = 0; i < 3; ++i) {
      for (int axis = 0; axis < 3; ++axis) {
        bearing[i][axis] = static_cast<double>(random.below(5)) - 2.0;
        point[i][axis] = static_cast<double>(random.below(5)) - 2.0;
      }
      if (bearing[i].norm() > 0.0) bearing[i].normalize();
    }
    std::array<Pose, 4> solutions;
    const int count = solveP3p(bearing, point, solutions);
    ASSERT_LE(count, 4);
    for (int i = 0; i < count; ++i) {
      ASSERT_TRUE(solutions[static_cast<std::size_t>(i)].isFinite());
    }
  }
}

}  // namespace
}  // namespace boresight::test
