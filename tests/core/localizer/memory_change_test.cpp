// SPDX-License-Identifier: Apache-2.0
// A bit that flips in the memory of a run never gives a pose that is accepted and wrong.
#include <sys/wait.h>
#include <unistd.h>

#include <cstddef>
#include <span>
#include <vector>

#include <gtest/gtest.h>

#include "core/base/random.h"
#include "core/localizer/localizer.h"
#include "tests/core/localizer/scene.h"

namespace boresight::test {
namespace {

/// The picture and the mesh of a case in memory that a test may change.
struct ChangeableCase {
  Case scene = stationCase(1);
  Picture picture = *scene.picture;
  LocalizerOptions options = withoutSearch();

  LocalizationProblem problem() {
    scene.picture = &picture;
    return scene.problem();
  }
};

/// A run in which the lowest bit of a value flips before a step, and flips back at the end: without
/// the checksums it ends as if nothing had happened.
void expectNoticed(ChangeableCase& input, std::byte& byte, int step) {
  OwnedRun run(input.problem(), input.options);
  for (int i = 0; i < step; ++i) run.localizer.step();
  byte ^= std::byte{1};
  run.finish();
  byte ^= std::byte{1};
  EXPECT_EQ(run.workspace.status, LocalizationStatus::kFault);
  EXPECT_STREQ(statusText(run.workspace.fault), statusText(Status::kMemoryChanged));
}

TEST(MemoryChange, OfAPixelOrVertex_IsNoticedWhetherItMattersOrNot) {
  ChangeableCase input;
  const std::span<std::byte> bytes = std::as_writable_bytes(std::span(input.picture.gray));
  Random random(1);
  for (int trial = 0; trial < 4; ++trial) {
    expectNoticed(input, bytes[random.below(static_cast<std::uint32_t>(bytes.size()))], 10 * trial);
    Eigen::Vector3f& vertex = input.scene.solid.vertices[static_cast<std::size_t>(7 * trial)];
    expectNoticed(input, *reinterpret_cast<std::byte*>(&vertex[trial % 3]), 10 * trial);
  }
}

TEST(MemoryChange, BeforeTheRunBeginsIsAnInputLikeAnyOther) {
  ChangeableCase input;
  input.picture.gray[1000] ^= 1;
  input.scene.picture = &input.picture;
  EXPECT_EQ(endOf(input.scene, input.options), LocalizationStatus::kConverged);
}

TEST(MemoryChange, OfOptionsByTheCallerIsNone) {
  ChangeableCase input;
  OwnedRun run(input.problem(), input.options);
  LocalizerOptions options = input.options;
  options.pnp.max_samples += 1;
  bool changed = false;
  run.finish([&](const StepReport&) {
    if (!changed) changed = run.localizer.changeOptions(options);
  });
  EXPECT_TRUE(changed);
  EXPECT_EQ(run.workspace.status, LocalizationStatus::kConverged);
}

/// Exit codes of a trial.
enum Trial : int { kRight = 0, kRefused = 1, kWrong = 2 };

/// In a process of its own, which may crash: an index may be what flips.
Trial trialOf(OwnedRun& run, std::byte& byte, unsigned bit, const Case& scene) {
  const pid_t child = fork();
  if (child == 0) {
    alarm(120);
    byte ^= static_cast<std::byte>(1U << bit);
    while (!run.localizer.step().finished) {
    }
    if (run.workspace.status != LocalizationStatus::kConverged) _exit(kRefused);
    const PoseError error = poseError(scene.solid, scene.truth, run.workspace.camera_from_station);
    _exit(error.centre_m < 0.0004 && error.angle_rad < 0.0044 ? kRight : kWrong);
  }
  int status = 0;
  waitpid(child, &status, 0);
  return WIFEXITED(status) ? static_cast<Trial>(WEXITSTATUS(status)) : kRefused;
}

TEST(MemoryChange, OfTheLocalizersOwnMemoryNeverGivesAWrongPose) {
  ChangeableCase input;
  OwnedRun run(input.problem(), input.options);
  const std::size_t bytes = run.localizer.highWaterBytes();
  Random random(5);
  int trials = 0;
  int right = 0;
  bool finished = false;
  for (int step = 0; !finished; ++step) {
    for (int i = 0; i < (step % 8 == 0 ? 2 : 0); ++i, ++trials) {
      std::byte& byte = run.memory[random.below(static_cast<std::uint32_t>(bytes))];
      const Trial trial = trialOf(run, byte, random.below(8), input.scene);
      EXPECT_NE(trial, kWrong) << "step " << step << ", byte " << &byte - run.memory.data();
      right += trial == kRight ? 1 : 0;
    }
    finished = run.localizer.step().finished;
  }
  EXPECT_EQ(run.workspace.status, LocalizationStatus::kConverged);
  EXPECT_GT(trials, 40);
  EXPECT_GT(right, trials / 2);
}

}  // namespace
}  // namespace boresight::test
