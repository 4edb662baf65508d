// SPDX-License-Identifier: Apache-2.0
// The digest depends on the inputs of a run and on nothing else.
#include <algorithm>
#include <array>
#include <cstdint>
#include <functional>
#include <iostream>

#include <gtest/gtest.h>

#include "core/localizer/localizer.h"
#include "core/localizer/run_digest.h"
#include "tests/core/localizer/scene.h"

namespace boresight::test {
namespace {

using Digest = std::array<std::uint8_t, 32>;

Digest digestOf(const LocalizationProblem& problem, const LocalizerOptions& options) {
  OwnedRun run(problem, options);
  EXPECT_EQ(run.localizer.status(), Status::kOk);
  run.finish();
  return run.localizer.digest();
}

TEST(LocalizerDigest, DoesNotDependOnPlaceOrContentOfMemory) {
  const Case scene = stationCase(4);
  const LocalizerOptions options = defaultProfile();
  const Digest expected = digestOf(scene.problem(), options);
  const std::size_t bytes = blockFor(scene.problem(), options).size();
  for (const std::size_t shift : {std::size_t{16}, std::size_t{4096 + 48}}) {
    std::vector<std::byte> memory(bytes + shift + 1000, std::byte{0xA5});
    Localizer localizer(scene.problem(), options, std::span(memory).subspan(shift));
    ASSERT_EQ(localizer.status(), Status::kOk);
    while (!localizer.step().finished) {
    }
    EXPECT_EQ(localizer.digest(), expected);
  }
}

TEST(LocalizerDigest, DoesNotDependOnTheKernels) {
  const Case scene = stationCase(4);
  const LocalizerOptions options = defaultProfile();
  const Digest expected = digestOf(scene.problem(), options);
  for (int k = 1; k < kKernelSets; ++k) {
    const Kernels kernels = static_cast<Kernels>(k);
    std::size_t bytes = 0;
    const Status sized = requiredBytes(sizeOf(scene.problem()), options, 1, bytes, kernels);
    if (!kernelsAvailable(kernels)) {
      std::cout << "not available here: " << kernelsName(kernels) << "\n";
      EXPECT_EQ(sized, Status::kInvalidOption);
      continue;
    }
    std::vector<std::byte> memory(bytes);
    Localizer localizer(scene.problem(), options, memory, 1, kernels);
    while (!localizer.step().finished) {
    }
    EXPECT_EQ(localizer.digest(), expected) << kernelsName(kernels);
  }
}

TEST(LocalizerDigest, DoesNotDependOnTheImagesPadding) {
  const Case scene = stationCase(4);
  LocalizationProblem problem = scene.problem();
  std::vector<std::uint8_t> padded(512 * 600, 0x5A);
  for (int y = 0; y < 512; ++y) {
    for (int x = 0; x < 512; ++x)
      padded[static_cast<std::size_t>(y * 600 + x)] = problem.image.at(x, y);
  }
  const Digest expected = digestOf(problem, defaultProfile());
  problem.image.data = padded.data();
  problem.image.stride = 600;
  EXPECT_EQ(digestOf(problem, defaultProfile()), expected);
}

TEST(LocalizerDigest, ReadAccess_ChangesNothing) {
  const Case scene = stationCase(4);
  OwnedRun run(scene.problem(), withoutSearch());
  double sum = 0.0;
  Digest before{};
  int stages = 0;
  run.finish([&](const StepReport& report) {
    const Workspace copy = run.localizer.workspace();
    if (copy.iteration != nullptr) {
      const Iteration iteration = *copy.iteration;
      sum += iteration.camera_from_station.translation_m.sum() + iteration.render.pixel_count;
    }
    const Digest current = run.localizer.digest();
    EXPECT_EQ(run.localizer.digest(), current);
    if (report.stage_complete && current != before) ++stages;
    before = current;
  });
  EXPECT_GT(sum, 0.0);
  EXPECT_GT(stages, 10);
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

TEST(LocalizerDigest, Restart_GivesTheDigestOfANewRun) {
  const Case scene = stationCase(4);
  const Case other = stationCase(5);
  LocalizerOptions first = withoutSearch();
  first.support.min_support = 0.99;  // so that the first run makes three attempts
  OwnedRun run(other.problem(), first);
  run.finish();
  ASSERT_EQ(run.localizer.workspace().attempts, 3);
  LocalizationProblem problem = other.problem();
  problem.camera_from_station_seed = scene.seed;
  ASSERT_EQ(run.localizer.restart(problem, withoutSearch()), Status::kOk);
  EXPECT_EQ(run.localizer.workspace().status, LocalizationStatus::kRunning);
  OwnedRun fresh(problem, withoutSearch());
  for (bool finished = false; !finished;) {
    finished = fresh.localizer.step().finished;
    ASSERT_EQ(run.localizer.step().finished, finished);
  }
  EXPECT_EQ(run.localizer.digest(), fresh.localizer.digest());
  EXPECT_EQ(run.localizer.workspace().attempts, fresh.localizer.workspace().attempts);
  EXPECT_EQ(run.localizer.workspace().iterations, fresh.localizer.workspace().iterations);
  EXPECT_EQ(run.localizer.workspace().support.covered, fresh.localizer.workspace().support.covered);
  EXPECT_EQ(run.localizer.workspace().edges.edge_count,
            fresh.localizer.workspace().edges.edge_count);
}

TEST(LocalizerDigest, RestartWithAnotherImage_GivesTheDigestOfANewRun) {
  const Case scene = stationCase(4);
  const Picture noise = noisePicture(512, 512, 1);
  LocalizationProblem other = scene.problem();
  other.image = noise.view();
  other.uncertainty.translation_m *= 0.5;
  OwnedRun run(other, defaultProfile());
  run.finish();
  ASSERT_EQ(run.localizer.restart(scene.problem(), defaultProfile()), Status::kOk);
  run.finish();
  EXPECT_EQ(run.localizer.digest(), digestOf(scene.problem(), defaultProfile()));
}

TEST(LocalizerDigest, RestartInTheMiddle_GivesTheDigestOfANewRun) {
  const Case scene = stationCase(4);
  const Digest expected = digestOf(scene.problem(), paperProfile());
  // Options that need all the memory, then options that need less, and back.
  std::vector<std::byte> memory(std::max(blockFor(scene.problem(), paperProfile()).size(),
                                         blockFor(scene.problem(), defaultProfile()).size()));
  Localizer localizer(scene.problem(), paperProfile(), memory);
  for (const int steps : {1, 7, 100, 333}) {
    for (int i = 0; i < steps; ++i) localizer.step();
    ASSERT_EQ(localizer.restart(scene.problem(), defaultProfile()), Status::kOk);
    for (int i = 0; i < steps; ++i) localizer.step();
    ASSERT_EQ(localizer.restart(scene.problem(), paperProfile()), Status::kOk);
  }
  while (!localizer.step().finished) {
  }
  EXPECT_EQ(localizer.digest(), expected);
}

}  // namespace
}  // namespace boresight::test
