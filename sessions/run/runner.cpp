// SPDX-License-Identifier: Apache-2.0
#include "sessions/run/runner.h"

#include <algorithm>
#include <chrono>
#include <stdexcept>
#include <thread>

#include "sessions/log/program_log.h"
#include "sessions/run/stepped_run.h"
#include "sessions/run/worker_pool.h"
#include "sessions/text/text_table.h"

namespace boresight::sessions {
namespace {

using Clock = std::chrono::steady_clock;

double secondsSince(Clock::time_point start) {
  return std::chrono::duration<double>(Clock::now() - start).count();
}

void logEnds(const std::vector<LocalizationTrace>& traces) {
  for (const LocalizationTrace& trace : traces)
    logEvent(LogLevel::kInfo, [&trace] {
      return std::string("run ends: ") + localizationStatusText(trace.status) + ", " +
             std::to_string(trace.iterations.size()) + " iterations, " +
             fixedText(trace.seconds.total(), 3) + " s, digest " + trace.digest;
    });
}

/// A run that cannot begin ends at once.
void logBeginning(const ImageView& image, const MeshView& mesh,
                  const std::vector<LocalizationTrace>& traces) {
  logEvent(LogLevel::kInfo, [&] {
    return "run begins: version " + traces.front().version + ", " + std::to_string(traces.size()) +
           " image of " + std::to_string(image.width) + " x " + std::to_string(image.height) +
           " px, mesh of " + std::to_string(mesh.faces.size()) + " faces";
  });
  if (traces.front().finished) logEnds(traces);
}

RunSettings resolved(RunSettings settings) {
  settings.threads = threadsOf(settings.threads, settings.memory_limit);
  if (settings.memory_limit > 0) settings.kernels = Kernels::kPortable;
  return settings;
}

}  // namespace

int threadsOf(int asked, std::size_t memory_limit, int jobs) {
  if (asked > 0) return std::min(asked, Localizer::kMaxWorkers);
  if (memory_limit > 0) return 1;
  const int cores = static_cast<int>(std::thread::hardware_concurrency());
  return std::clamp(cores / std::max(1, jobs), 1, Localizer::kMaxWorkers);
}

std::size_t inputBytes(const LocalizationProblem& problem) {
  const ImageView& image = problem.image;
  const MeshView& mesh = problem.mesh;
  const std::size_t channels = problem.color.data != nullptr ? 1 + ColorView::kChannels : 1;
  return channels * static_cast<std::size_t>(image.width) * static_cast<std::size_t>(image.height) +
         (problem.ignore != nullptr ? problem.ignore->words.size_bytes() : 0) +
         mesh.vertices_in_station_m.size_bytes() +
         mesh.faces.size() * bytesPerFace(mesh.vertices_in_station_m.size()) +
         mesh.part_of_face.size_bytes() + mesh.parts.size_bytes();
}

Runner::Runner(const LocalizationProblem& problem, const RunPlan& plan,
               const RunSettings& settings) {
  const Clock::time_point start = Clock::now();
  stepped_ = stepOneView(problem, plan, resolved(settings));
  stepped_->traces.front().seconds.initialization = secondsSince(start);
  logBeginning(problem.image, problem.mesh, traces());
}

Runner::Runner(const ViewsProblem& problem, const LocalizerOptions& options,
               const std::vector<std::string>& case_ids, const RunSettings& settings) {
  const Clock::time_point start = Clock::now();
  stepped_ = stepSeveralViews(problem, options, case_ids, resolved(settings));
  const double seconds = secondsSince(start);
  for (LocalizationTrace& trace : stepped_->traces) trace.seconds.initialization = seconds;
  logBeginning(problem.views.front().image, problem.views.front().mesh, traces());
}

Runner::~Runner() {
  if (!stepped_->traces.front().finished)
    logEvent(LogLevel::kInfo, [] { return std::string("run stopped before its end"); });
}

void Runner::restart(const LocalizationProblem& problem) {
  const Clock::time_point start = Clock::now();
  iteration_seconds_ = {};
  stepped_->restart(problem);
  stepped_->traces.front().seconds.initialization = secondsSince(start);
  logBeginning(problem.image, problem.mesh, traces());
}

const std::vector<LocalizationTrace>& Runner::traces() const { return stepped_->traces; }

const JointResult& Runner::joint() const { return stepped_->joint; }

void Runner::advance(StepUntil until, const std::stop_token& stop) {
  if (finished()) return;
  if (!pool_) pool_ = std::make_unique<WorkerPool>(stepped_->workers());
  if (until == StepUntil::kStage && traces().size() > 1) until = StepUntil::kIteration;
  while (!finished() && !stop.stop_requested()) {
    const StepReport report = step(stop);
    if (until == StepUntil::kStage && report.stage_complete) return;
    if (until == StepUntil::kIteration && report.iteration_complete) return;
  }
}

/// One slice, by all threads; nothing is reported of one that was stopped on the way.
StepReport Runner::step(const std::stop_token& stop) {
  const Clock::time_point start = Clock::now();
  if (pool_->workers() > 1 && stepped_->tasks() > 1) {
    pool_->run(
        stepped_->tasks(), [this](int task, int worker) { stepped_->runTask(task, worker); }, stop);
    if (stop.stop_requested()) return StepReport::of(trace().stage, false);
  }
  const StepReport report = stepped_->step(stop);
  note(report, secondsSince(start));
  return report;
}

void Runner::note(const StepReport& report, double seconds) {
  for (LocalizationTrace& trace : stepped_->traces) {
    trace.stage = report.stage;
    trace.seconds.add(report.stage, seconds);
  }
  const bool first = report.stage == Stage::kEdges || report.stage == Stage::kSearch;
  if (!first) iteration_seconds_.add(report.stage, seconds);
  const bool support = report.stage == Stage::kSupport && !report.iteration_complete;
  if (report.stage == Stage::kEdges && report.stage_complete) {
    stepped_->noteEdges();
  } else if (report.stage == Stage::kSearch) {
    if (report.stage_complete) stepped_->noteSearch();
  } else if (support && report.stage_complete) {
    stepped_->noteSupport(iteration_seconds_);
    iteration_seconds_ = {};
  } else if (report.stage != Stage::kEdges && !support &&
             (report.stage_complete || report.iteration_complete)) {
    stepped_->noteIteration(report, iteration_seconds_);
    if (report.iteration_complete) iteration_seconds_ = {};
  }
  if (!report.finished) return;
  stepped_->finish();
  logEnds(stepped_->traces);
}

void SteppedRun::restart(const LocalizationProblem&) {
  throw std::logic_error("several views cannot restart");
}

void SteppedRun::noteSupport(const StageSeconds& seconds) {
  for (std::size_t v = 0; v < traces.size(); ++v) {
    auto& iterations = traces[v].iterations;
    if (iterations.empty()) continue;
    IterationTrace judged = *iterations.back();
    judged.status = statusOf(v);
    judged.seconds += seconds;
    iterations.back() = std::make_shared<const IterationTrace>(std::move(judged));
  }
}

void refuse(LocalizationTrace& trace, Status fault) {
  trace.status = LocalizationStatus::kFault;
  trace.fault = fault;
  trace.finished = true;
}

LocalizationTrace localize(const LocalizationProblem& problem, const RunPlan& plan,
                           const RunSettings& settings, const std::stop_token& stop) {
  Runner run(problem, plan, settings);
  run.advance(StepUntil::kEnd, stop);
  return run.trace();
}

}  // namespace boresight::sessions
