// SPDX-License-Identifier: Apache-2.0
#include "sessions/trace/close_ups.h"

#include <gtest/gtest.h>

#include "core/refine/edge_refinement.h"
#include "tests/support/random_pose.h"

namespace boresight::sessions {
namespace {

constexpr double kSide_px = 30.0;

/// Over the plane z = 1: a point (x, y, 1) is seen at 100 px a unit from (200, 150).
Camera cameraOver() { return test::makePinhole(400, 300, 100.0); }

EdgeSample sampleAt(double x_px, double y_px, const Eigen::Vector2d& normal, double residual_px) {
  const Camera camera = cameraOver();
  EdgeSample sample;
  sample.point_in_station_m = {(x_px - camera.cx) / camera.fx, (y_px - camera.cy) / camera.fy, 1.0};
  sample.normal_x = static_cast<std::int8_t>(127.0 * normal.x());
  sample.normal_y = static_cast<std::int8_t>(127.0 * normal.y());
  sample.residual_px = residual_px;
  sample.gradient = -20.0;
  return sample;
}

/// The outline of a rectangle from (50, 40) to (350, 260), its lower right corner 0.7 px off.
RefinementTrace rectangle() {
  RefinementTrace refinement;
  const auto off = [](double x, double y) { return x > 320 && y > 230 ? -0.7 : 0.1; };
  for (double x = 50; x <= 350; x += 2)
    for (const double y : {40.0, 260.0})
      refinement.samples.push_back(sampleAt(x, y, {0.0, 1.0}, off(x, y)));
  for (double y = 40; y <= 260; y += 2)
    for (const double x : {50.0, 350.0})
      refinement.samples.push_back(sampleAt(x, y, {1.0, 0.0}, off(x, y)));
  return refinement;
}

TEST(CloseUps, ShowTheCornersAndHowFarTheirEdgesAreOff) {
  const auto close_ups = closeUps(cameraOver(), rectangle(), kSide_px);
  ASSERT_EQ(close_ups.size(), 4u);
  const Eigen::Vector2d corners[] = {{50, 40}, {350, 40}, {50, 260}, {350, 260}};
  for (std::size_t i = 0; i < 4; ++i) {
    EXPECT_LT((close_ups[i].center_px - corners[i]).norm(), 0.75 * kSide_px) << close_ups[i].name;
    EXPECT_EQ(close_ups[i].found_share, 1.0) << close_ups[i].name;
  }
  EXPECT_EQ(close_ups[0].name, "upper left");
  EXPECT_NEAR(close_ups[0].distance_px, 0.1, 1e-12);
  EXPECT_EQ(close_ups[3].name, "lower right");
  EXPECT_NEAR(close_ups[3].distance_px, 0.7, 1e-12);
}

TEST(CloseUps, LeaveOutWhatWasNotFoundAndStateTheFoundShareOfThePatch) {
  RefinementTrace refinement = rectangle();
  for (std::size_t i = 0; i < refinement.samples.size(); ++i)
    if (i / 2 % 4 != 0) refinement.samples[i].gradient = 0.0;
  const auto close_ups = closeUps(cameraOver(), refinement, kSide_px);
  ASSERT_EQ(close_ups.size(), 4u);
  for (const CloseUp& close_up : close_ups)
    EXPECT_NEAR(close_up.found_share, 0.25, 0.1) << close_up.name;
  for (EdgeSample& sample : refinement.samples) sample.gradient = 0.0;
  EXPECT_TRUE(closeUps(cameraOver(), refinement, kSide_px).empty());
  refinement.samples.front().gradient = 5.0;
  EXPECT_EQ(closeUps(cameraOver(), refinement, kSide_px).size(), 1u);
  EXPECT_TRUE(closeUps(cameraOver(), {}, kSide_px).empty());
}

}  // namespace
}  // namespace boresight::sessions
