// SPDX-License-Identifier: Apache-2.0
#include "core/localizer/view_link.h"

#include "core/localizer/run_digest.h"

namespace boresight {
namespace {

/// The box of the leader's axes in this camera's, in a box; the pivot is a point of the leader's.
SeedUncertainty turnedInto(const Pose& camera_from_leader, const SeedUncertainty& leader) {
  const Eigen::Matrix3d sizes = camera_from_leader.matrix().cwiseAbs();
  SeedUncertainty made;
  made.rotation_rad = sizes * leader.rotation_rad;
  made.translation_m = sizes * leader.translation_m;
  made.pivot_in_camera_m = camera_from_leader * leader.pivot_in_camera_m;
  return made;
}

}  // namespace

/// In place of a failure: the other views may have more.
StepReport Localizer::leaveToOthers(Stage stage, LocalizationStatus status) {
  Iteration& now = buffers_[static_cast<std::size_t>(current_)];
  link_.failed = status;
  link_.failed_at = static_cast<std::uint8_t>(stage);
  now.correspondence_count = 0;
  stage_ = now.kind == IterationKind::kRefine ? Stage::kRefine : Stage::kPose;
  stage_begun_ = false;
  return StepReport::of(stage, true);
}

/// As stepRefine() up to where a round's pose would be solved for.
StepReport Localizer::stepLinkedRefine() {
  const auto lose = [this] {
    if (link_.failed != LocalizationStatus::kRunning) return;
    link_.failed = LocalizationStatus::kPnpFailed;
    link_.failed_at = static_cast<std::uint8_t>(Stage::kRefine);
  };
  if (!stage_begun_) {
    if (beginRefinement() != Status::kOk) lose();
    const bool searches = link_.failed == LocalizationStatus::kRunning;
    openPieces(searches ? refinement_.chunks() : 0);
    return StepReport::of(Stage::kRefine, false);
  }
  for (; nextUndone(); ++piece_) refinement_.searchChunk(piece_);
  openPieces(0);
  if (refinement_.gather(link_.round) != Status::kOk) lose();
  link_.need = ViewNeed::kRound;
  return StepReport::of(Stage::kRefine, false);
}

void ViewLink::join(ViewRole role) { localizer_->link_.role = role; }

ViewNeed ViewLink::need() const { return localizer_->link_.need; }

LocalizationStatus ViewLink::failed() const { return localizer_->link_.failed; }

int ViewLink::buffer() const { return localizer_->current_; }

void ViewLink::follow(const Localizer& leader, const Pose& camera_from_leader) {
  Localizer& view = *localizer_;
  const Iteration& now = leader.buffers_[static_cast<std::size_t>(leader.current_)];
  view.startIteration();
  view.attempt_ = leader.attempt_;
  view.iteration_ = leader.iteration_;
  view.hypothesis_ = leader.hypothesis_;
  view.current_ = leader.current_;
  view.workspace_.iterations = leader.workspace_.iterations;
  view.workspace_.attempts = leader.workspace_.attempts;
  view.camera_from_station_ = camera_from_leader * leader.camera_from_station_;
  view.link_.uncertainty = turnedInto(camera_from_leader, now.uncertainty);
  view.link_.failed = LocalizationStatus::kRunning;
  view.link_.need = ViewNeed::kNothing;
}

PnpSolution& ViewLink::solution() {
  return localizer_->buffers_[static_cast<std::size_t>(localizer_->current_)].pnp;
}

StepReport ViewLink::supplyPose(const JointPose& joint) {
  Localizer& view = *localizer_;
  const auto index = static_cast<std::size_t>(view.current_);
  Iteration& now = view.buffers_[index];
  const bool solved = joint.status == LocalizationStatus::kRunning;
  const bool matched = view.link_.failed == LocalizationStatus::kRunning;
  const Stage reached = matched ? Stage::kPose : static_cast<Stage>(view.link_.failed_at);
  now.status = joint.status;
  now.pnp.camera_from_station = solved ? joint.camera_from_station : view.camera_from_station_;
  now.pnp.covariance = joint.covariance;
  now.pnp.samples = joint.samples;
  if (!solved || !matched) now.pnp.inlier_count = 0;
  if (matched) digestPnp(now.pnp, view.digest_);
  view.agreement_[index] = {joint.inliers, joint.correspondences};
  view.link_.failed = LocalizationStatus::kRunning;
  if (view.link_.role == ViewRole::kFollows) {
    now.camera_from_station = now.pnp.camera_from_station;
    view.link_.need = ViewNeed::kPlace;
    return StepReport::of(Stage::kPose, true);
  }
  view.link_.need = ViewNeed::kNothing;
  return view.finishHypothesis(solved ? Stage::kPose : reached);
}

const NormalEquations& ViewLink::round() const { return localizer_->link_.round; }

Status ViewLink::advance(const NormalEquations& sum, bool& settled) {
  return localizer_->refinement_.advance(sum, settled);
}

bool ViewLink::moveTo(const Pose& camera_from_station, const Matrix6d& covariance) {
  Localizer& view = *localizer_;
  view.buffers_[static_cast<std::size_t>(view.current_)].refinement.covariance = covariance;
  return view.refinement_.moveTo(camera_from_station);
}

bool ViewLink::refinementEnds(Status status, bool settled) const {
  return settled || localizer_->refinement_.roundsAreOver() || status != Status::kOk;
}

StepReport ViewLink::finishRound(Status status, bool ends) {
  Localizer& view = *localizer_;
  Iteration& now = view.buffers_[static_cast<std::size_t>(view.current_)];
  LinkedView& link = view.link_;
  if (!ends) {
    view.openPieces(link.failed == LocalizationStatus::kRunning ? view.refinement_.chunks() : 0);
    link.need = ViewNeed::kNothing;
    return StepReport::of(Stage::kRefine, false);
  }
  const bool rendered = link.failed == LocalizationStatus::kRunning ||
                        link.failed_at != static_cast<int>(Stage::kRender);
  if (rendered) digestRefinement(now.refinement, view.digest_);
  const LocalizationStatus failed = rendered ? LocalizationStatus::kPnpFailed : link.failed;
  link.failed = LocalizationStatus::kRunning;
  if (link.role == ViewRole::kFollows) {
    now.camera_from_station = now.refinement.camera_from_station;
    view.camera_from_station_ = now.camera_from_station;
    link.need = ViewNeed::kPlace;
    return StepReport::of(Stage::kRefine, true);
  }
  link.need = ViewNeed::kNothing;
  if (status != Status::kOk) return view.fail(rendered ? Stage::kRefine : Stage::kRender, failed);
  now.status = LocalizationStatus::kRunning;
  return view.finishIteration(Stage::kRefine, now.refinement.camera_from_station,
                              now.refinement.covariance);
}

void ViewLink::measureSupport() {
  localizer_->stage_ = Stage::kSupport;
  localizer_->link_.need = ViewNeed::kNothing;
}

void ViewLink::rest() { localizer_->link_.need = ViewNeed::kPlace; }

StepReport ViewLink::conclude(SupportVerdict verdict) {
  Localizer& view = *localizer_;
  view.link_.need = ViewNeed::kNothing;
  if (verdict == SupportVerdict::kSupported) return view.finishSupported();
  if (verdict == SupportVerdict::kNotSupported) return view.failUnsupported();
  if (view.iteration_ >= view.options_.loop.max_iterations) {
    StepReport failed = view.fail(Stage::kSupport, LocalizationStatus::kIterationLimit);
    failed.iteration_complete = false;
    return failed;
  }
  view.small_corrections_ = 0;
  view.iteration_pending_ = true;
  return StepReport::of(Stage::kSupport, true);
}

int ViewLink::shownBuffer(const Localizer& localizer) {
  return localizer.workspace_.iteration == &localizer.buffers_[1] ? 1 : 0;
}

const Iteration& ViewLink::record(const Localizer& localizer, int buffer) {
  return localizer.buffers_[static_cast<std::size_t>(buffer)];
}

}  // namespace boresight
