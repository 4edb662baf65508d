// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <memory>
#include <span>
#include <stop_token>
#include <string>
#include <vector>

#include "core/base/kernels.h"
#include "core/record/record_writer.h"
#include "core/views/views_problem.h"
#include "sessions/trace/trace.h"

namespace boresight::sessions {

class MatchingMethod;  // sessions/run/matching_method.h
class SteppedRun;      // sessions/run/stepped_run.h
class WorkerPool;      // sessions/run/worker_pool.h

/// All memory of the flight profile, in bytes: image, ignore mask, mesh and the localizer's block.
inline constexpr std::size_t kFlightMemoryBytes = 10'000'000;

/// Settings for the execution of a run. Except for `method` they do not change the result.
struct RunSettings {
  RecordLevel level = RecordLevel::kFull;
  std::size_t memory_limit = 0;  ///< bytes, inputs and the localizer's block; 0: no limit
  /// 1 ... Localizer::kMaxWorkers; 0: one per core, and one where there is a memory limit.
  int threads = 0;
  /// Instructions that the inner loops use. With a memory limit always the portable ones: wide
  /// registers need more memory, and the limit is for a machine without them.
  Kernels kernels = bestKernels();
  /// If given, receives the onboard record of the run, from its first block to its last.
  RecordWriter* onboard_record = nullptr;
  /// If given, replaces WHS and thereby changes the result.
  MatchingMethod* method = nullptr;
  /// Reflectance of each part in the render for `method`; empty: equal.
  std::span<const double> albedo_of_part = {};
};

/// Joint result of several views.
struct JointResult {
  ViewsResult result;
  std::string digest;  ///< of all views
};

/// How far a step goes.
enum class StepUntil { kStage, kIteration, kEnd };

/// The loop around Localizer::step() and ViewsLocalizer::step() on the ground: takes memory for the
/// whole run, steps with all threads, times, and keeps a trace. It halts after a stage, after an
/// iteration, at the end, or between two slices when stopped, and can continue. Neither halting nor
/// recording changes a bit of the result. One calling thread at a time.
class Runner {
 public:
  /// Data of `problem` must outlive the object. A problem or plan that cannot run, or exceeds the
  /// limit (kArenaTooSmall), results in a finished trace with kFault and without iterations. With a
  /// limit, the localizer gets the memory that the inputs leave. Throws std::bad_alloc, and
  /// MethodError when the method, if any, cannot begin.
  Runner(const LocalizationProblem& problem, const RunPlan& plan, const RunSettings& settings = {});
  /// Several views that are solved as one (core/views). `case_ids` name them in their order. Of the
  /// settings, only threads and kernels are used.
  Runner(const ViewsProblem& problem, const LocalizerOptions& options,
         const std::vector<std::string>& case_ids, const RunSettings& settings = {});
  ~Runner();

  /// Restarts with another problem, such as the next image of a sequence, with the same plan and
  /// settings, and in the same memory if it suffices. The digest is that of a new object. Not for
  /// several views.
  void restart(const LocalizationProblem& problem);

  /// Continues the run; does nothing after its end. Several views halt after iterations, not after
  /// stages. MethodError when the method, if any, fails.
  void advance(StepUntil until, const std::stop_token& stop = {});

  bool finished() const { return trace().finished; }
  /// Trace so far; of several views, that of the first.
  const LocalizationTrace& trace() const { return traces().front(); }
  /// One per view in their order, each like a separate run. Iterations are those of the first
  /// view's loop; for an iteration without the view, its trace holds only the pose of the others,
  /// in its camera frame. Times are of all views together; a digest combines the digest of all
  /// views and the view's number.
  const std::vector<LocalizationTrace>& traces() const;
  /// Of several views, once they have finished.
  const JointResult& joint() const;

 private:
  StepReport step(const std::stop_token& stop);
  void note(const StepReport& report, double seconds);

  std::unique_ptr<SteppedRun> stepped_;
  std::unique_ptr<WorkerPool> pool_;
  StageSeconds iteration_seconds_;  ///< of the iteration under way
};

/// Runs a whole localization. A stop leaves the status at kRunning. Throws as Runner does.
LocalizationTrace localize(const LocalizationProblem& problem, const RunPlan& plan,
                           const RunSettings& settings, const std::stop_token& stop = {});
inline LocalizationTrace localize(const LocalizationProblem& problem, const RunPlan& plan,
                                  RecordLevel level, const std::stop_token& stop = {}) {
  return localize(problem, plan, RunSettings{.level = level}, stop);
}

/// Number of threads of one of `jobs` runs at the same time: `asked`; for 0 one within a memory
/// limit (each thread needs memory), else the share of the machine's cores.
int threadsOf(int asked, std::size_t memory_limit, int jobs = 1);

/// Bytes of a problem's data: image, ignore mask, mesh.
std::size_t inputBytes(const LocalizationProblem& problem);

}  // namespace boresight::sessions
