// SPDX-License-Identifier: Apache-2.0
// A bar that is fixed to the camera and hides a part of the station.
#include <gtest/gtest.h>

#include <algorithm>

#include "core/localizer/localizer.h"
#include "tests/core/localizer/scene.h"

namespace boresight::test {
namespace {

/// From the lower border of the image over the station, 0.2 m ahead of the camera.
void addBar(Solid& solid) {
  solid.parts.push_back(ScenePart());
  solid.parts.back().match = false;
  solid.parts.back().fixed_to_camera = true;
  solid.addBox(0.004, 0.035, 0.013, 0.045, 0.1, 0.19, 0.20, 0.7,
               static_cast<int>(solid.parts.size()) - 1);
}

/// The bar's vertices moved into the station frame of a pose by hand, as if it were mounted there.
Solid mountedAt(Solid solid, const Pose& camera_from_station) {
  const std::size_t first = firstVertexInCamera(solid.view());
  for (std::size_t i = first; i < solid.vertices.size(); ++i)
    solid.vertices[i] =
        (camera_from_station.inverse() * solid.vertices[i].cast<double>().eval()).cast<float>();
  solid.parts.back().fixed_to_camera = false;
  return solid;
}

/// The station with the bar in its picture, which no code of camera parts has drawn.
Case barCase(std::uint64_t seed) {
  static const Picture picture = [] {
    Solid solid = stationMesh();
    addBar(solid);
    return takePictureByRays(mountedAt(solid, truthPose()), pinholeCamera(), truthPose());
  }();
  Case scene = stationCase(seed);
  scene.picture = &picture;
  addBar(scene.solid);
  return scene;
}

TEST(CameraPart, HidesTheSamePixelsFromEverySeed) {
  for (const std::uint64_t seed : {1U, 2U, 3U})
    for (const LocalizerOptions& options : {defaultProfile(), withoutSearch()}) {
      SCOPED_TRACE(seed);
      const Case scene = barCase(seed);
      expectTruth(scene, FinishedRun(scene, options).workspace, 1e-4, 1e-3);
    }
}

TEST(CameraPart, ExplainsWhyEdgesOfTheStationAreMissing) {
  const auto evidenceOf = [](const Case& scene) {
    return FinishedRun(scene).workspace.evidence.strongest_nats();
  };
  const Case stated = barCase(2);
  Case unstated = stated;
  unstated.solid = stationMesh();
  Case mounted = stated;
  mounted.solid = mountedAt(stated.solid, stated.seed);
  const double with_nats = evidenceOf(stated);
  EXPECT_GT(with_nats, evidenceOf(unstated) + 0.05);
  EXPECT_GT(with_nats, evidenceOf(mounted) + 0.02);
}

TEST(CameraPart, IsPartOfTheDigestAndRefusedIfMatched) {
  Case scene = barCase(1);
  const OwnedRun run(scene.problem(), defaultProfile());
  scene.solid.vertices.back().z() += 1e-6F;
  const OwnedRun moved(scene.problem(), defaultProfile());
  EXPECT_NE(run.localizer.digest(), moved.localizer.digest());
  scene.solid.parts.back().match = true;
  EXPECT_EQ(OwnedRun(scene.problem(), defaultProfile()).localizer.status(), Status::kInvalidMesh);
}

}  // namespace
}  // namespace boresight::test
