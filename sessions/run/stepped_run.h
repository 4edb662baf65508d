// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <chrono>
#include <cstddef>
#include <memory>
#include <stop_token>

#include "core/localizer/localizer.h"
#include "sessions/run/run_snapshot.h"

namespace boresight::sessions {

/// How far a step goes.
enum class StepUntil { kStage, kIteration, kEnd };

/// A localization that halts where its caller wants to look: after a stage, after an iteration, at
/// its end, or between any two slices when it is stopped. It can go on from wherever it halted, and
/// halting changes no bit of the result. One thread at a time.
class SteppedRun {
 public:
  /// Takes memory for the whole run; what `problem` points to must outlive the object. A problem
  /// or plan that cannot run is a snapshot with kFault that is finished. Throws std::bad_alloc.
  SteppedRun(const LocalizationProblem& problem, const RunPlan& plan);

  SteppedRun(const SteppedRun&) = delete;
  SteppedRun& operator=(const SteppedRun&) = delete;

  /// Works on; nothing when it has finished.
  void advance(StepUntil until, const std::stop_token& stop = {});

  bool finished() const { return snapshot_.finished; }
  /// Iterations that are complete.
  std::size_t complete() const {
    return snapshot_.iterations.size() - (snapshot_.last_under_way ? 1 : 0);
  }
  /// Everything up to now. The iteration under way is copied here when a stage of it was completed.
  const RunSnapshot& snapshot() const { return snapshot_; }

 private:
  using Clock = std::chrono::steady_clock;

  void note(const StepReport& report, double seconds);
  void noteIteration(const StepReport& report);
  void finish();

  RunSnapshot snapshot_;
  std::unique_ptr<std::byte[]> memory_;
  std::unique_ptr<Localizer> localizer_;
  PlannedChanges changes_;
  StageSeconds iteration_seconds_;
};

}  // namespace boresight::sessions
