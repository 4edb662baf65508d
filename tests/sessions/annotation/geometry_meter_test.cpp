// SPDX-License-Identifier: Apache-2.0
#include "sessions/annotation/geometry_meter.h"

#include <gtest/gtest.h>

#include <algorithm>

#include "tests/sessions/annotation/annotated_scene.h"

namespace boresight::sessions {
namespace {

using test::addPoint;
using test::AnnotatedScene;
using test::randomFor;
using test::randomScene;

AnnotatedScene sceneOf(const std::vector<Eigen::Vector3d>& places_m) {
  Random random(1);
  AnnotatedScene scene = randomScene(random, CameraModel::kPinhole, 0, 0, 0.0);
  scene.camera_from_station.rotation = Eigen::Quaterniond::Identity();
  scene.camera_from_station.translation_m = {0.0, 0.0, 0.5};
  for (const Eigen::Vector3d& place_m : places_m)
    EXPECT_TRUE(addPoint(scene.view, scene.camera_from_station, place_m, 0.0, 1.0, random));
  return scene;
}

bool warnsOf(const std::vector<GeometryWarning>& warnings, GeometryWeakness weakness,
             bool prevents) {
  return std::any_of(warnings.begin(), warnings.end(), [&](const GeometryWarning& warning) {
    return warning.weakness == weakness && warning.prevents == prevents && !warning.text.empty();
  });
}

TEST(GeometryMeter, SaysHowManyPairsAreMissing) {
  const AnnotatedScene two = sceneOf({{0, 0, 0}, {0.1, 0, 0}});
  const Pose guess = two.camera_from_station;
  const auto warnings = geometryWarnings(two.views(), &guess, {});
  ASSERT_EQ(warnings.size(), 1u);
  EXPECT_TRUE(warnings[0].prevents);
  EXPECT_NE(warnings[0].text.find("1 more pair"), std::string::npos) << warnings[0].text;
}

TEST(GeometryMeter, ThreePointsNeedAGuessAndLeaveNothingToCheck) {
  const AnnotatedScene three = sceneOf({{0, 0, 0}, {0.1, 0, 0}, {0, 0.1, 0.05}});
  EXPECT_TRUE(
      warnsOf(geometryWarnings(three.views(), nullptr, {}), GeometryWeakness::kTooFew, true));
  EXPECT_TRUE(warnsOf(geometryWarnings(three.views(), &three.camera_from_station, {}),
                      GeometryWeakness::kFew, false));
}

TEST(GeometryMeter, KnowsLinesAndPlanes) {
  std::vector<Eigen::Vector3d> line;
  std::vector<Eigen::Vector3d> plane;
  for (int i = 0; i < 6; ++i) {
    line.emplace_back(0.02 * i, 0.01 * i, 0.03 * i);
    plane.emplace_back(0.02 * i, 0.01 * (i * i % 5), 0.01 * i);  // z = x / 2
  }
  EXPECT_TRUE(warnsOf(geometryWarnings(sceneOf(line).views(), nullptr, {}),
                      GeometryWeakness::kCollinear, true));
  EXPECT_TRUE(warnsOf(geometryWarnings(sceneOf(plane).views(), nullptr, {}),
                      GeometryWeakness::kCoplanar, false));
}

TEST(GeometryMeter, OneDepthOrOneCorner_IsReported) {
  const std::vector<Eigen::Vector3d> station = {{-0.1, -0.1, -0.1}, {0.1, 0.1, 0.1}};
  const AnnotatedScene flat =
      sceneOf({{-0.1, -0.1, 0}, {0.1, -0.1, 0}, {0.1, 0.1, 0}, {-0.1, 0.1, 0.001}});
  const auto of_flat = geometryWarnings(flat.views(), &flat.camera_from_station, station);
  EXPECT_TRUE(warnsOf(of_flat, GeometryWeakness::kOneDepth, false));
  EXPECT_FALSE(warnsOf(of_flat, GeometryWeakness::kClustered, false));
  const AnnotatedScene clustered =
      sceneOf({{0, 0, 0}, {0.02, 0, 0.01}, {0, 0.02, -0.01}, {0.02, 0.02, 0.02}});
  EXPECT_TRUE(warnsOf(geometryWarnings(clustered.views(), &clustered.camera_from_station, station),
                      GeometryWeakness::kClustered, false));
}

TEST(GeometryMeter, SpreadAnnotations_GiveNoWarning) {
  Random random = randomFor("GeometryMeter.Content");
  const AnnotatedScene scene = randomScene(random, CameraModel::kPinhole, 20, 0, 0.0);
  EXPECT_TRUE(geometryWarnings(scene.views(), &scene.camera_from_station, {}).empty());
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
