// SPDX-License-Identifier: Apache-2.0
// The digest depends on the inputs of a run and on nothing else.
#include <algorithm>
#include <functional>
#include <iostream>
#include <set>
#include <string>
#include <vector>

#include <gtest/gtest.h>

#include "core/base/digest.h"
#include "core/localizer/localizer.h"
#include "tests/core/localizer/rail_scene.h"

namespace boresight::test {
namespace {

TEST(LocalizerDigest, DoesNotDependOnTheKernels) {
  const Case scene = stationCase(4);
  const LocalizerOptions options = defaultProfile();
  const Digest expected = digestOf(scene.problem(), options);
  for (int k = 1; k < kKernelSets; ++k) {
    const Kernels kernels = static_cast<Kernels>(k);
    if (kernelsAvailable(kernels)) {
      EXPECT_EQ(sharedDigest(scene.problem(), options, 1, kernels), expected)
          << kernelsName(kernels);
    } else {
      std::size_t bytes = 0;
      EXPECT_EQ(requiredBytes(sizeOf(scene.problem()), options, 1, bytes, kernels),
                Status::kInvalidOption);
      std::cout << "not available here: " << kernelsName(kernels) << "\n";
    }
  }
}

TEST(LocalizerDigest, DoesNotDependOnTheImagesPadding) {
  const Case scene = stationCase(4);
  LocalizationProblem problem = scene.problem();
  std::vector<std::uint8_t> padded(512 * 600, 0x5A);
  for (int y = 0; y < 512; ++y) std::copy_n(problem.image.row(y), 512, padded.begin() + y * 600);
  const Digest expected = digestOf(problem, defaultProfile());
  problem.image.data = padded.data();
  problem.image.stride = 600;
  EXPECT_EQ(digestOf(problem, defaultProfile()), expected);
}

TEST(LocalizerDigest, ReadAccess_ChangesNothing) {
  const Case scene = stationCase(4);
  OwnedRun run(scene.problem(), withoutSearch());
  std::set<Digest> digests;
  run.finish([&](const StepReport& report) {
    const Digest current = run.localizer.digest();
    EXPECT_EQ(run.localizer.digest(), current);
    if (report.stage_complete) digests.insert(current);
  });
  EXPECT_GT(digests.size(), 10u);
  EXPECT_EQ(run.localizer.digest(), digestOf(scene.problem(), withoutSearch()));
}

/// Every change of an input; each must change the digest.
TEST(LocalizerDigest, ChangesWithEveryInput) {
  struct Inputs {
    Case scene = stationCase(4);
    Picture picture = *scene.picture;
    Mask mask{512, 512};
    LocalizerOptions options;
  };
  const std::function<void(Inputs&)> changes[] = {
      [](Inputs&) {},
      [](Inputs& i) { i.picture.gray[512 * 511 + 511] ^= 1; },
      [](Inputs& i) { i.scene.ignore = &i.mask.bits; },
      [](Inputs& i) {
        i.mask.bits.set(511, 0);
        i.scene.ignore = &i.mask.bits;
      },
      [](Inputs& i) { i.scene.seed.translation_m.x() += 1e-12; },
      [](Inputs& i) { i.scene.seed.rotation.x() += 1e-15; },
      [](Inputs& i) { i.scene.uncertainty.rotation_rad.y() *= 1.0000001; },
      [](Inputs& i) { i.scene.uncertainty.translation_m.z() *= 1.0000001; },
      [](Inputs& i) { i.scene.uncertainty.pivot_in_camera_m.z() *= 1.0000001; },
      [](Inputs& i) { i.scene.camera.cx += 1e-9; },
      [](Inputs& i) { i.scene.camera.model = CameraModel::kBrownConrady; },
      [](Inputs& i) { i.scene.solid.vertices[0].z() += 1e-7F; },
      [](Inputs& i) { i.scene.solid.parts[0].depth_threshold_m *= 1.01; },
      [](Inputs& i) { i.scene.solid.parts[0].normal_threshold_rad *= 1.01; },
      [](Inputs& i) { i.scene.solid.parts.push_back(ScenePart()); },
      [](Inputs& i) {
        i.scene.solid.parts.push_back(ScenePart());
        i.scene.solid.parts[1].match = false;
      },
      [](Inputs& i) {
        i.scene.solid.parts.push_back(ScenePart());
        i.scene.solid.parts[1].match = false;
        i.scene.solid.parts[1].fixed_to_camera = true;
      },
      [](Inputs& i) { std::swap(i.scene.solid.faces[0], i.scene.solid.faces[1]); },
      [](Inputs& i) { i.options.pnp.seed = 2; },
      [](Inputs& i) { i.options.loop.max_iterations = 11; },
      [](Inputs& i) { i.options.loop.correction_point = CorrectionPoint::kEndEffector; },
      [](Inputs& i) {
        i.options.loop.correction_point = CorrectionPoint::kEndEffector;
        i.scene.end_effector_in_camera_m.z() += 1e-12;
      },
  };
  std::vector<Digest> seen;
  for (const auto& change : changes) {
    Inputs inputs;
    change(inputs);
    inputs.scene.picture = &inputs.picture;
    ASSERT_EQ(prepareCamera(inputs.scene.camera), Status::kOk);
    // Before the first step: the inputs alone.
    const OwnedRun run(inputs.scene.problem(), inputs.options);
    ASSERT_EQ(run.localizer.status(), Status::kOk);
    for (std::size_t i = 0; i < seen.size(); ++i)
      EXPECT_NE(run.localizer.digest(), seen[i]) << seen.size() << " and " << i;
    seen.push_back(run.localizer.digest());
  }
}

TEST(LocalizerDigest, RestartAfterTheEnd_GivesTheDigestOfANewRun) {
  const Case scene = stationCase(4);
  const Case other = stationCase(5);
  LocalizerOptions first = withoutSearch();
  first.support.min_support = 0.99;  // so that the first run makes three attempts
  OwnedRun run(other.problem(), first);
  run.finish();
  ASSERT_EQ(run.workspace.attempts, 3);
  LocalizationProblem problem = other.problem();
  problem.camera_from_station_seed = scene.seed;
  ASSERT_EQ(run.localizer.restart(problem, withoutSearch()), Status::kOk);
  EXPECT_EQ(run.workspace.status, LocalizationStatus::kRunning);
  OwnedRun fresh(problem, withoutSearch());
  fresh.finish(
      [&](const StepReport& report) { EXPECT_EQ(run.localizer.step().finished, report.finished); });
  EXPECT_EQ(run.localizer.digest(), fresh.localizer.digest());
  EXPECT_EQ(run.workspace.attempts, fresh.workspace.attempts);
  EXPECT_EQ(run.workspace.iterations, fresh.workspace.iterations);

  const Picture noise = noisePicture(512, 512, 1);
  problem = scene.problem();
  problem.image = noise.view();
  problem.uncertainty.translation_m *= 0.5;
  OwnedRun of_noise(problem, defaultProfile());
  of_noise.finish();
  ASSERT_EQ(of_noise.localizer.restart(scene.problem(), defaultProfile()), Status::kOk);
  of_noise.finish();
  EXPECT_EQ(of_noise.localizer.digest(), digestOf(scene.problem(), defaultProfile()))
      << "after another image";
}

TEST(LocalizerDigest, RestartInTheMiddle_GivesTheDigestOfANewRun) {
  const Case scene = stationCase(4);
  // Options that need all the memory, then options that need less, and back.
  std::vector<std::byte> memory(std::max(blockFor(scene.problem(), paperProfile()).size(),
                                         blockFor(scene.problem(), defaultProfile()).size()));
  Localizer localizer(scene.problem(), paperProfile(), memory);
  for (const int steps : {1, 7, 100, 333}) {
    for (const LocalizerOptions& next : {defaultProfile(), paperProfile()}) {
      for (int i = 0; i < steps; ++i) localizer.step();
      ASSERT_EQ(localizer.restart(scene.problem(), next), Status::kOk);
    }
  }
  while (!localizer.step().finished) {
  }
  EXPECT_EQ(localizer.digest(), digestOf(scene.problem(), paperProfile()));
}

/// The beginning of a run's digest.
std::string runDigest(const Case& scene, const LocalizerOptions& options = {}) {
  return std::string(hexText(digestOf(scene.problem(), options)).data()).substr(0, 16);
}

/// Every machine, compiler and optimization level must give these bits: a digest that changes
/// means that localizations recorded before can no longer be reproduced.
TEST(SameBits, OfLocalizations) {
  EXPECT_EQ(runDigest(stationCase(4, true)), "6d142f83962981ee");
  EXPECT_EQ(runDigest(stationCase(1), withoutSearch()), "9137fc705fca8f69");
  EXPECT_EQ(runDigest(railCase(Ends::kOutside, 0.0, 1.7, 3)), "cd5b41fc26a957c9");

  Case masked = occludedCase(4);
  Mask mask(512, 512);
  mask.fill(150, 100, 300, 220);
  masked.ignore = &mask.bits;
  masked.uncertainty.rotation_rad.z() = 0.6;  // several rolled renders
  EXPECT_EQ(runDigest(masked, paperProfile()), "d79e2092ff16d916");

  Case turned = stationCase(2);
  turned.uncertainty.rotation_rad.z() = kPi;
  turned.seed.rotation = rotationExp({0.0, 0.0, 2.0}) * turned.seed.rotation;
  EXPECT_EQ(runDigest(turned), "de0228a16cbb6a48");

  Case other = stationCase(3);
  other.solid = railMesh(5, true);
  EXPECT_EQ(runDigest(other), "a8c0bc3278d1a577");
}

}  // namespace
}  // namespace boresight::test
