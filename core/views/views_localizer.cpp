// SPDX-License-Identifier: Apache-2.0
// Which view works when, refinement, support and the end.
#include "core/views/views_localizer.h"

#include "core/base/digest.h"
#include "core/localizer/run_digest.h"

namespace boresight {
namespace {

/// A rig that is the camera's own frame keeps the pose's bits.
Pose inCamera(const Pose& camera_from_rig, const Pose& rig_from_station) {
  return camera_from_rig == Pose() ? rig_from_station : camera_from_rig * rig_from_station;
}

Matrix6d movedBy(const Pose& a_from_b, const Matrix6d& covariance_in_b) {
  const Matrix6d adjoint = adjointOf(a_from_b);
  return adjoint * covariance_in_b * adjoint.transpose();
}

}  // namespace

Status ViewsLocalizer::validate(const ViewsProblem& problem, const LocalizerOptions& options) {
  if (problem.views.empty() || problem.views.size() > kMaxViews) return Status::kCapacityExceeded;
  const bool offered =
      !options.wide.isOn() && !options.ambiguity.enabled && !options.support.partial;
  if (firstInvalidOption(options) != nullptr || !offered) return Status::kInvalidOption;
  if (options.refinement.covariance == CovarianceModel::kGrouped && problem.views.size() > 1)
    return Status::kInvalidOption;
  if (!isUsable(problem.rig_from_station_seed)) return Status::kInvalidPose;
  for (const View& view : problem.views)
    if (!isUsable(view.camera_from_rig)) return Status::kInvalidPose;
  return Status::kOk;
}

/// What this needs besides the views' own blocks; only counts without `to`.
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
                                     Kernels kernels, std::size_t& bytes) {
  const Status status = validate(problem, options);
  if (status != Status::kOk) return status;
  Arena counter;
  layOut(problem, options, counter, nullptr);
  bytes = counter.highWater();
  for (const View& view : problem.views) {
    LocalizationProblem one;
    one.image = view.image;
    one.ignore = view.ignore;
    one.camera = view.camera;
    one.mesh = problem.mesh;
    std::size_t own = 0;
    const Status sized = Localizer::requiredBytes(sizeOf(one), options, 1, own, kernels);
    if (sized != Status::kOk) return sized;
    bytes += (own + Arena::kAlignment - 1) / Arena::kAlignment * Arena::kAlignment;
  }
  return Status::kOk;
}

LocalizationProblem ViewsLocalizer::problemOf(std::size_t index) const {
  const View& view = problem_.views[index];
  LocalizationProblem made;
  made.image = view.image;
  made.ignore = view.ignore;
  made.camera = view.camera;
  made.mesh = problem_.mesh;
  made.camera_from_station_seed = inCamera(view.camera_from_rig, problem_.rig_from_station_seed);
  made.uncertainty = problem_.uncertainty;  // a follower is told its own at each iteration
  return made;
}

ViewsLocalizer::ViewsLocalizer(const ViewsProblem& problem, const LocalizerOptions& options,
                               std::span<std::byte> memory, Kernels kernels)
    : problem_(problem), options_(options) {
  std::size_t needed = 0;
  status_ = requiredBytes(problem, options, kernels, needed);
  if (status_ == Status::kOk && memory.size() < needed) status_ = Status::kArenaTooSmall;
  result_.rig_from_station = problem.rig_from_station_seed;
  if (status_ != Status::kOk) return;
  Arena arena(memory);
  layOut(problem_, options_, arena, this);
  for (std::size_t v = 0; v < views_.size() && status_ == Status::kOk; ++v) {
    const LocalizationProblem own = problemOf(v);
    std::size_t bytes = 0;
    status_ = Localizer::requiredBytes(sizeOf(own), options_, 1, bytes, kernels);
    if (status_ != Status::kOk) return;
    views_[v].camera_from_first =
        problem_.views[v].camera_from_rig * problem_.views[0].camera_from_rig.inverse();
    views_[v].localizer.emplace(own, options_, arena.allocate<std::byte>(bytes), 1, kernels);
    status_ = views_[v].localizer->status();
    link(v).join(v == 0 ? ViewRole::kLeads : ViewRole::kFollows);
  }
}

bool ViewsLocalizer::takesPart(std::size_t index) const {
  const Linked& one = views_[index];
  if (leading().kind == IterationKind::kRefine) return one.refines;
  return one.dropped_in_attempt != leading().attempt;
}

StepReport ViewsLocalizer::step() {
  StepReport report = StepReport::of(Stage::kFinished, false);
  report.finished = true;
  if (finished_) return report;
  if (status_ != Status::kOk) return finishFault(0);
  if (stepView(0, report)) return report;
  for (std::size_t v = 1; v < views_.size(); ++v) {
    if (!takesPart(v)) continue;
    if (link(v).need() == ViewNeed::kPlace) {
      if (link(0).need() == ViewNeed::kSupport)
        link(v).measureSupport();
      else
        link(v).follow(view(0), views_[v].camera_from_first);
    }
    if (stepView(v, report)) return report;
  }
  switch (link(0).need()) {
    case ViewNeed::kPose:
      return noted(stepPose());
    case ViewNeed::kRound:
      return noted(stepRound());
    default:
      return noted(stepSupport());
  }
}

/// False when the view waits for the others.
bool ViewsLocalizer::stepView(std::size_t index, StepReport& report) {
  Localizer& one = *views_[index].localizer;
  if (link(index).need() != ViewNeed::kNothing) return false;
  report = one.step();
  if (one.workspace().status == LocalizationStatus::kFault)
    report = finishFault(index);
  else if (index > 0)
    report.iteration_complete = false;
  return true;
}

/// A capacity or the memory did not suffice for one view: that is the run's.
StepReport ViewsLocalizer::finishFault(std::size_t index) {
  const bool built = index < views_.size() && views_[index].localizer.has_value();
  result_.status = LocalizationStatus::kFault;
  result_.fault =
      status_ != Status::kOk || !built ? status_ : views_[index].localizer->workspace().fault;
  if (built) result_.views[index].status = LocalizationStatus::kFault;
  finished_ = true;
  StepReport report = StepReport::of(Stage::kFinished, true);
  report.finished = true;
  return report;
}

StepReport ViewsLocalizer::noted(const StepReport& report) {
  result_.iterations = view(0).workspace().iterations;
  result_.attempts = view(0).workspace().attempts;
  if (report.iteration_complete) noteViews();
  if (report.finished) finish();
  return report;
}

/// After the last match iteration: the views that agreed on its pose.
void ViewsLocalizer::chooseRefining() {
  for (std::size_t v = 0; v < views_.size(); ++v)
    views_[v].refines = latest_[v].status == LocalizationStatus::kRunning;
}

StepReport ViewsLocalizer::stepRound() {
  for (std::size_t v = 0; v < views_.size(); ++v) {
    if (!views_[v].refines || link(v).failed() == LocalizationStatus::kRunning) continue;
    views_[v].refines = false;
    latest_[v].status = link(v).failed();
    if (v > 0) (void)link(v).finishRound(Status::kTooFewEdges, true);
  }
  bool settled = true;
  const Status status = advance(settled);
  const bool ends = link(0).refinementEnds(status, settled);
  for (std::size_t v = 1; v < views_.size(); ++v)
    if (views_[v].refines) (void)link(v).finishRound(status, ends);
  return link(0).finishRound(status, ends);
}

/// One step of all views, by the sum of their equations in the first one's frame.
Status ViewsLocalizer::advance(bool& settled) {
  NormalEquations sum;
  bool any = false;
  for (std::size_t v = 0; v < views_.size(); ++v) {
    if (!views_[v].refines) continue;
    if (v == 0)
      sum = link(v).round();
    else
      addTo(sum, inFirst(link(v).round(), views_[v].camera_from_first));
    any = true;
  }
  if (!any) return Status::kTooFewEdges;
  const Status status = link(0).advance(sum, settled);
  if (status != Status::kOk) return status;
  settled = settled || !views_[0].refines;
  const RefinementResult& refined = leading().refinement;
  for (std::size_t v = 1; v < views_.size(); ++v) {
    if (!views_[v].refines) continue;
    const Pose& camera_from_first = views_[v].camera_from_first;
    const bool still = link(v).moveTo(camera_from_first * refined.camera_from_station,
                                      movedBy(camera_from_first, refined.covariance));
    settled = settled && still;
  }
  return status;
}

StepReport ViewsLocalizer::stepSupport() {
  // Without refinement those that matched are asked.
  if (leading().kind == IterationKind::kMatch) chooseRefining();
  int supported = 0;
  int refused = 0;
  for (std::size_t v = 0; v < views_.size(); ++v) {
    if (!views_[v].refines) continue;
    const EdgeSupport& support = view(static_cast<int>(v)).workspace().support;
    result_.views[v].support = support;
    const bool good = !options_.support.gate || support.share() >= options_.support.min_support;
    (good ? supported : refused) += 1;
    if (good) continue;
    views_[v].refines = false;
    views_[v].dropped_in_attempt = leading().attempt;
    latest_[v].status = LocalizationStatus::kNotSupported;
  }
  noteViews();
  for (std::size_t v = 1; v < views_.size(); ++v)
    if (link(v).need() == ViewNeed::kSupport) link(v).rest();
  const SupportVerdict verdict = supported == 0 ? SupportVerdict::kNotSupported
                                 : refused > 0  ? SupportVerdict::kGoOn
                                                : SupportVerdict::kSupported;
  return link(0).conclude(verdict);
}

const Iteration* ViewsLocalizer::iterationOf(int index) const {
  if (status_ != Status::kOk || view(0).workspace().iteration == nullptr) return nullptr;
  if (index == 0) return &leading();
  // A view that was not asked still has an earlier iteration there.
  const Iteration& own = ViewLink::record(view(index), ViewLink::shownBuffer(view(0)));
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

void ViewsLocalizer::finish() {
  const Workspace& leader = view(0).workspace();
  const bool converged = leader.status == LocalizationStatus::kConverged;
  finished_ = true;
  result_.status = leader.status;
  result_.fault = leader.fault;
  if (converged) {
    const Pose& camera_from_rig = problem_.views[0].camera_from_rig;
    const bool same = camera_from_rig == Pose();
    const Pose rig_from_camera = camera_from_rig.inverse();
    result_.rig_from_station =
        same ? leader.camera_from_station : rig_from_camera * leader.camera_from_station;
    result_.covariance = same ? leader.covariance : movedBy(rig_from_camera, leader.covariance);
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
    if (views_[v].localizer) writer.bytes(views_[v].localizer->digest());
    writer.tag(localizationStatusText(result_.views[v].status));
  }
  writer.tag(localizationStatusText(result_.status));
  digestPose(result_.rig_from_station, writer);
  return writer.digest();
}

}  // namespace boresight
