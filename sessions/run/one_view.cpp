// SPDX-License-Identifier: Apache-2.0
// A run of one localizer.
#include <optional>
#include <span>
#include <utility>

#include "sessions/run/matching_method.h"
#include "sessions/run/problem.h"
#include "sessions/run/stepped_run.h"
#include "sessions/trace/iteration_trace.h"
#include "sessions/version.h"

namespace boresight::sessions {
namespace {

/// kOk when the run can begin; fills the trace's use of memory.
Status sizeRun(const LocalizationProblem& problem, const RunPlan& plan, const RunSettings& settings,
               MemoryTrace& memory) {
  const Status sized =
      requiredMemory(sizeOf(problem), plan.options, settings.threads, memory.use, settings.kernels);
  if (sized != Status::kOk) return sized;
  if (memory.limit > 0 && memory.total() > memory.limit) return Status::kArenaTooSmall;
  return planProblem(plan).empty() ? Status::kOk : Status::kInvalidOption;
}

class OneView final : public SteppedRun {
 public:
  OneView(const LocalizationProblem& problem, const RunPlan& plan, const RunSettings& settings)
      : settings_(settings), plan_(plan), changes_({}) {
    begin(problem);
  }

  void restart(const LocalizationProblem& problem) override {
    traces.clear();
    outside_.reset();
    begin(problem);
  }

  StepReport step(const std::stop_token& stop) override {
    if (settings_.method != nullptr && !outside_)
      outside_.emplace(*localizer_, *settings_.method, settings_.albedo_of_part, stop);
    RecordWriter* onboard = settings_.onboard_record;
    if (changes_.takeUp(*localizer_, traces.front().complete()) && onboard != nullptr)
      onboard->changeOptions(localizer_->options(), localizer_->workspace().iterations);
    if (outside_) outside_->serve();
    const StepReport report = localizer_->step();
    if (onboard != nullptr) onboard->note(*localizer_, report);
    return report;
  }

  int tasks() const override { return localizer_->tasks(); }
  void runTask(int task, int worker) override { localizer_->runTask(task, worker); }
  int workers() const override { return settings_.threads; }

  void noteEdges() override {
    traces.front().edges = std::make_shared<const EdgeMapTrace>(
        recordEdgeMap(localizer_->workspace().edges, settings_.level));
  }

  void noteIteration(const StepReport& report, const StageSeconds& seconds) override {
    const Iteration* iteration = localizer_->workspace().iteration;
    const bool complete = report.iteration_complete;
    if (iteration == nullptr || (!complete && settings_.level != RecordLevel::kStages)) return;
    LocalizationTrace& trace = traces.front();
    IterationTrace recorded = recordIteration(*iteration, report.stage, settings_.level);
    recorded.seconds = seconds;
    if (trace.last_under_way) trace.iterations.pop_back();
    trace.iterations.push_back(std::make_shared<const IterationTrace>(std::move(recorded)));
    trace.last_under_way = !complete;
  }

  void noteSearch() override {
    const auto candidates = localizer_->workspace().candidates;
    traces.front().candidates.assign(candidates.begin(), candidates.end());
  }

  LocalizationStatus statusOf(std::size_t) const override {
    return localizer_->workspace().iteration->status;
  }

  void finish() override {
    if (settings_.onboard_record != nullptr) settings_.onboard_record->end(*localizer_);
    LocalizationTrace& trace = traces.front();
    const Workspace& workspace = localizer_->workspace();
    if (!trace.edges) noteEdges();
    trace.finished = true;
    trace.support = workspace.support;
    trace.evidence = workspace.evidence;
    trace.probability = workspace.probability;
    trace.edge_width = workspace.edge_width;
    trace.focal = workspace.focal;
    if (trace.candidates.empty()) noteSearch();
    trace.attempts = workspace.attempts;
    recordHypotheses(workspace, trace);
    trace.competing_poses.assign(workspace.competing_poses.begin(),
                                 workspace.competing_poses.end());
    trace.status = workspace.status;
    trace.fault = workspace.fault;
    trace.camera_from_station = workspace.camera_from_station;
    trace.covariance = workspace.covariance;
    trace.digest = hexText(localizer_->digest()).data();
    trace.arena_bytes = localizer_->highWaterBytes();
  }

 private:
  void begin(const LocalizationProblem& problem) {
    LocalizationTrace& trace = traces.emplace_back();
    trace.version = kVersion;
    trace.options = plan_.options;
    trace.changes = plan_.changes;
    trace.camera = problem.camera;
    trace.camera_from_station_seed = problem.camera_from_station_seed;
    trace.camera_from_station = problem.camera_from_station_seed;
    trace.uncertainty = problem.uncertainty;
    trace.memory.inputs = inputBytes(problem);
    trace.memory.limit = settings_.memory_limit;
    Status status = sizeRun(problem, plan_, settings_, trace.memory);
    if (status == Status::kOk) status = placeLocalizer(problem, trace.memory);
    if (status != Status::kOk) return refuse(trace, status);
    changes_ = PlannedChanges(plan_.changes);
    if (settings_.onboard_record != nullptr)
      settings_.onboard_record->begin(recordInputs(withoutUnusedInputs(problem, plan_.options)),
                                      problem, plan_.options);
  }

  /// In the memory of the last problem, where it suffices.
  Status placeLocalizer(const LocalizationProblem& problem, const MemoryTrace& memory) {
    const std::size_t bytes = memory.limit > 0 ? memory.limit - memory.inputs : memory.use.total();
    if (localizer_ && bytes <= memory_bytes_) return localizer_->restart(problem, plan_.options);
    localizer_.reset();
    memory_ = std::make_unique_for_overwrite<std::byte[]>(bytes);
    memory_bytes_ = bytes;
    localizer_ = std::make_unique<Localizer>(problem, plan_.options,
                                             std::span<std::byte>(memory_.get(), bytes),
                                             settings_.threads, settings_.kernels);
    return Status::kOk;
  }

  RunSettings settings_;
  RunPlan plan_;
  PlannedChanges changes_;
  std::unique_ptr<std::byte[]> memory_;
  std::size_t memory_bytes_ = 0;
  std::unique_ptr<Localizer> localizer_;
  std::optional<OutsideMatching> outside_;
};

}  // namespace

std::unique_ptr<SteppedRun> stepOneView(const LocalizationProblem& problem, const RunPlan& plan,
                                        const RunSettings& settings) {
  return std::make_unique<OneView>(problem, plan, settings);
}

}  // namespace boresight::sessions
