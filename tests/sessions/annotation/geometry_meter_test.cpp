// SPDX-License-Identifier: Apache-2.0
#include "sessions/annotation/geometry_meter.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <string>
#include <tuple>
#include <utility>
#include <vector>

#include "tests/sessions/annotation/annotated_scene.h"
#include "tests/support/box_mesh.h"

namespace boresight::sessions {
namespace {

using test::AnnotatedScene;

AnnotatedScene sceneOf(const std::vector<Eigen::Vector3d>& places_m) {
  Random random(1);
  AnnotatedScene scene = test::randomScene(random, CameraModel::kPinhole, 0, 0, 0.0);
  scene.camera_from_station = {Eigen::Quaterniond::Identity(), {0.0, 0.0, 0.5}};
  for (const Eigen::Vector3d& place_m : places_m)
    EXPECT_TRUE(test::addPoint(scene.view, scene.camera_from_station, place_m, 0.0, 1.0, random));
  return scene;
}

bool warnsOf(const AnnotatedScene& scene, GeometryWeakness weakness, bool prevents = false,
             const Pose* guess = nullptr, const std::vector<Eigen::Vector3d>& station = {}) {
  const auto warnings = geometryWarnings(scene.views(), guess, station);
  return std::any_of(warnings.begin(), warnings.end(), [&](const GeometryWarning& warning) {
    return warning.weakness == weakness && warning.prevents == prevents && !warning.text.empty();
  });
}

TEST(GeometryMeter, SaysHowManyPairsAreMissing) {
  const std::vector<Eigen::Vector3d> places = {{0, 0, 0}, {0.1, 0, 0}};
  for (const auto& [count, text] : {std::pair{0, "too few annotations: add 3 more pairs"},
                                    {1, "too few annotations: add 2 more pairs"},
                                    {2, "too few annotations: add 1 more pair"}}) {
    const AnnotatedScene scene = sceneOf({places.begin(), places.begin() + count});
    const auto warnings = geometryWarnings(scene.views(), &scene.camera_from_station, {});
    ASSERT_EQ(warnings.size(), 1u);
    EXPECT_TRUE(warnings[0].prevents);
    EXPECT_EQ(warnings[0].text, text);
  }
}

TEST(GeometryMeter, KnowsTooFewPointsLinesAndPlanes) {
  const AnnotatedScene three = sceneOf({{0, 0, 0}, {0.1, 0, 0}, {0, 0.1, 0.05}});
  EXPECT_TRUE(warnsOf(three, GeometryWeakness::kTooFew, true));
  EXPECT_TRUE(warnsOf(three, GeometryWeakness::kFew, false, &three.camera_from_station));
  std::vector<Eigen::Vector3d> line, plane;
  for (int i = 0; i < 6; ++i) {
    line.emplace_back(0.02 * i, 0.01 * i, 0.03 * i);
    plane.emplace_back(0.02 * i, 0.01 * (i * i % 5), 0.01 * i);  // z = x / 2
  }
  EXPECT_TRUE(warnsOf(sceneOf(line), GeometryWeakness::kCollinear, true));
  EXPECT_TRUE(warnsOf(sceneOf(plane), GeometryWeakness::kCoplanar));
  Random random = test::randomFor("GeometryMeter.Content");
  const AnnotatedScene scene = test::randomScene(random, CameraModel::kPinhole, 20, 0, 0.0);
  EXPECT_TRUE(geometryWarnings(scene.views(), &scene.camera_from_station, {}).empty());
}

/// The middle and the deviations of the corners of a box that is turned about z by 3-4-5, and of
/// its diagonals as lines: both ends count.
TEST(GeometryMeter, SpreadOfABox_IsThatOfItsHalfSides) {
  const Eigen::Vector3d middle_m(0.02, -0.01, 0.03);
  const Eigen::Vector3d half_m(0.03, 0.08, 0.05);
  std::vector<Eigen::Vector3d> corners;
  for (int i = 0; i < 8; ++i) {
    const Eigen::Vector3d corner = test::boxCorner(half_m, i);
    corners.push_back(middle_m + Eigen::Vector3d(0.6 * corner.x() - 0.8 * corner.y(),
                                                 0.8 * corner.x() + 0.6 * corner.y(), corner.z()));
  }
  AnnotatedScene lines = sceneOf({});
  Random random(2);
  for (std::size_t i = 0; i < 4; ++i)
    ASSERT_TRUE(test::addLine(lines.view, lines.camera_from_station, corners[i], corners[7 - i],
                              0.0, 1.0, random));
  for (const AnnotatedScene& scene : {sceneOf(corners), lines}) {
    const AnnotatedSpread spread = annotatedSpread(scene.views());
    EXPECT_EQ(spread.places, 8);
    EXPECT_LT((spread.middle_in_station_m - middle_m).norm(), 1e-12);
    EXPECT_LT((spread.deviation_m - Eigen::Vector3d(0.08, 0.05, 0.03)).norm(), 1e-9);
    EXPECT_NEAR(std::abs(spread.axes_in_station.col(0).dot(Eigen::Vector3d(-0.8, 0.6, 0))), 1,
                1e-9);
    EXPECT_NEAR(std::abs(spread.axes_in_station.col(1).z()), 1.0, 1e-9);
  }
}

/// Two depths that differ by `share` of their mean.
TEST(GeometryMeter, OneDepth_IsWithinTwoPercent) {
  for (const auto& [share, warns] : {std::pair{0.0195, true}, {0.0205, false}}) {
    const double half_m = 0.5 * share * 0.5;
    const AnnotatedScene scene = sceneOf(
        {{-0.1, -0.1, half_m}, {0.1, -0.1, -half_m}, {0.1, 0.1, half_m}, {-0.1, 0.1, -half_m}});
    EXPECT_EQ(warnsOf(scene, GeometryWeakness::kOneDepth, false, &scene.camera_from_station),
              warns);
  }
}

TEST(GeometryMeter, Clustered_IsBelowAQuarterOfTheStationEitherWay) {
  const std::vector<Eigen::Vector3d> station = {{-0.1, -0.1, 0}, {0.1, 0.1, 0}};
  for (const auto& [x, y, warns] : {std::tuple{0.024, 0.1, true},
                                    {0.1, 0.024, true},
                                    {0.026, 0.1, false},
                                    {0.1, 0.026, false}}) {
    const AnnotatedScene scene = sceneOf({{-x, -y, 0}, {x, -y, 0}, {x, y, 0}, {-x, y, 0}});
    EXPECT_EQ(
        warnsOf(scene, GeometryWeakness::kClustered, false, &scene.camera_from_station, station),
        warns)
        << x << ' ' << y;
  }
}

TEST(GeometryMeter, Count_IncludesOnlyEnabledCompletePairs) {
  AnnotatedScene scene = sceneOf({{0, 0, 0}, {0.1, 0, 0}, {0, 0.1, 0.05}, {0.1, 0.1, 0.02}});
  scene.view.annotations.points[0].enabled = false;
  scene.view.annotations.points[1].pixel.reset();
  EXPECT_EQ(annotatedSpread(scene.views()).places, 2);
  EXPECT_EQ(usedAnnotations(scene.views()).size(), 2u);
}

}  // namespace
}  // namespace boresight::sessions
