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

struct Outcome {
  bool converged = false;
  PoseError error;
  double evidence_nats = 0.0;
};

Outcome outcomeOf(const Case& scene, const LocalizerOptions& options) {
  OwnedRun run(scene.problem(), options);
  EXPECT_EQ(run.localizer.status(), Status::kOk);
  EXPECT_GT(run.finish(), 0);
  const Workspace& end = run.localizer.workspace();
  return {end.status == LocalizationStatus::kConverged,
          poseError(scene.solid, scene.truth, end.camera_from_station),
          end.evidence.strongest_nats()};
}

TEST(CameraPart, HidesTheSamePixelsFromEverySeed) {
  for (const std::uint64_t seed : {1U, 2U, 3U})
    for (const LocalizerOptions& options : {defaultProfile(), withoutSearch()}) {
      SCOPED_TRACE(seed);
      const Outcome outcome = outcomeOf(barCase(seed), options);
      EXPECT_TRUE(outcome.converged);
      EXPECT_LT(outcome.error.centre_m, 1e-4);
      EXPECT_LT(outcome.error.angle_rad, 1e-3);
    }
}

TEST(CameraPart, ExplainsWhyEdgesOfTheStationAreMissing) {
  const Case stated = barCase(2);
  Case unstated = stated;
  unstated.solid = stationMesh();
  Case mounted = stated;
  mounted.solid = mountedAt(stated.solid, stated.seed);
  const double with = outcomeOf(stated, defaultProfile()).evidence_nats;
  EXPECT_GT(with, outcomeOf(unstated, defaultProfile()).evidence_nats + 0.05);
  EXPECT_GT(with, outcomeOf(mounted, defaultProfile()).evidence_nats + 0.02);
}

TEST(CameraPart, IsPartOfTheDigest) {
  Case scene = barCase(1);
  const OwnedRun run(scene.problem(), defaultProfile());
  scene.solid.vertices.back().z() += 1e-6F;
  const OwnedRun moved(scene.problem(), defaultProfile());
  EXPECT_NE(run.localizer.digest(), moved.localizer.digest());
}

TEST(CameraPart, Matched_IsRefused) {
  Case scene = barCase(1);
  scene.solid.parts.back().match = true;
  EXPECT_EQ(OwnedRun(scene.problem(), defaultProfile()).localizer.status(), Status::kInvalidMesh);
}

}  // namespace
}  // namespace boresight::test
