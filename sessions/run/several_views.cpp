// SPDX-License-Identifier: Apache-2.0
// A run of several views that are solved as one.

#include <span>
#include <utility>

#include "core/base/digest.h"
#include "core/pnp/normal_equations.h"
#include "core/views/views_localizer.h"
#include "sessions/run/stepped_run.h"
#include "sessions/trace/iteration_trace.h"
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

class SeveralViews final : public SteppedRun {
 public:
  SeveralViews(const ViewsProblem& problem, const LocalizerOptions& options,
               const std::vector<std::string>& case_ids, const RunSettings& settings);

  StepReport step(const std::stop_token&) override { return localizer_->step(); }
  int tasks() const override { return localizer_->tasks(); }
  void runTask(int task, int worker) override { localizer_->runTask(task, worker); }
  int workers() const override { return workers_; }
  void noteEdges() override;
  void noteIteration(const StepReport& report, const StageSeconds& seconds) override;
  LocalizationStatus statusOf(std::size_t view) const override;
  void finish() override;

 private:
  void begin(const LocalizerOptions& options, const std::vector<std::string>& case_ids);
  void refuseAll(Status status);
  void describeViews();
  IterationTrace traceOf(std::size_t view, Stage reached) const;
  IterationTrace leftOut(std::size_t view) const;
  void finish(std::size_t view);

  ViewsProblem problem_;
  int workers_ = 1;
  RecordLevel level_ = RecordLevel::kFull;
  std::vector<Pose> camera_from_first_;
  std::unique_ptr<std::byte[]> memory_;
  std::unique_ptr<ViewsLocalizer> localizer_;
  std::size_t next_edges_ = 0;  ///< the view whose test edges come next
};

SeveralViews::SeveralViews(const ViewsProblem& problem, const LocalizerOptions& options,
                           const std::vector<std::string>& case_ids, const RunSettings& settings)
    : problem_(problem), workers_(settings.threads), level_(settings.level) {
  traces.resize(problem.views.size());
  begin(options, case_ids);
  std::size_t bytes = 0;
  const Status sized =
      ViewsLocalizer::requiredBytes(problem_, options, workers_, settings.kernels, bytes);
  if (sized != Status::kOk) {
    refuseAll(sized);
    return;
  }
  memory_ = std::make_unique_for_overwrite<std::byte[]>(bytes);
  localizer_ = std::make_unique<ViewsLocalizer>(
      problem_, options, std::span<std::byte>(memory_.get(), bytes), workers_, settings.kernels);
  if (localizer_->status() == Status::kOk)
    describeViews();
  else
    refuseAll(localizer_->status());
}

void SeveralViews::begin(const LocalizerOptions& options,
                         const std::vector<std::string>& case_ids) {
  std::vector<ViewOutcome> views;
  for (const std::string& id : case_ids)
    views.push_back({id, localizationStatusText(LocalizationStatus::kRunning)});
  const Pose first_from_rig = problem_.views.front().camera_from_rig;
  for (std::size_t v = 0; v < traces.size(); ++v) {
    const View& view = problem_.views[v];
    camera_from_first_.push_back(view.camera_from_rig * first_from_rig.inverse());
    LocalizationTrace& trace = traces[v];
    trace.version = kVersion;
    trace.options = options;
    trace.camera = view.camera;
    trace.camera_from_station_seed = view.camera_from_rig * problem_.rig_from_station_seed;
    trace.camera_from_station = trace.camera_from_station_seed;
    trace.uncertainty = problem_.uncertainty;
    trace.views = views;
    trace.own_view = v;
  }
}

void SeveralViews::refuseAll(Status status) {
  joint.result.status = LocalizationStatus::kFault;
  joint.result.fault = status;
  for (LocalizationTrace& trace : traces) {
    refuse(trace, status);
    for (ViewOutcome& view : trace.views) view.status = localizationStatusText(trace.status);
  }
}

/// As the core has their seeds, to the bit.
void SeveralViews::describeViews() {
  for (std::size_t v = 0; v < traces.size(); ++v) {
    const Pass& of_view = localizer_->view(static_cast<int>(v));
    LocalizationTrace& trace = traces[v];
    trace.camera_from_station_seed = of_view.problem().camera_from_station_seed;
    trace.camera_from_station = trace.camera_from_station_seed;
    trace.memory.inputs = inputBytes(of_view.problem());
    trace.memory.use = of_view.memory().use();
  }
}

/// Views come to their edges in their order: each does all that it can alone before the next. They
/// are copied at once, as the first render takes the finer levels' place.
void SeveralViews::noteEdges() {
  const std::size_t v = next_edges_++;
  if (v >= traces.size()) return;
  traces[v].edges = std::make_shared<const EdgeMapTrace>(
      recordEdgeMap(localizer_->view(static_cast<int>(v)).workspace().edges, level_));
}

/// A fault may come before the first iteration, or before the localizers are there.
void SeveralViews::noteIteration(const StepReport& report, const StageSeconds& seconds) {
  if (!report.iteration_complete) return;
  if (localizer_->iterationOf(0) == nullptr) return;
  for (std::size_t v = 0; v < traces.size(); ++v) {
    IterationTrace iteration = traceOf(v, report.stage);
    LocalizationTrace& trace = traces[v];
    const bool followed = localizer_->iterationOf(static_cast<int>(v)) != nullptr;
    if (v > 0 && followed && trace.iterations.empty()) trace.uncertainty = iteration.uncertainty;
    iteration.seconds = seconds;
    trace.iterations.push_back(std::make_shared<const IterationTrace>(std::move(iteration)));
  }
}

IterationTrace SeveralViews::traceOf(std::size_t view, Stage reached) const {
  const Iteration& leading = *localizer_->iterationOf(0);
  const Iteration* own = localizer_->iterationOf(static_cast<int>(view));
  IterationTrace iteration =
      own != nullptr ? recordIteration(*own, reached, level_) : leftOut(view);
  iteration.status = statusOf(view);
  if (view == 0) return iteration;
  if (!hasPose(leading, reached)) return iteration;
  // What the next iteration begins from, and what the loop decides by: in the first view's camera.
  iteration.camera_from_station = camera_from_first_[view] * leading.camera_from_station;
  iteration.correction_translation_m = leading.correction_translation_m;
  iteration.correction_rotation_rad = leading.correction_rotation_rad;
  iteration.correction_image_px = leading.correction_image_px;
  return iteration;
}

/// For a view that takes no part: the pose of the others alone.
IterationTrace SeveralViews::leftOut(std::size_t view) const {
  const Iteration& leading = *localizer_->iterationOf(0);
  IterationTrace iteration;
  iteration.index = leading.index;
  iteration.attempt = leading.attempt;
  iteration.kind = leading.kind;
  iteration.level = leading.level;
  iteration.threshold_px = leading.threshold_px;
  iteration.camera_from_station_before =
      camera_from_first_[view] * leading.camera_from_station_before;
  iteration.camera_from_station = iteration.camera_from_station_before;
  return iteration;
}

/// Why the view takes no part in the iteration; else how the iteration ended.
LocalizationStatus SeveralViews::statusOf(std::size_t view) const {
  const LocalizationStatus own = localizer_->result().views[view].status;
  return isLeftOut(own) ? own : localizer_->iterationOf(0)->status;
}

void SeveralViews::finish() {
  const ViewsResult& result = localizer_->result();
  joint = {result, hexText(localizer_->digest()).data()};
  if (result.status == LocalizationStatus::kFault) refuseAll(result.fault);
  for (std::size_t v = 0; v < traces.size(); ++v) finish(v);
}

void SeveralViews::finish(std::size_t view) {
  const ViewsResult& result = localizer_->result();
  const ViewReport& report = result.views[view];
  LocalizationTrace& trace = traces[view];
  trace.finished = true;
  trace.attempts = result.attempts;
  trace.digest = viewDigest(*localizer_, view);
  if (result.status == LocalizationStatus::kFault) return;
  const Pass& of_view = localizer_->view(static_cast<int>(view));
  trace.status = report.status;
  const Workspace& seen = of_view.workspace();
  trace.candidates.assign(seen.candidates.begin(), seen.candidates.end());
  trace.support = report.support;
  trace.evidence = seen.evidence;
  trace.probability = report.probability;
  trace.edge_width = seen.edge_width;
  trace.focal = seen.focal;
  trace.arena_bytes = of_view.memory().highWaterBytes();
  recordHypotheses(localizer_->view(0).workspace(), trace);
  for (PoseHypothesis& hypothesis : trace.hypotheses)
    hypothesis.camera_from_station = camera_from_first_[view] * hypothesis.camera_from_station;
  trace.competing_poses.clear();
  for (CompetingPose pose : result.competing_poses.items()) {
    pose.camera_from_station = problem_.views[view].camera_from_rig * pose.camera_from_station;
    trace.competing_poses.push_back(pose);
  }
  for (std::size_t v = 0; v < trace.views.size(); ++v)
    trace.views[v].status = localizationStatusText(result.views[v].status);
  if (!report.tookPart()) return;
  trace.camera_from_station = report.camera_from_station;
  const Matrix6d& of_first = localizer_->view(0).workspace().covariance;
  const Matrix6d moved = adjointOf(camera_from_first_[view]);
  trace.covariance = view == 0 ? of_first : Matrix6d(moved * of_first * moved.transpose());
}

}  // namespace

std::unique_ptr<SteppedRun> stepSeveralViews(const ViewsProblem& problem,
                                             const LocalizerOptions& options,
                                             const std::vector<std::string>& case_ids,
                                             const RunSettings& settings) {
  return std::make_unique<SeveralViews>(problem, options, case_ids, settings);
}

}  // namespace boresight::sessions
