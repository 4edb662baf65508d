// SPDX-License-Identifier: Apache-2.0
#include "sessions/evaluation/reseed.h"

#include <gtest/gtest.h>

#include "core/base/math.h"
#include "tests/support/random_pose.h"

namespace boresight::sessions {
namespace {

DeclaredUncertainty uncertainty(UncertaintyPivot pivot = UncertaintyPivot::kCamera) {
  return {{0.03, 0.02, 0.01}, {5.0, 2.0, 40.0}, pivot};
}

/// Squared radius within the ellipsoid: 1 on its surface.
double rotationRadius2(const Vector6d& offset, const DeclaredUncertainty& declared) {
  return offset.head<3>().cwiseQuotient(kDegree_rad * declared.rotation_deg).squaredNorm();
}
double translationRadius2(const Vector6d& offset, const DeclaredUncertainty& declared) {
  return offset.tail<3>().cwiseQuotient(declared.translation_m).squaredNorm();
}

TEST(DrawOffset, IsUniformInTheEllipsoids) {
  constexpr int kDraws = 20000;
  int inner_rotation = 0, inner_translation = 0, upper_z = 0;
  for (int i = 0; i < kDraws; ++i) {
    const Vector6d offset = drawOffset(uncertainty(), 1.0, "case", i);
    const double r2 = rotationRadius2(offset, uncertainty());
    const double t2 = translationRadius2(offset, uncertainty());
    ASSERT_LE(r2, 1.0 + 1e-12);
    ASSERT_LE(t2, 1.0 + 1e-12);
    inner_rotation += r2 < 0.25 ? 1 : 0;
    inner_translation += t2 < 0.25 ? 1 : 0;
    upper_z += offset[5] > 0.0 ? 1 : 0;
  }
  // A ball of half the radius holds an eighth of the volume; 5 sigma is 0.0117 there, 0.0177 for a
  // half.
  EXPECT_NEAR(inner_rotation / double{kDraws}, 0.125, 0.012);
  EXPECT_NEAR(inner_translation / double{kDraws}, 0.125, 0.012);
  EXPECT_NEAR(upper_z / double{kDraws}, 0.5, 0.018);
}

TEST(DrawOffset, DependsOnCaseAndNumberAloneAndScales) {
  EXPECT_EQ(drawOffset(uncertainty(), 1.0, "case", 1), drawOffset(uncertainty(), 1.0, "case", 1));
  EXPECT_NE(drawOffset(uncertainty(), 1.0, "case", 1), drawOffset(uncertainty(), 1.0, "case", 2));
  EXPECT_NE(drawOffset(uncertainty(), 1.0, "case", 1), drawOffset(uncertainty(), 1.0, "other", 1));
  const Vector6d once = drawOffset(uncertainty(), 1.0, "case", 3);
  EXPECT_LT((drawOffset(uncertainty(), 2.0, "case", 3) - 2.0 * once).norm(), 1e-15);
}

TEST(SeedForOffset, PutsTheTruthWhereTheUncertaintyMeansIt) {
  Random random = test::randomFor("PutsTheTruthWhereTheUncertaintyMeansIt");
  const Eigen::Vector3d centre_m(0.1, -0.05, 0.02);
  for (const UncertaintyPivot pivot : {UncertaintyPivot::kCamera, UncertaintyPivot::kStation}) {
    const DeclaredUncertainty declared = uncertainty(pivot);
    for (int i = 0; i < 100; ++i) {
      const Pose truth = test::randomCameraFromStation(random, 0.5);
      const Vector6d offset = drawOffset(declared, 1.0, "case", i);
      const Pose seed = seedForOffset(truth, offset, pivot, centre_m);
      const SeedUncertainty about = seedUncertainty(declared, seed, centre_m);
      const Vector6d measured = offsetAboutPivot(seed, truth, about.pivot_in_camera_m);
      EXPECT_LT((measured - offset).norm(), 1e-10);
    }
  }
}

}  // namespace
}  // namespace boresight::sessions
