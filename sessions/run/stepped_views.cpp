// SPDX-License-Identifier: Apache-2.0
#include "sessions/run/stepped_views.h"

#include <utility>

#include "core/base/digest.h"
#include "core/pnp/normal_equations.h"
#include "sessions/run/record.h"
#include "sessions/version.h"

namespace boresight::sessions {
namespace {

/// Two runs are of the same views when all of it is the same, and no run of one view has it.
std::string viewDigest(const ViewsLocalizer& localizer, std::size_t view) {
  DigestWriter writer;
  writer.tag("view of several");
  writer.bytes(localizer.digest());
  writer.u32(static_cast<std::uint32_t>(view));
  return hexText(writer.digest()).data();
}

bool isLeftOut(LocalizationStatus status) {
  return status != LocalizationStatus::kRunning && status != LocalizationStatus::kConverged;
}

}  // namespace

SteppedViews::SteppedViews(const ViewsProblem& problem, const LocalizerOptions& options,
                           const std::vector<std::string>& case_ids)
    : problem_(problem), snapshots_(problem.views.size()) {
  const Clock::time_point start = Clock::now();
  begin(options, case_ids);
  const Kernels kernels = bestKernels();
  std::size_t bytes = 0;
  const Status sized = ViewsLocalizer::requiredBytes(problem_, options, kernels, bytes);
  if (sized != Status::kOk) {
    refuse(sized);
    return;
  }
  memory_ = std::make_unique_for_overwrite<std::byte[]>(bytes);
  localizer_ = std::make_unique<ViewsLocalizer>(
      problem_, options, std::span<std::byte>(memory_.get(), bytes), kernels);
  if (localizer_->status() == Status::kOk)
    describeViews();
  else
    refuse(localizer_->status());
  const double seconds = std::chrono::duration<double>(Clock::now() - start).count();
  for (RunSnapshot& one : snapshots_) one.seconds.initialization = seconds;
}

void SteppedViews::begin(const LocalizerOptions& options,
                         const std::vector<std::string>& case_ids) {
  std::vector<ViewOutcome> views;
  for (const std::string& id : case_ids)
    views.push_back({id, localizationStatusText(LocalizationStatus::kRunning)});
  const Pose first_from_rig = problem_.views.front().camera_from_rig;
  for (std::size_t v = 0; v < snapshots_.size(); ++v) {
    const View& view = problem_.views[v];
    camera_from_first_.push_back(view.camera_from_rig * first_from_rig.inverse());
    RunSnapshot& one = snapshots_[v];
    one.version = kVersion;
    one.options = options;
    one.camera = view.camera;
    one.camera_from_station_seed = view.camera_from_rig * problem_.rig_from_station_seed;
    one.camera_from_station = one.camera_from_station_seed;
    one.uncertainty = problem_.uncertainty;
    one.views = views;
    one.own_view = v;
  }
}

void SteppedViews::refuse(Status status) {
  for (RunSnapshot& one : snapshots_) {
    one.status = LocalizationStatus::kFault;
    one.fault = status;
    one.finished = true;
    for (ViewOutcome& view : one.views) view.status = localizationStatusText(one.status);
  }
}

/// As the core has their seeds, to the bit.
void SteppedViews::describeViews() {
  for (std::size_t v = 0; v < snapshots_.size(); ++v) {
    const Pass& of_view = localizer_->view(static_cast<int>(v));
    RunSnapshot& one = snapshots_[v];
    one.camera_from_station_seed = of_view.problem().camera_from_station_seed;
    one.camera_from_station = one.camera_from_station_seed;
    one.memory.inputs = inputBytes(of_view.problem());
    one.memory.use = of_view.memory().use();
  }
}

void SteppedViews::advance(StepUntil until, const std::stop_token& stop) {
  while (!finished() && !stop.stop_requested()) {
    const Clock::time_point start = Clock::now();
    const StepReport report = localizer_->step();
    note(report, std::chrono::duration<double>(Clock::now() - start).count());
    if (until != StepUntil::kEnd && report.iteration_complete) return;
  }
}

void SteppedViews::note(const StepReport& report, double seconds) {
  for (RunSnapshot& one : snapshots_) {
    one.stage = report.stage;
    one.seconds.add(report.stage, seconds);
  }
  if (report.stage != Stage::kEdges)
    iteration_seconds_.add(report.stage, seconds);
  else if (report.stage_complete)
    noteEdges();
  if (report.iteration_complete)
    noteIteration(report.stage);
  else if (report.stage == Stage::kSupport && report.stage_complete)
    judgeIteration();
  if (report.finished) finish();
}

/// Views come to their edges in their order: each does all that it can alone before the next. They
/// are copied at once, as the first render takes the finer levels' place.
void SteppedViews::noteEdges() {
  const std::size_t v = next_edges_++;
  if (v >= snapshots_.size()) return;
  snapshots_[v].edges = std::make_shared<const EdgeMapTrace>(
      recordEdgeMap(localizer_->view(static_cast<int>(v)).workspace().edges));
}

/// A fault may come before the first iteration, or before the localizers are there.
void SteppedViews::noteIteration(Stage reached) {
  if (localizer_->iterationOf(0) == nullptr) return;
  for (std::size_t v = 0; v < snapshots_.size(); ++v) {
    IterationTrace made = traceOf(v, reached);
    RunSnapshot& one = snapshots_[v];
    const bool followed = localizer_->iterationOf(static_cast<int>(v)) != nullptr;
    if (v > 0 && followed && one.iterations.empty()) one.uncertainty = made.uncertainty;
    made.seconds = iteration_seconds_;
    one.iterations.push_back(std::make_shared<const IterationTrace>(std::move(made)));
  }
  iteration_seconds_ = {};
}

IterationTrace SteppedViews::traceOf(std::size_t view, Stage reached) const {
  const Iteration& leading = *localizer_->iterationOf(0);
  const Iteration* own = localizer_->iterationOf(static_cast<int>(view));
  IterationTrace made =
      own != nullptr ? recordIteration(*own, reached, RecordLevel::kFull) : leftOut(view);
  made.status = statusOf(view);
  if (view == 0) return made;
  if (!hasPose(leading, reached)) return made;
  // What the next iteration begins from, and what the loop decides by: in the first view's camera.
  made.camera_from_station = camera_from_first_[view] * leading.camera_from_station;
  made.correction_translation_m = leading.correction_translation_m;
  made.correction_rotation_rad = leading.correction_rotation_rad;
  made.correction_image_px = leading.correction_image_px;
  return made;
}

/// Of a view that was not asked: the pose of the others alone.
IterationTrace SteppedViews::leftOut(std::size_t view) const {
  const Iteration& leading = *localizer_->iterationOf(0);
  IterationTrace made;
  made.index = leading.index;
  made.attempt = leading.attempt;
  made.kind = leading.kind;
  made.level = leading.level;
  made.threshold_px = leading.threshold_px;
  made.camera_from_station_before = camera_from_first_[view] * leading.camera_from_station_before;
  made.camera_from_station = made.camera_from_station_before;
  return made;
}

/// Why the view has no say in the iteration; else how that ended.
LocalizationStatus SteppedViews::statusOf(std::size_t view) const {
  const LocalizationStatus own = localizer_->result().views[view].status;
  return isLeftOut(own) ? own : localizer_->iterationOf(0)->status;
}

/// Edge support is looked at after the last iteration was complete, and may change how it ended.
void SteppedViews::judgeIteration() {
  for (std::size_t v = 0; v < snapshots_.size(); ++v) {
    auto& iterations = snapshots_[v].iterations;
    if (iterations.empty()) return;
    IterationTrace judged = *iterations.back();
    judged.status = statusOf(v);
    judged.seconds += iteration_seconds_;
    iterations.back() = std::make_shared<const IterationTrace>(std::move(judged));
  }
  iteration_seconds_ = {};
}

void SteppedViews::finish() {
  const ViewsResult& result = localizer_->result();
  if (result.status == LocalizationStatus::kFault) refuse(result.fault);
  for (std::size_t v = 0; v < snapshots_.size(); ++v) finish(v);
}

void SteppedViews::finish(std::size_t view) {
  const ViewsResult& result = localizer_->result();
  const ViewReport& report = result.views[view];
  RunSnapshot& one = snapshots_[view];
  one.finished = true;
  one.attempts = result.attempts;
  one.digest = viewDigest(*localizer_, view);
  if (result.status == LocalizationStatus::kFault) return;
  const Pass& of_view = localizer_->view(static_cast<int>(view));
  one.status = report.status;
  one.support = report.support;
  one.arena_bytes = of_view.memory().highWaterBytes();
  for (std::size_t v = 0; v < one.views.size(); ++v)
    one.views[v].status = localizationStatusText(result.views[v].status);
  if (!report.tookPart()) return;
  one.partial = of_view.workspace().partial;
  one.camera_from_station = report.camera_from_station;
  const Matrix6d& of_first = localizer_->view(0).workspace().covariance;
  const Matrix6d moved = adjointOf(camera_from_first_[view]);
  one.covariance = view == 0 ? of_first : Matrix6d(moved * of_first * moved.transpose());
}

}  // namespace boresight::sessions
