// SPDX-License-Identifier: Apache-2.0
// Invalid input gives a status, never a crash.
#include <functional>
#include <limits>
#include <string>

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

struct Fault {
  std::string name;
  Status expected;
  std::function<void(Input&)> spoil;
};

void expectFault(const Fault& fault) {
  SCOPED_TRACE(fault.name);
  Input input;
  std::vector<std::byte> memory = blockFor(input.problem, input.options);
  fault.spoil(input);
  Localizer localizer(input.problem, input.options, memory);
  EXPECT_STREQ(statusText(localizer.status()), statusText(fault.expected));
  const StepReport report = localizer.step();
  EXPECT_TRUE(report.finished);
  EXPECT_FALSE(report.iteration_complete);  // there is none
  EXPECT_EQ(localizer.workspace().iteration, nullptr);
  EXPECT_EQ(localizer.workspace().iterations, 0);
  EXPECT_EQ(localizer.workspace().status, LocalizationStatus::kFault);
  EXPECT_STREQ(statusText(localizer.workspace().fault), statusText(fault.expected));
  EXPECT_TRUE(localizer.step().finished);
}

TEST(LocalizerFault, Options) {
  const Status expected = Status::kInvalidOption;
  expectFault({"nan", expected, [](Input& i) { i.options.loop.inlier_threshold_px = kNan; }});
  expectFault({"range", expected, [](Input& i) { i.options.pnp.max_samples = 0; }});
  expectFault({"enum", expected, [](Input& i) {
                 i.options.loop.correction_point = static_cast<CorrectionPoint>(7);
               }});
  expectFault({"end effector", expected, [](Input& i) {
                 i.options.loop.correction_point = CorrectionPoint::kEndEffector;
                 i.problem.end_effector_in_camera_m.setZero();
               }});
  std::size_t bytes = 0;
  LocalizerOptions options;
  options.templates.count = -1;
  EXPECT_EQ(requiredBytes({512, 512, 8, 12, 1}, options, bytes), expected);
}

TEST(LocalizerFault, Image) {
  const Status expected = Status::kInvalidImage;
  expectFault({"null", expected, [](Input& i) { i.problem.image.data = nullptr; }});
  expectFault({"width", expected, [](Input& i) { i.problem.image.width = 511; }});
  expectFault({"height", expected, [](Input& i) { i.problem.image.height = 513; }});
  expectFault({"stride", expected, [](Input& i) { i.problem.image.stride = 100; }});
  expectFault({"ignore", expected, [](Input& i) { i.problem.ignore = &i.small_mask.bits; }});
}

TEST(LocalizerFault, Camera) {
  const Status expected = Status::kInvalidCamera;
  expectFault({"not prepared", expected, [](Input& i) { i.problem.camera.valid_radius = 0.0; }});
  std::size_t bytes = 0;
  for (const int width : {0, -5}) {
    EXPECT_EQ(requiredBytes({width, 512, 8, 12, 1}, {}, bytes), expected);
    EXPECT_EQ(requiredBytes({512, width, 8, 12, 1}, {}, bytes), expected);
  }
}

TEST(LocalizerFault, Pose) {
  const Status expected = Status::kInvalidPose;
  expectFault({"translation", expected,
               [](Input& i) { i.problem.camera_from_station_seed.translation_m.y() = kNan; }});
  expectFault({"rotation", expected,
               [](Input& i) { i.problem.camera_from_station_seed.rotation.w() = kInfinity; }});
  expectFault({"length", expected,
               [](Input& i) { i.problem.camera_from_station_seed.rotation.coeffs() *= 2.0; }});
  expectFault({"uncertainty", expected,
               [](Input& i) { i.problem.uncertainty.rotation_rad.z() = kInfinity; }});
  expectFault(
      {"negative", expected, [](Input& i) { i.problem.uncertainty.translation_m.x() = -0.01; }});
  expectFault(
      {"end effector", expected, [](Input& i) { i.problem.end_effector_in_camera_m.x() = kNan; }});
  expectFault(
      {"pivot", expected, [](Input& i) { i.problem.uncertainty.pivot_in_camera_m.x() = kNan; }});
}

TEST(LocalizerFault, Mesh) {
  const Status expected = Status::kInvalidMesh;
  expectFault({"no faces", expected, [](Input& i) { i.problem.mesh.faces = {}; }});
  expectFault({"no parts", expected, [](Input& i) { i.problem.mesh.parts = {}; }});
  expectFault({"parts of faces", expected, [](Input& i) {
                 i.problem.mesh.part_of_face = i.problem.mesh.part_of_face.first(3);
               }});
  expectFault({"index", expected, [](Input& i) { i.scene.solid.faces[3].vertex[1] = 100000; }});
  expectFault({"vertex", expected, [](Input& i) {
                 i.scene.solid.vertices[5].x() = std::numeric_limits<float>::quiet_NaN();
               }});
  expectFault({"part", expected, [](Input& i) { i.scene.solid.part_of_face[7] = 9; }});
}

TEST(LocalizerFault, TooManyEdgePixels) {
  const Case scene = stationCase(1);
  LocalizerOptions options;
  options.render.max_edge_pixels = 1000;
  OwnedRun run(scene.problem(), options);
  EXPECT_EQ(run.localizer.status(), Status::kOk);
  run.finish();
  const Workspace& workspace = run.localizer.workspace();
  EXPECT_EQ(workspace.status, LocalizationStatus::kFault);
  EXPECT_EQ(workspace.fault, Status::kCapacityExceeded);
  EXPECT_EQ(workspace.attempts, 1);  // would fail again
  EXPECT_EQ(workspace.iterations, 1);
  EXPECT_EQ(workspace.camera_from_station.translation_m, scene.seed.translation_m);
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
  OwnedRun undisturbed(scene.problem(), defaultProfile());
  undisturbed.finish();
  EXPECT_EQ(run.localizer.digest(), undisturbed.localizer.digest());
}

}  // namespace
}  // namespace boresight::test
