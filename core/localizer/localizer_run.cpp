// SPDX-License-Identifier: Apache-2.0
// Start, end and change of options of a run.
#include <algorithm>
#include <cstdint>

#include "core/localizer/localizer.h"

namespace boresight {
namespace {

/// The block from its first aligned byte on.
std::span<std::byte> alignedBlock(std::span<std::byte> memory) {
  const std::size_t past = reinterpret_cast<std::uintptr_t>(memory.data()) % Arena::kAlignment;
  const std::size_t skipped = past > 0 ? Arena::kAlignment - past : 0;
  return memory.subspan(std::min(skipped, memory.size()));
}

}  // namespace

Localizer::Localizer(const LocalizationProblem& problem, const LocalizerOptions& options,
                     std::span<std::byte> memory, int workers, Kernels kernels)
    : memory_(alignedBlock(memory)), workers_(workers), kernels_(kernels) {
  status_ = memory_.empty() ? Status::kArenaTooSmall : begin(problem, options);
}

Status Localizer::begin(const LocalizationProblem& problem, const LocalizerOptions& options) {
  const Status status = pass_.create(problem, options, memory_, workers_, kernels_);
  phase_ = Phase::kEdges;
  pass_.workspace().fault = status;
  if (status != Status::kOk) return status;
  attempt_ = Attempt(0, seedOf(pass_.problem()));
  comparison_ = PoseComparison();
  return status;
}

Status Localizer::restart(const LocalizationProblem& problem, const LocalizerOptions& options) {
  if (!isUsable(PosePrior{problem.camera_from_station_seed, problem.uncertainty}))
    return Status::kInvalidPose;
  std::size_t bytes = 0;
  Status status = requiredBytes(sizeOf(problem), options, workers_, bytes, kernels_);
  if (status == Status::kOk && bytes > memory_.size()) status = Status::kArenaTooSmall;
  if (status == Status::kOk) status_ = status = begin(problem, options);
  return status;
}

bool Localizer::isBetweenIterations() const {
  if (status_ != Status::kOk || pass_.running()) return false;
  return phase_ == Phase::kIterate && attempt_.atIterationStart();
}

bool Localizer::changeOptions(const LocalizerOptions& options) {
  if (!isBetweenIterations() || firstInvalidOption(options) != nullptr ||
      firstFixedOption(pass_.options(), options) != nullptr)
    return false;
  if (sameOptions(pass_.options(), options)) return true;
  pass_.changeOptions(options);
  // The start of the first attempt depends on the options.
  if (searches() && workspace().iterations == 0) startComparison();
  return true;
}

/// Whether the run begins with the seed itself before it searches the whole object.
bool Localizer::startsNear() const {
  return searches() && options().refinement.enabled && isNear(seedOf(problem()), pass_.context());
}

/// The attempt of the refined seed, or of the search's first candidate.
void Localizer::startComparison() {
  const bool is_near = attempt_.index() == 0 && startsNear();
  const Seed seed = seedOf(problem());
  if (is_near)
    comparison_ = PoseComparison::ofNearSeed(workspace().candidates, seed);
  else if (pass_.searchIsSuspended())
    comparison_ = PoseComparison::ofFirst(workspace().candidates, seed);
  else
    comparison_ = PoseComparison(workspace().candidates, seed);
  comparison_.writeTo(pass_.context(), pass_.workspace());
  iterate(comparison_.next(attempt_.index(), pass_.context()));
}

/// Starts the first iteration of an attempt.
void Localizer::iterate(const Attempt& attempt) {
  attempt_ = attempt;
  phase_ = Phase::kIterate;
  pass_.workspace().attempts = attempt_.index() + 1;
}

/// Shows the record of a ruling, and reports its stage.
StepReport Localizer::show(const Ruling& ruling) {
  pass_.show(ruling);
  StepReport report = StepReport::of(ruling.stage, true);
  report.iteration_complete = ruling.iteration_complete;
  return report;
}

/// Number of matches of the iteration that agree with its pose.
Agreement Localizer::agreement() const {
  const Iteration& iteration = *workspace().iteration;
  return {iteration.pnp.inlier_count, iteration.correspondence_count};
}

StepReport Localizer::finish(LocalizationStatus status, StepReport report) {
  if (status == LocalizationStatus::kConverged && !pass_.memoryHolds()) {
    status = LocalizationStatus::kFault;
    pass_.workspace().fault = Status::kMemoryChanged;
  }
  pass_.finish(status, attempt_.camera_from_station(), covariance_);
  phase_ = Phase::kEnded;
  report.finished = true;
  return report;
}

}  // namespace boresight
