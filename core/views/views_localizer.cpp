// SPDX-License-Identifier: Apache-2.0
// Order of the views, refinement, support and the end.
#include "core/views/views_localizer.h"

#include <algorithm>

#include "core/base/digest.h"
#include "core/localizer/acceptance.h"
#include "core/localizer/pose_change.h"
#include "core/localizer/run_digest.h"

namespace boresight {
namespace {

/// A rig that is the camera's own frame keeps the pose's bits.
Pose inCamera(const Pose& camera_from_rig, const Pose& rig_from_station) {
  return camera_from_rig == Pose() ? rig_from_station : camera_from_rig * rig_from_station;
}

/// The first view's box in another camera's axes, in a box; the pivot is a point of the first view.
SeedUncertainty turnedInto(const Pose& camera_from_first, const SeedUncertainty& in_first) {
  const Eigen::Matrix3d sizes = camera_from_first.matrix().cwiseAbs();
  SeedUncertainty turned;
  turned.rotation_rad = sizes * in_first.rotation_rad;
  turned.translation_m = sizes * in_first.translation_m;
  turned.pivot_in_camera_m = camera_from_first * in_first.pivot_in_camera_m;
  return turned;
}

Pose cameraFromFirst(const ViewsProblem& problem, std::size_t view) {
  return problem.views[view].camera_from_rig * problem.views[0].camera_from_rig.inverse();
}

/// The problem of one view alone.
LocalizationProblem problemOf(const ViewsProblem& problem, std::size_t index) {
  const View& view = problem.views[index];
  LocalizationProblem own;
  own.image = view.image;
  own.ignore = view.ignore;
  own.camera = view.camera;
  own.mesh = view.mesh;
  own.camera_from_station_seed = inCamera(view.camera_from_rig, problem.rig_from_station_seed);
  own.uncertainty = problem.uncertainty;
  own.end_effector_in_camera_m = problem.end_effector_in_camera_m;
  if (index > 0) {
    const Pose camera_from_first = cameraFromFirst(problem, index);
    own.uncertainty = turnedInto(camera_from_first, problem.uncertainty);
    own.end_effector_in_camera_m = camera_from_first * problem.end_effector_in_camera_m;
  }
  return own;
}

}  // namespace

Status ViewsLocalizer::validate(const ViewsProblem& problem, const LocalizerOptions& options) {
  if (problem.views.empty() || problem.views.size() > kMaxViews) return Status::kCapacityExceeded;
  if (firstInvalidOption(options) != nullptr) return Status::kInvalidOption;
  if (!isUsable(problem.rig_from_station_seed)) return Status::kInvalidPose;
  for (const View& view : problem.views)
    if (!isUsable(view.camera_from_rig)) return Status::kInvalidPose;
  return Status::kOk;
}

/// Memory in addition to the views' own blocks; only counts without `to`.
void ViewsLocalizer::layOut(const ViewsProblem& problem, const LocalizerOptions& options,
                            Arena& arena, ViewsLocalizer* to) {
  const std::size_t most = problem.views.size() * static_cast<std::size_t>(options.templates.count);
  const auto correspondences = arena.allocate<Correspondence>(most);
  const auto own_index = arena.allocate<std::int32_t>(most);
  const auto inlier = arena.allocate<std::uint8_t>(most);
  const auto residual_px = arena.allocate<double>(most);
  PnpRansac counted;
  (void)(to != nullptr ? to->ransac_ : counted).create(static_cast<int>(most), arena);
  if (to == nullptr) return;
  to->views_ = std::span(to->linked_).first(problem.views.size());
  to->correspondences_ = correspondences;
  to->own_index_ = own_index;
  to->pnp_.inlier = inlier;
  to->pnp_.residual_px = residual_px;
}

Status ViewsLocalizer::requiredBytes(const ViewsProblem& problem, const LocalizerOptions& options,
                                     int workers, Kernels kernels, std::size_t& bytes) {
  const Status status = validate(problem, options);
  if (status != Status::kOk) return status;
  Arena counter;
  layOut(problem, options, counter, nullptr);
  bytes = counter.highWater();
  for (std::size_t v = 0; v < problem.views.size(); ++v) {
    std::size_t own = 0;
    const Status sized =
        boresight::requiredBytes(sizeOf(problemOf(problem, v)), options, workers, own, kernels);
    if (sized != Status::kOk) return sized;
    bytes += (own + Arena::kAlignment - 1) / Arena::kAlignment * Arena::kAlignment;
  }
  return Status::kOk;
}

ViewsLocalizer::ViewsLocalizer(const ViewsProblem& problem, const LocalizerOptions& options,
                               std::span<std::byte> memory, int workers, Kernels kernels)
    : problem_(problem), options_(options) {
  std::size_t needed = 0;
  status_ = requiredBytes(problem, options, workers, kernels, needed);
  if (status_ == Status::kOk && memory.size() < needed) status_ = Status::kArenaTooSmall;
  result_.rig_from_station = problem.rig_from_station_seed;
  if (status_ != Status::kOk) return;
  Arena arena(memory);
  layOut(problem_, options_, arena, this);
  for (std::size_t v = 0; v < views_.size() && status_ == Status::kOk; ++v) {
    const LocalizationProblem own = problemOf(problem_, v);
    std::size_t bytes = 0;
    status_ = boresight::requiredBytes(sizeOf(own), options_, workers, bytes, kernels);
    if (status_ != Status::kOk) return;
    views_[v].camera_from_first = cameraFromFirst(problem_, v);
    status_ =
        views_[v].pass.create(own, options_, arena.allocate<std::byte>(bytes), workers, kernels);
    views_[v].pass.solveOutside();
  }
}

bool ViewsLocalizer::takesPart(std::size_t index) const {
  const Linked& view = views_[index];
  if (phase_ == Phase::kCompare || leading().kind == IterationKind::kRefine) return view.refines;
  return view.dropped_in_attempt != attempt_.index();
}

/// Whether the view runs the pass of the current plan. The first view leads: its record also holds
/// iterations without its part.
bool ViewsLocalizer::hasPass(std::size_t index) const {
  return (index == 0 && phase_ != Phase::kCompare) || takesPart(index);
}

/// The first view's plan in another view: the same hypothesis, within a box that holds the first
/// view's box.
PassPlan ViewsLocalizer::planOf(std::size_t index) const {
  const Linked& view = views_[index];
  if (index == 0 || phase_ == Phase::kAccept) return plan_;
  PassPlan plan = plan_;
  if (phase_ == Phase::kIterate) plan = attempt_.plan(view.pass.context());
  plan.camera_from_station = view.camera_from_first * plan_.camera_from_station;
  plan.rendered_from_station = view.camera_from_first * plan_.rendered_from_station;
  plan.uncertainty = turnedInto(view.camera_from_first, plan_.uncertainty);
  return plan;
}

/// Starts the next pass of the current phase.
void ViewsLocalizer::startPlan() {
  plan_ = PassPlan();
  plan_.kind = phase_ == Phase::kAccept ? PassKind::kSupport : comparison_kind_;
  plan_.record = attempt_.record();
  plan_.camera_from_station = attempt_.camera_from_station();
  if (phase_ == Phase::kIterate) plan_ = attempt_.plan(first().context());
  for (Linked& view : views_) view.has_begun = false;
}

StepReport ViewsLocalizer::step() {
  StepReport report = StepReport::end(false);
  if (finished_) return report;
  if (status_ != Status::kOk) return finishFault(0);
  for (std::size_t v = 0; v < views_.size(); ++v)
    if (!views_[v].is_prepared) return prepareView(v);
  for (std::size_t v = 0; v < views_.size(); ++v) {
    if (hasPass(v) && stepView(v, report)) return report;
  }
  switch (plan_.kind) {
    case PassKind::kMatch:
      return stepPose();
    case PassKind::kRefine:
      return stepRound();
    case PassKind::kSupport:
      return stepSupport();
    default:
      return stepCompare();
  }
}

/// The view whose pass the next step works on; none between two passes, and while views wait for
/// the pose of all.
std::optional<std::size_t> ViewsLocalizer::workingView() const {
  if (finished_ || status_ != Status::kOk) return std::nullopt;
  if (!views_.back().is_prepared) return std::nullopt;  // edges and searches have no tasks
  for (std::size_t v = 0; v < views_.size(); ++v) {
    if (!hasPass(v)) continue;
    const Linked& view = views_[v];
    if (!view.has_begun) return std::nullopt;
    if (view.pass.running() && view.pass.needs() == PassNeed::kNothing) return v;
  }
  return std::nullopt;
}

int ViewsLocalizer::tasks() const {
  const std::optional<std::size_t> working = workingView();
  return working ? views_[*working].pass.tasks() : 0;
}

void ViewsLocalizer::runTask(int task, int worker) {
  const std::optional<std::size_t> working = workingView();
  if (working) views_[*working].pass.runTask(task, worker);
}

/// The edges of a view, and its search; attempts start when the last view is ready.
StepReport ViewsLocalizer::prepareView(std::size_t index) {
  Linked& view = views_[index];
  if (!view.pass.running()) {
    PassPlan plan;
    if (view.has_edges) plan.kind = PassKind::kSearch;
    view.pass.begin(plan);
  }
  const StepReport report = view.pass.step();
  if (view.pass.running()) return report;
  if (view.pass.outcome().fault != Status::kOk) return finishFault(index);
  view.is_prepared = (view.has_edges && !view.pass.searchIsSuspended()) || !view.pass.searches();
  view.has_edges = true;
  if (views_.back().is_prepared) startAttempts();
  return report;
}

/// Starts from the candidates of all views, those with the most evidence first.
void ViewsLocalizer::startAttempts() {
  const Seed seed = seedOf(first().problem());
  std::size_t count = 0;
  for (const Linked& view : views_) {
    for (PoseCandidate candidate : view.pass.workspace().candidates) {
      candidate.camera_from_station =
          view.camera_from_first.inverse() * candidate.camera_from_station;
      std::size_t place = count++;
      for (; place > 0 && candidates_[place - 1].rank_nats() < candidate.rank_nats(); --place)
        candidates_[place] = candidates_[place - 1];
      candidates_[place] = candidate;
    }
  }
  comparison_ = PoseComparison(std::span(candidates_).first(count), seed);
  start(first().searches() ? comparison_.next(0, first().context()) : Attempt(0, seed));
}

/// Goes on with the first iteration of an attempt, in all views.
void ViewsLocalizer::start(const Attempt& attempt) {
  attempt_ = attempt;
  phase_ = Phase::kIterate;
  first().workspace().attempts = attempt_.index() + 1;
  latest_ = Shares();
  for (Linked& view : views_) view.refines = true;
  startPlan();
}

/// False when the view waits for the others.
bool ViewsLocalizer::stepView(std::size_t index, StepReport& report) {
  Linked& view = views_[index];
  Pass& pass = view.pass;
  if (!view.has_begun) {
    pass.workspace().iterations = first().workspace().iterations;
    pass.workspace().attempts = attempt_.index() + 1;
    pass.begin(planOf(index));
    view.has_begun = true;
  }
  if (!pass.running() || pass.needs() != PassNeed::kNothing) return false;
  report = pass.step();
  if (!pass.running() && pass.outcome().fault != Status::kOk) report = finishFault(index);
  return true;
}

/// A capacity or memory fault of one view ends the run.
StepReport ViewsLocalizer::finishFault(std::size_t index) {
  const bool ran = status_ == Status::kOk;
  result_.status = LocalizationStatus::kFault;
  result_.fault = ran ? view(static_cast<int>(index)).workspace().fault : status_;
  if (index < views_.size()) result_.views[index].status = LocalizationStatus::kFault;
  if (ran) {
    Pass& pass = views_[index].pass;
    pass.show({Ruling::Next::kFailed, LocalizationStatus::kFault, pass.outcome().reached, true,
               pass.plan().record});
    pass.finish(LocalizationStatus::kFault, Pose(), Matrix6d::Zero());
  }
  finished_ = true;
  return StepReport::end(true);
}

/// Acts on the attempt's ruling, or on the support of all views.
StepReport ViewsLocalizer::decide(const Ruling& ruling) {
  first().show(ruling);
  StepReport report = StepReport::of(ruling.stage, true);
  report.iteration_complete = ruling.iteration_complete;
  const bool known =
      first().searches() && phase_ == Phase::kIterate && leading().kind == IterationKind::kRefine &&
      ruling.iteration_complete &&
      comparison_.isKnown(attempt_.camera_from_station(), leading().level, first().context());
  if (ruling.failed() || known) {
    report = retry(ruling.status, report);
  } else if (ruling.found() && phase_ == Phase::kAccept) {
    report = takePose(report);
  } else {
    phase_ = ruling.found() ? Phase::kAccept : Phase::kIterate;
    startPlan();
  }
  result_.iterations = first().workspace().iterations;
  result_.attempts = first().workspace().attempts;
  if (report.iteration_complete) noteViews();
  if (report.finished) finishResult();
  return report;
}

/// After a failure: the next candidate, another attempt, or the end.
StepReport ViewsLocalizer::retry(LocalizationStatus status, const StepReport& report) {
  const RunContext run = first().context();
  if (first().searches()) return follow(comparison_.takeFailure(run), status, report);
  if (attempt_.index() + 1 >= options_.loop.max_attempts) return finish(status, report);
  attempt_.restart();
  first().workspace().attempts = attempt_.index() + 1;
  phase_ = Phase::kIterate;
  startPlan();
  return report;
}

/// A pose that views support: its score is of their evidence together, its probability that of the
/// view that supports it best.
StepReport ViewsLocalizer::takePose(const StepReport& report) {
  LocalizationStatus status = LocalizationStatus::kConverged;
  if (!first().searches()) return finish(status, report);
  PoseHypothesis measured;
  measured.evidence = first().workspace().evidence;
  double total_nats = 0.0;
  double support = 0.0;
  int refining = 0;
  for (std::size_t v = 0; v < views_.size(); ++v) {
    if (views_[v].refines) {
      const PoseEvidence& evidence = views_[v].pass.workspace().evidence;
      total_nats += evidence.total_nats();
      support += evidence.edge_support;
      ++refining;
    }
    measured.probability = std::max(measured.probability, result_.views[v].probability);
  }
  measured.score = scoreOf(total_nats, support / std::max(1, refining));
  weak_ = weakDirectionsOfAll();
  probability_ = measured.probability;
  const PoseComparison::Next next =
      comparison_.takePose(attempt_, leading().camera_from_station_before, measured, weak_,
                           edgePlaces(), first().context());
  comparison_.writeTo(first().context(), first().workspace());
  if (next != PoseComparison::Next::kConclude || !options_.support.gate)
    return follow(next, status, report);
  status = judgeGap(first().workspace(), options_);
  if (status != LocalizationStatus::kConverged) return finish(status, report);
  return compare(PassKind::kCompare, report);
}

/// Of the latest refined pose, from the edges of all views that refined it.
WeakDirections ViewsLocalizer::weakDirectionsOfAll() const {
  const RunContext run = view(0).context();
  EdgeMotion motion(attempt_.camera_from_station() * run.scene.centre());
  if (leading().kind != IterationKind::kRefine) return motion.weakDirections();
  for (std::size_t v = 0; v < views_.size(); ++v)
    if (views_[v].refines)
      motion.add(views_[v].pass.record().refinement, problem_.views[v].camera,
                 views_[v].camera_from_first);
  return motion.weakDirections();
}

/// Of the latest refined pose, in the first view that refined it.
EdgePlaces ViewsLocalizer::edgePlaces() const {
  for (std::size_t v = 0; v < views_.size(); ++v)
    if (views_[v].refines && leading().kind == IterationKind::kRefine)
      return {views_[v].pass.record().refinement, problem_.views[v].camera,
              views_[v].camera_from_first};
  return {};
}

/// Compares the final pose in all views.
StepReport ViewsLocalizer::compare(PassKind kind, const StepReport& report) {
  phase_ = Phase::kCompare;
  comparison_kind_ = kind;
  startPlan();
  return report;
}

StepReport ViewsLocalizer::follow(PoseComparison::Next next, LocalizationStatus status,
                                  const StepReport& report) {
  const int index = attempt_.index() + 1;
  if (next == PoseComparison::Next::kConclude) return finish(status, report);
  start(next == PoseComparison::Next::kTry ? comparison_.next(index, first().context())
                                           : comparison_.best(index, options_));
  return report;
}

StepReport ViewsLocalizer::finish(LocalizationStatus status, StepReport report) {
  const bool held = std::all_of(views_.begin(), views_.end(),
                                [](const Linked& view) { return view.pass.memoryHolds(); });
  if (status == LocalizationStatus::kConverged && !held) {
    status = LocalizationStatus::kFault;
    first().workspace().fault = Status::kMemoryChanged;
  }
  first().finish(status, attempt_.camera_from_station(),
                 withUndetermined(attempt_.covariance(), weak_, first().problem().uncertainty));
  finished_ = true;
  report.finished = true;
  return report;
}

/// After the last match iteration: the views that agreed on its pose.
void ViewsLocalizer::chooseRefining() {
  for (std::size_t v = 0; v < views_.size(); ++v)
    views_[v].refines = latest_[v].status == LocalizationStatus::kRunning;
}

StepReport ViewsLocalizer::stepRound() {
  for (std::size_t v = 0; v < views_.size(); ++v) {
    Pass& pass = views_[v].pass;
    if (!views_[v].refines || pass.failed() == LocalizationStatus::kRunning) continue;
    views_[v].refines = false;
    latest_[v].status = pass.failed();
    if (v > 0) pass.endRound(Status::kTooFewEdges, true);
  }
  bool settled = true;
  const Status status = advance(settled);
  const bool ends = settled || first().refinement().roundsAreOver() || status != Status::kOk;
  for (std::size_t v = 0; v < views_.size(); ++v)
    if (v == 0 || views_[v].refines) views_[v].pass.endRound(status, ends);
  if (!ends) return StepReport::of(Stage::kRefine, false);
  return decide(attempt_.take(first().outcome(), {}, first().context(), first().memory().records));
}

/// One step of all views, by the sum of their equations in the first one's frame.
Status ViewsLocalizer::advance(bool& settled) {
  EdgeEquations sum;
  bool any = false;
  for (std::size_t v = 0; v < views_.size(); ++v) {
    if (!views_[v].refines) continue;
    const EdgeEquations& own = views_[v].pass.round();
    if (v == 0) {
      sum = own;
    } else {
      addTo(sum.step, inFirst(own.step, views_[v].camera_from_first));
      sum.errors.add(own.errors.inFirst(views_[v].camera_from_first));
    }
    any = true;
  }
  if (!any) return Status::kTooFewEdges;
  const Status status = first().refinement().advance(sum, settled);
  if (status != Status::kOk) return status;
  settled = settled || !views_[0].refines;
  const RefinementResult& refined = leading().refinement;
  for (std::size_t v = 1; v < views_.size(); ++v) {
    if (!views_[v].refines) continue;
    const Pose& camera_from_first = views_[v].camera_from_first;
    Pass& pass = views_[v].pass;
    pass.record().refinement.covariance = covarianceIn(camera_from_first, refined.covariance);
    const bool still = pass.refinement().moveTo(camera_from_first * refined.camera_from_station);
    settled = settled && still;
  }
  return status;
}

StepReport ViewsLocalizer::stepSupport() {
  // Without refinement the views that matched are judged.
  if (leading().kind == IterationKind::kMatch) chooseRefining();
  int supported = 0;
  int refused = 0;
  LocalizationStatus refusal = LocalizationStatus::kNotSupported;
  for (std::size_t v = 0; v < views_.size(); ++v) {
    result_.views[v].probability = 0.0;
    if (!views_[v].refines) continue;
    const Pass& pass = views_[v].pass;
    const Workspace& seen = pass.workspace();
    const bool left = pass.searches() &&
                      leftUncertainty(seedOf(pass.problem()),
                                      views_[v].camera_from_first * attempt_.camera_from_station(),
                                      options_.loop.leave_factor);
    const LocalizationStatus judged =
        left ? LocalizationStatus::kLeftUncertainty : judgeSupport(seen, options_, pass.searches());
    const bool good = judged == LocalizationStatus::kConverged;
    result_.views[v].support = seen.support;
    result_.views[v].probability = good ? seen.probability : 0.0;
    (good ? supported : refused) += 1;
    if (good) continue;
    views_[v].refines = false;
    views_[v].dropped_in_attempt = leading().attempt;
    latest_[v].status = refusal = judged;
  }
  noteViews();
  if (supported > 0 && refused > 0) return decide(attempt_.goOn(first().context()));
  return decide({supported > 0 ? Ruling::Next::kPose : Ruling::Next::kFailed, refusal,
                 Stage::kSupport, false, attempt_.record()});
}

/// The run is ambiguous when a pose competes in all views that took part.
StepReport ViewsLocalizer::stepCompare() {
  std::array<CompetingPosesOfView, kMaxViews> of_views;
  std::size_t count = 0;
  for (std::size_t v = 0; v < views_.size(); ++v) {
    const Pass& pass = views_[v].pass;
    if (views_[v].refines)
      of_views[count++] = {pass.workspace().competing_poses, views_[v].camera_from_first,
                           &problem_.views[v].camera};
  }
  result_.competing_poses = jointCompetingPoses(
      std::span(of_views).first(count), attempt_.camera_from_station(), first().context().scene);
  const Seed seed = seedOf(first().problem());
  const LocalizationStatus status =
      judgeCompetingPoses(result_.competing_poses.items(), probability_, seed, options_);
  const std::optional<PassKind> next =
      comparisonAfter(comparison_kind_, probability_, seed, attempt_.camera_from_station());
  if (status == LocalizationStatus::kConverged && next)
    return compare(*next, StepReport::of(Stage::kSupport, false));
  const StepReport report = finish(status, StepReport::of(Stage::kSupport, true));
  finishResult();
  return report;
}

const Iteration* ViewsLocalizer::iterationOf(int index) const {
  if (status_ != Status::kOk || view(0).workspace().iteration == nullptr) return nullptr;
  if (index == 0) return &leading();
  // A view that does not take part still holds an earlier iteration.
  const bool second = &leading() == &view(0).recordAt(1);
  const Iteration& own = view(index).recordAt(second ? 1 : 0);
  const bool began = view(index).workspace().iteration != nullptr;
  const bool same = own.index == leading().index && own.attempt == leading().attempt;
  return began && same ? &own : nullptr;
}

void ViewsLocalizer::noteViews() {
  for (std::size_t v = 0; v < views_.size(); ++v) {
    const Share& share = latest_[v];
    ViewReport& report = result_.views[v];
    report.status = share.status;
    report.correspondences = share.correspondences;
    report.inliers = share.inliers;
    const Iteration* own = view(static_cast<int>(v)).workspace().iteration;
    const bool refined = own != nullptr && own->kind == IterationKind::kRefine &&
                         own->index == leading().index && views_[v].refines;
    report.edges_used = refined ? own->refinement.used_count : 0;
    report.edges_rms_px = refined ? own->refinement.rms_px : 0.0;
  }
}

void ViewsLocalizer::finishResult() {
  const Workspace& leader = view(0).workspace();
  const bool converged = leader.status == LocalizationStatus::kConverged;
  result_.status = leader.status;
  result_.fault = leader.fault;
  if (converged) {
    const Pose& camera_from_rig = problem_.views[0].camera_from_rig;
    const bool same = camera_from_rig == Pose();
    const Pose rig_from_camera = camera_from_rig.inverse();
    result_.rig_from_station =
        same ? leader.camera_from_station : rig_from_camera * leader.camera_from_station;
    result_.covariance =
        same ? leader.covariance : covarianceIn(rig_from_camera, leader.covariance);
  }
  // The core judges in the first view's camera.
  for (int i = 0; i < result_.competing_poses.size(); ++i) {
    Pose& pose = result_.competing_poses[i].camera_from_station;
    pose = problem_.views[0].camera_from_rig.inverse() * pose;
  }
  for (std::size_t v = 0; v < views_.size(); ++v) {
    ViewReport& report = result_.views[v];
    if (report.status == LocalizationStatus::kRunning) report.status = leader.status;
    report.camera_from_station = v == 0 ? leader.camera_from_station
                                        : views_[v].camera_from_first * leader.camera_from_station;
  }
}

std::array<std::uint8_t, 32> ViewsLocalizer::digest() const {
  DigestWriter writer;
  writer.tag("views");
  writer.u32(static_cast<std::uint32_t>(views_.size()));
  for (std::size_t v = 0; v < views_.size(); ++v) {
    digestPose(problem_.views[v].camera_from_rig, writer);
    writer.bytes(views_[v].pass.digest().digest());
    writer.tag(localizationStatusText(result_.views[v].status));
  }
  writer.tag(localizationStatusText(result_.status));
  digestPose(result_.rig_from_station, writer);
  digestCompetingPoses(result_.competing_poses.items(), writer);
  return writer.digest();
}

}  // namespace boresight
