// SPDX-License-Identifier: Apache-2.0
// Invalid input gives a status, never a crash.
#include <algorithm>
#include <functional>
#include <utility>
#include <vector>

#include <gtest/gtest.h>

#include "core/localizer/localizer.h"
#include "tests/core/localizer/scene.h"
#include "tests/support/not_finite.h"

namespace boresight::test {
namespace {

struct Input {
  Case scene = stationCase(1);
  LocalizerOptions options = defaultProfile();
  LocalizationProblem problem = scene.problem();
  Mask small_mask{511, 512};
};

TEST(LocalizerFault, InvalidInput_EndsTheRunBeforeTheFirstIteration) {
  const std::pair<Status, std::vector<std::function<void(Input&)>>> faults[] = {
      {Status::kInvalidOption,
       {[](Input& i) { i.options.loop.inlier_threshold_px = kNan; },
        [](Input& i) { i.options.pnp.max_samples = 0; },
        [](Input& i) { i.options.loop.correction_point = static_cast<CorrectionPoint>(7); },
        [](Input& i) {
          i.options.loop.correction_point = CorrectionPoint::kEndEffector;
          i.problem.end_effector_in_camera_m.setZero();
        }}},
      {Status::kInvalidImage,
       {[](Input& i) { i.problem.image.data = nullptr; },
        [](Input& i) { i.problem.image.width = 511; },
        [](Input& i) { i.problem.image.height = 513; },
        [](Input& i) { i.problem.image.stride = 100; },
        [](Input& i) { i.problem.ignore = &i.small_mask.bits; }}},
      {Status::kInvalidCamera, {[](Input& i) { i.problem.camera.valid_radius = 0.0; }}},
      {Status::kInvalidPose,
       {[](Input& i) { i.problem.camera_from_station_seed.translation_m.y() = kNan; },
        [](Input& i) { i.problem.camera_from_station_seed.rotation.w() = kInfinity; },
        [](Input& i) { i.problem.camera_from_station_seed.rotation.coeffs() *= 2.0; },
        [](Input& i) { i.problem.uncertainty.rotation_rad.z() = kInfinity; },
        [](Input& i) { i.problem.uncertainty.translation_m.x() = -0.01; },
        [](Input& i) { i.problem.end_effector_in_camera_m.x() = kNan; },
        [](Input& i) { i.problem.uncertainty.pivot_in_camera_m.x() = kNan; }}},
      {Status::kInvalidMesh,
       {[](Input& i) { i.problem.mesh.faces = {}; }, [](Input& i) { i.problem.mesh.parts = {}; },
        [](Input& i) { i.problem.mesh.part_of_face = i.problem.mesh.part_of_face.first(3); },
        [](Input& i) { i.scene.solid.faces[3].vertex[1] = 100000; },
        [](Input& i) { i.scene.solid.vertices[5].x() = static_cast<float>(kNan); },
        [](Input& i) { i.scene.solid.part_of_face[7] = 9; }}},
  };
  for (const auto& [expected, changes] : faults)
    for (std::size_t i = 0; i < changes.size(); ++i) {
      SCOPED_TRACE(testing::Message() << statusText(expected) << ", change " << i);
      Input input;
      std::vector<std::byte> memory = blockFor(input.problem, input.options);
      changes[i](input);
      Localizer localizer(input.problem, input.options, memory);
      EXPECT_STREQ(statusText(localizer.status()), statusText(expected));
      const StepReport report = localizer.step();
      EXPECT_TRUE(report.finished);
      EXPECT_FALSE(report.iteration_complete);  // there is none
      EXPECT_EQ(localizer.workspace().iteration, nullptr);
      EXPECT_EQ(localizer.workspace().iterations, 0);
      EXPECT_EQ(localizer.workspace().status, LocalizationStatus::kFault);
      EXPECT_STREQ(statusText(localizer.workspace().fault), statusText(expected));
      EXPECT_TRUE(localizer.step().finished);
    }
}

TEST(LocalizerFault, RequiredBytesOfInvalidSizesAndOptions_AreRefused) {
  LocalizerOptions options;
  std::size_t bytes = 0;
  for (const int size : {0, -5}) {
    EXPECT_EQ(requiredBytes({size, 512, 8, 12, 1}, options, bytes), Status::kInvalidCamera);
    EXPECT_EQ(requiredBytes({512, size, 8, 12, 1}, options, bytes), Status::kInvalidCamera);
  }
  options.templates.count = -1;
  EXPECT_EQ(requiredBytes({512, 512, 8, 12, 1}, options, bytes), Status::kInvalidOption);
}

/// With several workers during a shared render whose tasks are all left to step().
TEST(LocalizerFault, TooManyEdgePixels) {
  LocalizerOptions options = defaultProfile();
  options.render.max_edge_pixels = 1000;
  for (const std::uint64_t seed : {1U, 4U}) {
    const Case scene = stationCase(seed);
    const Digest plain = digestOf(scene.problem(), options);
    for (const int workers : {1, 2, 3}) {
      OwnedRun run(scene.problem(), options, workers);
      run.finish();
      EXPECT_EQ(run.workspace.status, LocalizationStatus::kFault);
      EXPECT_EQ(run.workspace.fault, Status::kCapacityExceeded);
      EXPECT_GT(run.workspace.attempts, 1) << "other hypotheses are tried";
      EXPECT_EQ(run.workspace.camera_from_station, scene.seed);
      EXPECT_EQ(run.localizer.digest(), plain);
    }
  }
}

TEST(LocalizerFault, RestartWithBadInputKeepsTheRun) {
  const Case scene = stationCase(1);
  OwnedRun run(scene.problem(), defaultProfile());
  for (int i = 0; i < 50; ++i) run.localizer.step();
  LocalizationProblem problem = scene.problem();
  problem.camera_from_station_seed.translation_m.x() = kNan;
  EXPECT_EQ(run.localizer.restart(problem, defaultProfile()), Status::kInvalidPose);
  LocalizerOptions options;
  options.loop.leave_factor = 0.0;
  EXPECT_EQ(run.localizer.restart(scene.problem(), options), Status::kInvalidOption);
  options = defaultProfile();
  options.templates.count = 1000;
  EXPECT_EQ(run.localizer.restart(scene.problem(), options), Status::kArenaTooSmall);
  run.finish();
  EXPECT_EQ(run.localizer.digest(), digestOf(scene.problem(), defaultProfile()));
}

}  // namespace
}  // namespace boresight::test
