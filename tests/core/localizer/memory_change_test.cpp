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

struct Ending {
  LocalizationStatus status = LocalizationStatus::kRunning;
  Status fault = Status::kOk;
  Pose camera_from_station;
};

/// Runs, and flips a bit before a step.
Ending endingOf(const LocalizationProblem& problem, const LocalizerOptions& options, int step,
                std::byte& byte, unsigned bit) {
  OwnedRun run(problem, options);
  int steps = 0;
  for (bool finished = false; !finished; ++steps) {
    if (steps == step) byte ^= static_cast<std::byte>(1U << bit);
    finished = run.localizer.step().finished;
  }
  byte ^= static_cast<std::byte>(1U << bit);
  const Workspace& workspace = run.localizer.workspace();
  return {workspace.status, workspace.fault, workspace.camera_from_station};
}

/// The lowest bit of a value: without the checksums the run ends as if nothing had happened.
void expectNoticed(ChangeableCase& input, std::byte& byte, int step) {
  const Ending ending = endingOf(input.problem(), input.options, step, byte, 0);
  EXPECT_EQ(ending.status, LocalizationStatus::kFault);
  EXPECT_STREQ(statusText(ending.fault), statusText(Status::kMemoryChanged));
}

TEST(MemoryChange, OfAPixel_IsNoticedWhetherItMattersOrNot) {
  ChangeableCase input;
  const std::span<std::byte> bytes = std::as_writable_bytes(std::span(input.picture.gray));
  Random random(1);
  for (int trial = 0; trial < 4; ++trial)
    expectNoticed(input, bytes[random.below(static_cast<std::uint32_t>(bytes.size()))], 10 * trial);
}

TEST(MemoryChange, OfAVertex_IsNoticedWhetherItMattersOrNot) {
  ChangeableCase input;
  for (int trial = 0; trial < 4; ++trial) {
    Eigen::Vector3f& vertex = input.scene.solid.vertices[static_cast<std::size_t>(7 * trial)];
    expectNoticed(input, *reinterpret_cast<std::byte*>(&vertex[trial % 3]), 10 * trial);
  }
}

TEST(MemoryChange, BeforeTheRunBeginsIsAnInputLikeAnyOther) {
  ChangeableCase input;
  input.picture.gray[1000] ^= 1;
  OwnedRun run(input.problem(), input.options);
  ASSERT_GT(run.finish(), 0);
  EXPECT_EQ(run.localizer.workspace().status, LocalizationStatus::kConverged);
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
  EXPECT_EQ(run.localizer.workspace().status, LocalizationStatus::kConverged);
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
    const Workspace& workspace = run.localizer.workspace();
    if (workspace.status != LocalizationStatus::kConverged) _exit(kRefused);
    const PoseError error = poseError(scene.solid, scene.truth, workspace.camera_from_station);
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
  EXPECT_EQ(run.localizer.workspace().status, LocalizationStatus::kConverged);
  EXPECT_GT(trials, 40);
  EXPECT_GT(right, trials / 2);
}

}  // namespace
}  // namespace boresight::test
