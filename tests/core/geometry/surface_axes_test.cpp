// SPDX-License-Identifier: Apache-2.0
#include "core/geometry/surface_axes.h"

#include <cmath>

#include <gtest/gtest.h>

#include "tests/core/localizer/scene.h"

namespace boresight::test {
namespace {

TEST(SurfaceAxes, Box_HasItsOwnAxesInAscendingOrder) {
  Solid solid;
  solid.addBox(0.01, -0.02, 0.06, 0.03, 0.4, 0.1, 0.12, 0.5);
  const SurfaceAxes surface = surfaceAxesOf(solid.view());
  EXPECT_LT((surface.middle_m - Eigen::Vector3d(0.01, -0.02, 0.11)).norm(), 1e-6);
  const Eigen::Vector3d longest(cos(0.4), sin(0.4), 0.0);
  EXPECT_NEAR(std::abs(surface.axes.col(0).z()), 1.0, 1e-5);
  EXPECT_NEAR(std::abs(surface.axes.col(2).dot(longest)), 1.0, 1e-5);
  EXPECT_LT((surface.axes.transpose() * surface.axes - Eigen::Matrix3d::Identity()).norm(), 1e-12);
}

}  // namespace
}  // namespace boresight::test
