// SPDX-License-Identifier: Apache-2.0
#include "core/pnp/epnp.h"

#include <algorithm>
#include <vector>

#include <gtest/gtest.h>

#include "core/base/symmetric_eigen.h"
#include "tests/support/not_finite.h"
#include "tests/support/random_pose.h"

namespace boresight {
namespace {

using test::randomFor;
using test::randomVector;

struct Seen {
  Pose camera_from_station;
  std::vector<Eigen::Vector3d> bearing;
  std::vector<Eigen::Vector3d> point_in_station_m;
};

/// Points of a box of 0.12 m in x and y and `thickness_m` in z, some 0.4 m before the camera.
Seen seenBox(Random& random, int count, double thickness_m) {
  Seen seen;
  seen.camera_from_station.rotation = rotationExp(randomVector(random, 1.0));
  seen.camera_from_station.translation_m = {0.02, -0.03, random.uniform(0.3, 0.5)};
  for (int i = 0; i < count; ++i) {
    const double x = random.uniform(-0.06, 0.06);
    const double y = random.uniform(-0.06, 0.06);
    const Eigen::Vector3d point(x, y, 0.5 * thickness_m * random.uniform(-1.0, 1.0));
    seen.point_in_station_m.push_back(point);
    seen.bearing.push_back((seen.camera_from_station * point).normalized());
  }
  return seen;
}

void expectTruth(const Seen& seen, double tolerance) {
  Pose found;
  ASSERT_TRUE(solveEpnp(seen.bearing, seen.point_in_station_m, found));
  EXPECT_THAT(found, test::poseNear(seen.camera_from_station, tolerance, tolerance));
}

TEST(SolveEpnp, FindsTheTruePoseOfExactPoints) {
  Random random = randomFor("SolveEpnp.FindsTheTruePoseOfExactPoints");
  for (const double thickness_m : {0.1, 0.004, 0.0}) {
    for (int trial = 0; trial < 200; ++trial) {
      SCOPED_TRACE(thickness_m);
      expectTruth(seenBox(random, 5 + trial % 30, thickness_m), 1e-5);
    }
  }
}

TEST(SolveEpnp, FourPointsOfAPlane_DetermineThePose) {
  Random random = randomFor("SolveEpnp.FourPointsOfAPlane");
  for (int trial = 0; trial < 200; ++trial) expectTruth(seenBox(random, 4, 0.0), 1e-4);
}

TEST(SolveEpnp, LengthsOfBearings_DoNotMatter) {
  Random random = randomFor("SolveEpnp.LengthsOfBearings");
  Seen seen = seenBox(random, 8, 0.1);
  for (Eigen::Vector3d& bearing : seen.bearing) bearing *= random.uniform(0.1, 10.0);
  expectTruth(seen, 1e-6);
}

TEST(SolveEpnp, DegenerateInput_IsRefused) {
  Random random = randomFor("SolveEpnp.DegenerateInput");
  const Seen good = seenBox(random, 6, 0.1);
  const auto solvesWith = [&good](auto change) {
    Seen seen = good;
    change(seen);
    Pose found;
    return solveEpnp(seen.bearing, seen.point_in_station_m, found);
  };
  ASSERT_TRUE(solvesWith([](Seen&) {}));
  EXPECT_FALSE(solvesWith([](Seen& few) {
    few.bearing.resize(3);
    few.point_in_station_m.resize(3);
  }));
  EXPECT_FALSE(solvesWith([](Seen& uneven) { uneven.bearing.pop_back(); }));
  EXPECT_FALSE(solvesWith([](Seen& line) {
    for (std::size_t i = 0; i < line.point_in_station_m.size(); ++i) {
      line.point_in_station_m[i] = Eigen::Vector3d(0.01, 0.02, 0.005) * static_cast<double>(i);
      line.bearing[i] = line.camera_from_station * line.point_in_station_m[i];
    }
  }));
  EXPECT_FALSE(solvesWith([](Seen& one_place) {
    std::ranges::fill(one_place.point_in_station_m, Eigen::Vector3d::Zero());
  }));
  EXPECT_FALSE(solvesWith([](Seen& behind) { behind.bearing[2] *= -1.0; }));
  for (const double bad : {test::kNan, test::kInfinity}) {
    EXPECT_FALSE(solvesWith([bad](Seen& broken) { broken.bearing[1].x() = bad; }));
    EXPECT_FALSE(solvesWith([bad](Seen& broken) { broken.point_in_station_m[1].y() = bad; }));
  }
}

TEST(SymmetricEigen, RandomMatrices_HaveTheEquationOfTheirEigenvectors) {
  Random random = randomFor("SymmetricEigen.RandomMatrices");
  constexpr int kSize = 12;
  using Matrix = Eigen::Matrix<double, kSize, kSize>;
  for (int trial = 0; trial < 100; ++trial) {
    Matrix root;
    for (int i = 0; i < kSize * kSize; ++i) root.data()[i] = random.uniform(-1.0, 1.0);
    if (trial % 3 == 0) root.leftCols<4>().setZero();  // singular
    const Matrix matrix = root * root.transpose();
    const SymmetricEigen<kSize> ours(matrix);
    EXPECT_TRUE(std::is_sorted(ours.values.begin(), ours.values.end()));
    EXPECT_LT((ours.vectors.transpose() * ours.vectors - Matrix::Identity()).norm(), 1e-12);
    EXPECT_LT((matrix * ours.vectors - ours.vectors * ours.values.asDiagonal()).norm(),
              1e-12 * matrix.norm());
  }
}

}  // namespace
}  // namespace boresight
