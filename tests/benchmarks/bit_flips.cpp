// SPDX-License-Identifier: Apache-2.0
// bit_flips DATASET CASE TRIALS [SEED [JOBS]]: each trial flips one random bit before a random
// step of a run, and reports how the run ends. The memory is that of app/flight/flight_driver.cpp:
// one block with the decoded mesh and mask, the pixels and the localizer's own memory, in this
// order. A second table has trials in the localizer object, which the driver keeps on its stack.
// Figures of resources/evidence/trust.md.
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
#include <cstdio>
#include <cstdlib>
#include <cstring>
#include <exception>
#include <map>
#include <memory>
#include <new>
#include <optional>
#include <span>
#include <stdexcept>
#include <string>
#include <vector>

#include "core/base/random.h"
#include "core/localizer/localizer.h"
#include "core/localizer/problem_bytes.h"
#include "sessions/evaluation/pose_error.h"
#include "sessions/session/case_run.h"
#include "sessions/session/session_maker.h"

namespace boresight::test {
namespace {

constexpr std::size_t kBlockBytes = 10'000'000;
constexpr rlim_t kMostSeconds = 30;  ///< of processor time, several times that of any run

alignas(Arena::kAlignment) std::byte block[kBlockBytes];
alignas(Localizer) std::byte object[sizeof(Localizer)];

struct Truth {
  Pose camera_from_station;
  std::optional<Pose> camera_from_end_effector;
  sessions::Requirement requirement;
};

/// Inputs in the front of the block; `pixels_begin` and `used` are offsets in it.
struct Inputs {
  LocalizationProblem problem;
  LocalizerOptions options;
  Truth truth;
  std::size_t pixels_begin = 0;
  std::size_t used = 0;
};

/// As `whs problem` writes the case and flight_driver reads it.
void readInputs(const char* file, const char* case_id, Inputs& inputs) {
  const sessions::Dataset dataset = sessions::readDataset(file);
  const sessions::Session session = sessions::makeSession(dataset, {case_id});
  const auto loaded = sessions::loadCase(*session.cases.front());
  inputs.truth = {loaded->source.camera_from_station_truth.value(),
                  loaded->source.camera_from_end_effector, loaded->source.requirement.value()};
  const LocalizationProblem problem = loaded->problem();
  const sessions::GrayImage& image = loaded->image;
  LocalizerOptions options = defaultProfile();
  options.search.color = false;  // the flight profile
  options.templates.feature_size_m = loaded->source.feature_size_m.value_or(0.0);
  std::vector<std::uint8_t> encoded(encodeProblem(problem, options, {}));
  encodeProblem(problem, options, encoded);
  Arena arena{std::span<std::byte>(block)};
  if (decodeProblem(encoded, arena, inputs.problem, inputs.options).fault != ProblemFault::kNone)
    throw std::runtime_error("the problem is refused");
  inputs.pixels_begin = arena.used();
  const std::span<std::uint8_t> pixels = arena.allocate<std::uint8_t>(image.pixels.size());
  std::copy(image.pixels.begin(), image.pixels.end(), pixels.begin());
  inputs.problem.image = {pixels.data(), image.width, image.height, image.width};
  inputs.used = arena.used();
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
    const rlimit limit{kMostSeconds, kMostSeconds};
    setrlimit(RLIMIT_CPU, &limit);
    const rlimit no_core{0, 0};
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
    if (kind != "accepted, same pose, same digest" && kind != "accepted, same pose, other digest")
      print(kind, child.flip, outcome);
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
    return (isRight(outcome) ? "accepted, other pose within the requirement" : "accepted, WRONG") +
           digest;
  }

  bool isRight(const Outcome& outcome) const {
    const Truth& truth = inputs_.truth;
    return outcome.camera_from_station.translation_m.allFinite() &&
           sessions::meetsRequirement(
               sessions::poseError(truth.camera_from_station, outcome.camera_from_station,
                                   truth.camera_from_end_effector),
               truth.requirement);
  }

  std::string placeOf(const std::byte* byte) const {
    if (byte >= object && byte < object + sizeof(object)) return "object";
    const auto offset = static_cast<std::size_t>(byte - block);
    return offset < inputs_.pixels_begin ? "mesh" : offset < inputs_.used ? "pixels" : "localizer";
  }

  void print(const std::string& kind, const Flip& flip, const Outcome& outcome) const {
    const std::byte* base = placeOf(flip.byte) == "object" ? object : block;
    const sessions::PoseError error =
        sessions::poseError(good_.camera_from_station, outcome.camera_from_station,
                            inputs_.truth.camera_from_end_effector);
    std::fprintf(stderr, "%s: %s byte %td bit %u step %d; moved %.4f %.4f mm %.4f mrad\n",
                 kind.c_str(), placeOf(flip.byte).c_str(), flip.byte - base, flip.bit, flip.step,
                 error.normal_mm, error.lateral_mm, error.rotation_mrad);
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
  if (argc < 4) {
    std::fprintf(stderr, "usage: bit_flips DATASET CASE TRIALS [SEED [JOBS]]\n");
    return 2;
  }
  try {
    boresight::test::Inputs inputs;
    boresight::test::readInputs(argv[1], argv[2], inputs);
    return boresight::test::campaign(inputs, std::atoi(argv[3]),
                                     argc > 4 ? std::strtoull(argv[4], nullptr, 10) : 1,
                                     argc > 5 ? static_cast<std::size_t>(std::atoi(argv[5])) : 2);
  } catch (const std::exception& error) {
    std::fprintf(stderr, "bit_flips: %s\n", error.what());
    return 3;
  }
}
