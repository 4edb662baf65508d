// SPDX-License-Identifier: Apache-2.0
// bit_flips PROBLEM.bin IMAGE.pgm TRUTH.txt TRIALS [SEED [JOBS]]: each trial flips one random bit
// before a random step of a run, and reports how the run ends. The memory is that of
// app/flight/flight_driver.cpp: one block with the decoded mesh and mask, the pixels and the
// localizer's own memory, in this order. A second table has trials in the localizer object, which
// the driver keeps on its stack. `whs problem` writes problem and image; the truth is
// camera_from_station as 16 numbers, row by row. Figures of resources/evidence/trust.md.
//
// One process runs without a flip; before each step it forks the trials of that step. A crash or an
// endless run is thus one outcome among others. A trial ends early when all its memory equals that
// of the run without a flip: then the rest is the same.
#include <signal.h>
#include <sys/resource.h>
#include <sys/wait.h>
#include <unistd.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdio>
#include <cstdlib>
#include <cstring>
#include <exception>
#include <fstream>
#include <iterator>
#include <map>
#include <new>
#include <span>
#include <stdexcept>
#include <string>
#include <vector>

#include "core/base/math.h"
#include "core/base/random.h"
#include "core/localizer/localizer.h"
#include "core/record/problem_bytes.h"

namespace boresight::test {
namespace {

constexpr std::size_t kBlockBytes = 10'000'000;
constexpr rlim_t kMostSeconds = 30;  ///< of processor time, several times that of any run

alignas(Arena::kAlignment) std::byte block[kBlockBytes];
alignas(Localizer) std::byte object[sizeof(Localizer)];

/// The requirement of a sample transfer.
constexpr double kMostNormal_m = 0.0004;
constexpr double kMostLateral_m = 0.0004;
constexpr double kMostRotation_rad = 0.25 * kDegree_rad;

/// Inputs in the front of the block; `pixels_begin` and `used` are offsets in it.
struct Inputs {
  LocalizationProblem problem;
  LocalizerOptions options;
  Pose camera_from_station_true;
  std::size_t pixels_begin = 0;
  std::size_t used = 0;
};

std::vector<std::uint8_t> bytesOf(const char* file) {
  std::ifstream stream(file, std::ios::binary);
  return {std::istreambuf_iterator<char>(stream), {}};
}

Pose readTruth(const char* file) {
  std::ifstream stream(file);
  Eigen::Matrix4d matrix;
  for (int i = 0; i < 16; ++i) stream >> matrix(i / 4, i % 4);
  Pose pose;
  double deviation = 0.0;
  const Status status =
      poseFromMatrix(matrix.topLeftCorner<3, 3>(), matrix.topRightCorner<3, 1>(), pose, deviation);
  if (!stream || status != Status::kOk) throw std::runtime_error("the truth is no pose");
  return pose;
}

/// As flight_driver reads them.
void readInputs(const char* problem_file, const char* image_file, Inputs& inputs) {
  Arena arena{std::span<std::byte>(block)};
  if (decodeProblem(bytesOf(problem_file), arena, inputs.problem, inputs.options).fault !=
      ProblemFault::kNone)
    throw std::runtime_error("the problem is refused");
  inputs.pixels_begin = arena.used();
  const Camera& camera = inputs.problem.camera;
  const std::vector<std::uint8_t> pgm = bytesOf(image_file);
  const auto count = static_cast<std::size_t>(camera.width * camera.height);
  if (pgm.size() < count) throw std::runtime_error("the image is too small");
  const std::span<std::uint8_t> pixels = arena.allocate<std::uint8_t>(count);
  std::copy(pgm.end() - static_cast<std::ptrdiff_t>(count), pgm.end(), pixels.begin());
  inputs.problem.image = {pixels.data(), camera.width, camera.height, camera.width};
  inputs.used = arena.used();
}

/// Errors of a pose where the end effector is, as `whs evaluate` reports them.
struct PoseError {
  double normal_m = 0.0;
  double lateral_m = 0.0;
  double rotation_rad = 0.0;

  bool isWithinRequirement() const {
    return std::abs(normal_m) <= kMostNormal_m && lateral_m <= kMostLateral_m &&
           rotation_rad <= kMostRotation_rad;
  }
};

PoseError errorOf(const Inputs& inputs, const Pose& camera_from_station_expected,
                  const Pose& camera_from_station) {
  const Pose expected_from_found = camera_from_station_expected * camera_from_station.inverse();
  const Eigen::Vector3d& point_m = inputs.problem.end_effector_in_camera_m;
  const Eigen::Vector3d moved_m = expected_from_found * point_m - point_m;
  const Eigen::Vector3d axis = expected_from_found.matrix().col(2);
  return {moved_m.z(), std::hypot(moved_m.x(), moved_m.y()),
          std::atan2(std::hypot(axis.x(), axis.y()), axis.z())};
}

struct Flip {
  int step = 0;  ///< before this step
  std::byte* byte = nullptr;
  unsigned bit = 0;
};

/// How a run ended, small enough for a pipe.
struct Outcome {
  LocalizationStatus status = LocalizationStatus::kRunning;
  Status fault = Status::kOk;
  Pose camera_from_station;
  std::array<std::uint8_t, 32> digest{};
};

Outcome outcomeOf(const Localizer& localizer) {
  const Workspace& workspace = localizer.workspace();
  return {workspace.status, workspace.fault, workspace.camera_from_station, localizer.digest()};
}

/// The run without a flip.
struct Reference {
  Outcome outcome;
  int steps = 0;
  std::size_t bytes = 0;              ///< of the block that are used
  std::vector<std::uint64_t> states;  ///< hash of all memory, each kStepsBetween steps
  static constexpr int kStepsBetween = 32;

  bool isSaved(int step) const { return step % kStepsBetween == 0; }
  std::uint64_t stateAt(int step) const {
    return states[static_cast<std::size_t>(step / kStepsBetween)];
  }
};

std::uint64_t hashOf(std::span<const std::byte> memory, std::uint64_t hash) {
  for (std::size_t at = 0; at + 8 <= memory.size(); at += 8) {
    std::uint64_t word = 0;
    std::memcpy(&word, memory.data() + at, sizeof(word));
    hash = (hash ^ word) * 0x9e3779b97f4a7c15u;
    hash ^= hash >> 29;
  }
  return hash;
}

std::uint64_t hashOfMemory(std::size_t bytes) {
  return hashOf(std::span<const std::byte>(block).first(bytes), hashOf(object, 0));
}

Localizer& startLocalizer(const Inputs& inputs) {
  std::memset(block + inputs.used, 0, sizeof(block) - inputs.used);
  std::memset(object, 0, sizeof(object));
  return *new (static_cast<void*>(object))
      Localizer(inputs.problem, inputs.options, std::span<std::byte>(block).subspan(inputs.used));
}

Reference runReference(const Inputs& inputs) {
  Reference reference;
  Localizer& localizer = startLocalizer(inputs);
  reference.bytes = inputs.used + localizer.highWaterBytes();
  for (bool finished = false; !finished; ++reference.steps) {
    if (reference.isSaved(reference.steps))
      reference.states.push_back(hashOfMemory(reference.bytes));
    finished = localizer.step().finished;
  }
  reference.outcome = outcomeOf(localizer);
  return reference;
}

/// The rest of a run from a step on.
Outcome finish(Localizer& localizer, int step, const Reference& reference) {
  bool finished = false;
  for (; !finished; ++step) {
    if (step < reference.steps && reference.isSaved(step) &&
        hashOfMemory(reference.bytes) == reference.stateAt(step))
      return reference.outcome;
    finished = localizer.step().finished;
  }
  return outcomeOf(localizer);
}

/// A running trial.
struct Child {
  pid_t pid = 0;
  int pipe_end = 0;
  Flip flip;
};

Child startTrial(Localizer& localizer, const Flip& flip, const Reference& reference) {
  int ends[2];
  if (pipe(ends) != 0) throw std::runtime_error("no pipe");
  const pid_t pid = fork();
  if (pid == 0) {
    const rlimit limit{kMostSeconds, kMostSeconds}, no_core{0, 0};
    setrlimit(RLIMIT_CPU, &limit);
    setrlimit(RLIMIT_CORE, &no_core);
    *flip.byte ^= static_cast<std::byte>(1U << flip.bit);
    const Outcome outcome = finish(localizer, flip.step, reference);
    const ssize_t written = write(ends[1], static_cast<const void*>(&outcome), sizeof(outcome));
    _exit(written == static_cast<ssize_t>(sizeof(outcome)) ? 0 : 1);
  }
  close(ends[1]);
  return {pid, ends[0], flip};
}

/// Counts of one campaign.
class Tally {
 public:
  Tally(const Inputs& inputs, const Outcome& good) : inputs_(inputs), good_(good) {}

  /// Waits for a trial and counts its outcome.
  void take(const Child& child) {
    Outcome outcome;
    const ssize_t got = read(child.pipe_end, static_cast<void*>(&outcome), sizeof(outcome));
    close(child.pipe_end);
    int status = 0;
    waitpid(child.pid, &status, 0);
    std::string kind = "crash";
    if (got == static_cast<ssize_t>(sizeof(outcome)))
      kind = kindOf(outcome);
    else if (WIFSIGNALED(status) && (WTERMSIG(status) == SIGKILL || WTERMSIG(status) == SIGXCPU))
      kind = "endless";
    ++counts_[kind][placeOf(child.flip.byte)];
    ++trials_;
    if (!kind.starts_with("accepted, same pose")) print(kind, child.flip, outcome);
  }

  void print() const {
    for (const auto& [kind, places] : counts_) {
      int sum = 0;
      std::string text;
      for (const auto& [place, count] : places) {
        sum += count;
        text += "  " + place + " " + std::to_string(count);
      }
      std::printf("%7d of %d  %s:%s\n", sum, trials_, kind.c_str(), text.c_str());
    }
  }

 private:
  std::string kindOf(const Outcome& outcome) const {
    const bool same_pose = perturbationBetween(outcome.camera_from_station,
                                               good_.camera_from_station) == Vector6d::Zero();
    const std::string digest = outcome.digest == good_.digest ? ", same digest" : ", other digest";
    if (outcome.status == LocalizationStatus::kFault)
      return std::string("refused: fault ") + statusText(outcome.fault);
    if (outcome.status != LocalizationStatus::kConverged)
      return std::string("refused: ") + localizationStatusText(outcome.status);
    if (same_pose) return "accepted, same pose" + digest;
    const bool right =
        errorOf(inputs_, inputs_.camera_from_station_true, outcome.camera_from_station)
            .isWithinRequirement();
    return (right ? "accepted, other pose within the requirement" : "accepted, WRONG") + digest;
  }

  std::string placeOf(const std::byte* byte) const {
    if (byte >= object && byte < object + sizeof(object)) return "object";
    const auto offset = static_cast<std::size_t>(byte - block);
    return offset < inputs_.pixels_begin ? "mesh" : offset < inputs_.used ? "pixels" : "localizer";
  }

  void print(const std::string& kind, const Flip& flip, const Outcome& outcome) const {
    const std::byte* base = placeOf(flip.byte) == "object" ? object : block;
    const PoseError moved =
        errorOf(inputs_, good_.camera_from_station, outcome.camera_from_station);
    std::fprintf(stderr, "%s: %s byte %td bit %u step %d; moved %.4f %.4f mm %.4f mrad\n",
                 kind.c_str(), placeOf(flip.byte).c_str(), flip.byte - base, flip.bit, flip.step,
                 1e3 * moved.normal_m, 1e3 * moved.lateral_m, 1e3 * moved.rotation_rad);
  }

  const Inputs& inputs_;
  const Outcome& good_;
  std::map<std::string, std::map<std::string, int>> counts_;
  int trials_ = 0;
};

/// Random flips in a region, by step.
std::vector<Flip> drawFlips(int trials, int steps, std::span<std::byte> region, Random& random) {
  std::vector<Flip> flips;
  for (int trial = 0; trial < trials; ++trial) {
    const auto step = static_cast<int>(random.below(static_cast<std::uint32_t>(steps)));
    std::byte* byte = region.data() + random.below(static_cast<std::uint32_t>(region.size()));
    flips.push_back({step, byte, random.below(8)});
  }
  std::stable_sort(flips.begin(), flips.end(),
                   [](const Flip& a, const Flip& b) { return a.step < b.step; });
  return flips;
}

void runTrials(const Inputs& inputs, const Reference& reference, const std::vector<Flip>& flips,
               std::size_t jobs) {
  Tally tally(inputs, reference.outcome);
  std::vector<Child> running;
  Localizer& localizer = startLocalizer(inputs);
  int step = 0;
  for (const Flip& flip : flips) {
    for (; step < flip.step; ++step) (void)localizer.step();
    if (running.size() == jobs) {
      tally.take(running.front());
      running.erase(running.begin());
    }
    running.push_back(startTrial(localizer, flip, reference));
  }
  for (const Child& child : running) tally.take(child);
  tally.print();
}

int campaign(const Inputs& inputs, int trials, std::uint64_t seed, std::size_t jobs) {
  const Reference reference = runReference(inputs);
  if (reference.outcome.status != LocalizationStatus::kConverged) {
    std::fprintf(stderr, "bit_flips: the run without a flip does not converge: %s\n",
                 localizationStatusText(reference.outcome.status));
    return 1;
  }
  std::printf("%d steps; %zu bytes of mesh, %zu of pixels, %zu of the localizer; object %zu\n",
              reference.steps, inputs.pixels_begin, inputs.used - inputs.pixels_begin,
              reference.bytes - inputs.used, sizeof(object));
  std::fflush(stdout);
  Random random(seed);
  const auto used = std::span<std::byte>(block).first(reference.bytes);
  runTrials(inputs, reference, drawFlips(trials, reference.steps, used, random), jobs);
  std::fflush(stdout);
  runTrials(inputs, reference, drawFlips(trials / 10, reference.steps, object, random), jobs);
  return 0;
}

}  // namespace
}  // namespace boresight::test

int main(int argc, char** argv) {
  if (argc < 5) {
    std::fprintf(stderr, "usage: bit_flips PROBLEM.bin IMAGE.pgm TRUTH.txt TRIALS [SEED [JOBS]]\n");
    return 2;
  }
  try {
    boresight::test::Inputs inputs;
    boresight::test::readInputs(argv[1], argv[2], inputs);
    inputs.camera_from_station_true = boresight::test::readTruth(argv[3]);
    return boresight::test::campaign(inputs, std::atoi(argv[4]),
                                     argc > 5 ? std::strtoull(argv[5], nullptr, 10) : 1,
                                     argc > 6 ? static_cast<std::size_t>(std::atoi(argv[6])) : 2);
  } catch (const std::exception& error) {
    std::fprintf(stderr, "bit_flips: %s\n", error.what());
    return 3;
  }
}
