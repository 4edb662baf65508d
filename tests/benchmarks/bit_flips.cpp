// SPDX-License-Identifier: Apache-2.0
// bit_flips PROBLEM.bin IMAGE.pgm TRIALS [SEED]: flips one random bit of the block that
// app/flight/flight_driver.cpp keeps everything in (mesh, mask, pixels, localizer), at a random step
// of a run, and reports what became of it. `whs problem` writes both files. Each trial is a process
// of its own, so that a crash or an endless run is one outcome among others.
#include <signal.h>
#include <sys/wait.h>
#include <unistd.h>

#include <algorithm>
#include <array>
#include <cstdio>
#include <cstdlib>
#include <cstring>
#include <fstream>
#include <iterator>
#include <map>
#include <string>
#include <vector>

#include "core/base/random.h"
#include "core/localizer/localizer.h"
#include "core/localizer/problem_bytes.h"
#include "core/localizer/pose_change.h"

namespace boresight {
namespace {

constexpr std::size_t kBlockBytes = 10'000'000;
constexpr unsigned kMostSeconds = 60;
/// A pose that moves the corners of the station's box by more than this in the image is wrong.
constexpr double kSamePose_px = 2.0;

alignas(Arena::kAlignment) std::byte block[kBlockBytes];

std::vector<std::uint8_t> bytesOf(const char* file) {
  std::ifstream stream(file, std::ios::binary);
  return {std::istreambuf_iterator<char>(stream), {}};
}

/// Decoded problem and pixels in the front of the block.
struct Inputs {
  LocalizationProblem problem;
  LocalizerOptions options;
  std::size_t used = 0;
};

bool readInputs(const char* problem_file, const char* image_file, Inputs& inputs) {
  Arena arena{std::span<std::byte>(block)};
  const auto encoded = bytesOf(problem_file);
  if (decodeProblem(encoded, arena, inputs.problem, inputs.options).fault != ProblemFault::kNone)
    return false;
  const auto pgm = bytesOf(image_file);
  const auto count = static_cast<std::size_t>(inputs.problem.camera.width) *
                     static_cast<std::size_t>(inputs.problem.camera.height);
  if (pgm.size() < count) return false;
  const std::span<std::uint8_t> pixels = arena.allocate<std::uint8_t>(count);
  if (pixels.size() != count) return false;
  std::copy(pgm.end() - static_cast<std::ptrdiff_t>(count), pgm.end(), pixels.begin());
  inputs.problem.image = {pixels.data(), inputs.problem.camera.width,
                          inputs.problem.camera.height, inputs.problem.camera.width};
  inputs.used = arena.used();
  return true;
}

/// How a run ended, small enough for a pipe.
struct Outcome {
  LocalizationStatus status = LocalizationStatus::kRunning;
  std::array<double, 7> pose{};
  std::array<std::uint8_t, 32> digest{};
  std::int32_t steps = 0;

  bool accepted() const { return status == LocalizationStatus::kConverged; }
};

struct Flip {
  std::int32_t step = -1;  ///< before this step; -1: none
  std::size_t byte = 0;
  int bit = 0;
};

Outcome runWith(const Inputs& inputs, const Flip& flip) {
  Localizer localizer(inputs.problem, inputs.options,
                      std::span<std::byte>(block).subspan(inputs.used));
  Outcome outcome;
  bool finished = false;
  while (!finished) {
    if (outcome.steps == flip.step)
      block[flip.byte] ^= static_cast<std::byte>(1U << static_cast<unsigned>(flip.bit));
    finished = localizer.step().finished;
    ++outcome.steps;
  }
  const Workspace& workspace = localizer.workspace();
  outcome.status = workspace.status;
  const Pose& pose = workspace.camera_from_station;
  outcome.pose = {pose.rotation.w(),    pose.rotation.x(),      pose.rotation.y(),
                  pose.rotation.z(),    pose.translation_m.x(), pose.translation_m.y(),
                  pose.translation_m.z()};
  outcome.digest = localizer.digest();
  return outcome;
}

Pose poseOf(const Outcome& outcome) {
  const auto& p = outcome.pose;
  return {Eigen::Quaterniond(p[0], p[1], p[2], p[3]), {p[4], p[5], p[6]}};
}

/// In a child process; false when it crashed or did not end.
bool tryFlip(const Inputs& inputs, const Flip& flip, Outcome& outcome, bool& hung) {
  int ends[2];
  if (pipe(ends) != 0) std::exit(1);
  const pid_t child = fork();
  if (child == 0) {
    alarm(kMostSeconds);
    const Outcome own = runWith(inputs, flip);
    const ssize_t written = write(ends[1], &own, sizeof(own));
    _exit(written == static_cast<ssize_t>(sizeof(own)) ? 0 : 1);
  }
  close(ends[1]);
  const ssize_t got = read(ends[0], &outcome, sizeof(outcome));
  close(ends[0]);
  int status = 0;
  waitpid(child, &status, 0);
  hung = WIFSIGNALED(status) && WTERMSIG(status) == SIGALRM;
  return got == static_cast<ssize_t>(sizeof(outcome));
}

std::string kindOf(const Inputs& inputs, const Outcome& good, const Outcome& outcome) {
  const bool same_digest = outcome.digest == good.digest;
  if (!outcome.accepted()) return "not accepted";
  const double moved_px =
      displacementBetween_px(poseOf(good), poseOf(outcome), matchedBounds(inputs.problem.mesh),
                             inputs.problem.camera);
  const bool same_pose = outcome.pose == good.pose;
  const std::string digest = same_digest ? ", same digest" : ", other digest";
  if (same_pose) return "accepted, same pose" + digest;
  return (moved_px <= kSamePose_px ? "accepted, within 2 px" : "accepted, WRONG") + digest;
}

int campaign(const char* problem_file, const char* image_file, int trials, std::uint64_t seed) {
  Inputs inputs;
  if (!readInputs(problem_file, image_file, inputs)) {
    std::fprintf(stderr, "bit_flips: cannot read the problem or the image\n");
    return 1;
  }
  Outcome good;
  bool hung = false;
  if (!tryFlip(inputs, Flip(), good, hung) || !good.accepted()) {
    std::fprintf(stderr, "bit_flips: the run without a flip does not converge\n");
    return 1;
  }
  std::size_t bytes = 0;
  if (requiredBytes(sizeOf(inputs.problem), inputs.options, bytes) != Status::kOk) return 1;
  bytes += inputs.used;
  Random random(seed);
  std::map<std::string, int> kinds;
  for (int trial = 0; trial < trials; ++trial) {
    const Flip flip{static_cast<std::int32_t>(random.below(static_cast<std::uint32_t>(good.steps))),
                    random.below(static_cast<std::uint32_t>(bytes)),
                    static_cast<int>(random.below(8))};
    Outcome outcome;
    const bool ended = tryFlip(inputs, flip, outcome, hung);
    const std::string kind = ended ? kindOf(inputs, good, outcome) : hung ? "endless" : "crash";
    ++kinds[kind];
    if (kind.find("WRONG") != std::string::npos || !ended)
      std::printf("%s: step %d, byte %zu of %zu (inputs %zu), bit %d\n", kind.c_str(), flip.step,
                  flip.byte, bytes, inputs.used, flip.bit);
  }
  for (const auto& [kind, count] : kinds)
    std::printf("%7d of %d  %s\n", count, trials, kind.c_str());
  return 0;
}

}  // namespace
}  // namespace boresight

int main(int argc, char** argv) {
  if (argc < 4) {
    std::fprintf(stderr, "usage: bit_flips PROBLEM.bin IMAGE.pgm TRIALS [SEED]\n");
    return 2;
  }
  return boresight::campaign(argv[1], argv[2], std::atoi(argv[3]),
                             argc > 4 ? std::strtoull(argv[4], nullptr, 10) : 1);
}
