// SPDX-License-Identifier: Apache-2.0
#include "sessions/run/stepped_run.h"

#include "sessions/run/record.h"
#include "sessions/version.h"

namespace boresight::sessions {

SteppedRun::SteppedRun(const LocalizationProblem& problem, const RunPlan& plan)
    : changes_(plan.changes) {
  const LocalizerOptions& options = plan.options;
  const Clock::time_point start = Clock::now();
  snapshot_.version = kVersion;
  snapshot_.options = options;
  snapshot_.changes = plan.changes;
  snapshot_.camera = problem.camera;
  snapshot_.camera_from_station_seed = problem.camera_from_station_seed;
  snapshot_.camera_from_station = problem.camera_from_station_seed;
  snapshot_.uncertainty = problem.uncertainty;
  snapshot_.memory.inputs = inputBytes(problem);
  const Kernels kernels = bestKernels();
  Status sized = requiredMemory(sizeOf(problem), options, 1, snapshot_.memory.use, kernels);
  if (sized == Status::kOk && !planProblem(plan).empty()) sized = Status::kInvalidOption;
  if (sized != Status::kOk) {
    snapshot_.status = LocalizationStatus::kFault;
    snapshot_.fault = sized;
    snapshot_.finished = true;
    return;
  }
  const std::size_t bytes = snapshot_.memory.use.total();
  memory_ = std::make_unique_for_overwrite<std::byte[]>(bytes);
  localizer_ = std::make_unique<Localizer>(problem, options,
                                           std::span<std::byte>(memory_.get(), bytes), 1, kernels);
  snapshot_.seconds.initialization = std::chrono::duration<double>(Clock::now() - start).count();
}

void SteppedRun::advance(StepUntil until, const std::stop_token& stop) {
  while (!snapshot_.finished && !stop.stop_requested()) {
    changes_.takeUp(*localizer_, complete());
    const Clock::time_point start = Clock::now();
    const StepReport report = localizer_->step();
    note(report, std::chrono::duration<double>(Clock::now() - start).count());
    if (until == StepUntil::kStage && report.stage_complete) return;
    if (until == StepUntil::kIteration && report.iteration_complete) return;
  }
}

void SteppedRun::note(const StepReport& report, double seconds) {
  snapshot_.stage = report.stage;
  snapshot_.seconds.add(report.stage, seconds);
  if (report.stage != Stage::kEdges) iteration_seconds_.add(report.stage, seconds);
  if (report.stage == Stage::kEdges && report.stage_complete) {
    snapshot_.edges =
        std::make_shared<const EdgeMapTrace>(recordEdgeMap(localizer_->workspace().edges));
  }
  if (report.stage != Stage::kEdges && (report.stage_complete || report.iteration_complete))
    noteIteration(report);
  if (report.finished) finish();
}

void SteppedRun::noteIteration(const StepReport& report) {
  const Iteration* iteration = localizer_->workspace().iteration;
  if (iteration == nullptr) return;
  if (report.stage == Stage::kSupport) {
    // The gate judges the last iteration after it was complete, and may change how it ended.
    if (snapshot_.iterations.empty()) return;
    IterationTrace judged = *snapshot_.iterations.back();
    judged.status = iteration->status;
    judged.seconds += iteration_seconds_;
    iteration_seconds_ = {};
    snapshot_.iterations.back() = std::make_shared<const IterationTrace>(std::move(judged));
    return;
  }
  IterationTrace trace = recordIteration(*iteration, report.stage, RecordLevel::kFull);
  trace.seconds = iteration_seconds_;
  if (snapshot_.last_under_way) snapshot_.iterations.pop_back();
  snapshot_.iterations.push_back(std::make_shared<const IterationTrace>(std::move(trace)));
  snapshot_.last_under_way = !report.iteration_complete;
  if (report.iteration_complete) iteration_seconds_ = {};
}

void SteppedRun::finish() {
  const Workspace& workspace = localizer_->workspace();
  snapshot_.finished = true;
  snapshot_.support = workspace.support;
  snapshot_.partial = workspace.partial;
  snapshot_.attempts = workspace.attempts;
  snapshot_.rivals.assign(workspace.rivals.begin(), workspace.rivals.end());
  snapshot_.status = workspace.status;
  snapshot_.fault = workspace.fault;
  snapshot_.camera_from_station = workspace.camera_from_station;
  snapshot_.covariance = workspace.covariance;
  snapshot_.digest = hexText(localizer_->digest()).data();
  snapshot_.arena_bytes = localizer_->highWaterBytes();
}

}  // namespace boresight::sessions
