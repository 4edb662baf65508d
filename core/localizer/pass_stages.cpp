// SPDX-License-Identifier: Apache-2.0
// The stages of a pass, in their order.
#include <algorithm>

#include "core/base/nth.h"
#include "core/localizer/acceptance.h"
#include "core/localizer/pass.h"
#include "core/localizer/pose_change.h"
#include "core/localizer/run_digest.h"
#include "core/localizer/schedule.h"
#include "core/search/mirror_search.h"
#include "core/search/wider_search.h"

namespace boresight {

namespace {

TemplateView viewOf(const Iteration& iteration, const Template& item) {
  return {&iteration.render.edges, &iteration.render.mask, item.center_x, item.center_y,
          iteration.templates.side_px};
}

}  // namespace

StepReport Pass::step() {
  if (!running_ || needs() != PassNeed::kNothing) return StepReport::of(stage_, false);
  switch (stage_) {
    case Stage::kEdges:
      return stepEdges();
    case Stage::kSearch:
      return stepSearch();
    case Stage::kRender:
      return stepRender();
    case Stage::kTemplates:
      return stepTemplates();
    case Stage::kMatch:
      return stepMatch();
    case Stage::kPose:
      return stepPose();
    case Stage::kRefine:
      return solve_outside_ ? stepOutsideRound() : stepRefine();
    case Stage::kSupport:
      if (plan_.kind == PassKind::kCompare) return stepCompare();
      return plan_.kind == PassKind::kMirror || plan_.kind == PassKind::kWider ? stepSearchAgain()
                                                                               : stepSupport();
    case Stage::kFinished:
      break;
  }
  return StepReport::of(stage_, false);
}

StepReport Pass::stepEdges() {
  if (!memory_.detector.step()) return StepReport::of(Stage::kEdges, false);
  digestEdgeMap(workspace_.edges, digest_);
  seal_.sealEdges(workspace_.edges, levels_);
  return end(Stage::kEdges);
}

/// Yields no candidate when the scene is outside the image.
StepReport Pass::stepSearch() {
  PoseSearch& search = memory_.search;
  const bool works = stage_begun_ || beginSearch();
  stage_begun_ = true;
  if (works && !search.step()) return StepReport::of(Stage::kSearch, false);
  workspace_.candidates = search.candidates();
  digestCandidates(workspace_.candidates, digest_);
  return end(Stage::kSearch);
}

bool Pass::beginSearch() {
  PoseSearch& search = memory_.search;
  if (plan_.kind == PassKind::kNearSearch) return search.beginAtSeed(searched_, memory_.renderer);
  return search.isSuspended() ? search.resume() : search.begin(searched_, memory_.renderer);
}

StepReport Pass::stepRender() {
  Iteration& iteration = record();
  if (!stage_begun_ && keepsRender(iteration)) {
    stage_ = Stage::kRefine;
    return StepReport::of(Stage::kRender, true);
  }
  if (!stage_begun_) {
    // Without a roll the pose keeps its bits.
    const Pose rendered = plan_.roll_rad == 0.0 ? plan_.rendered_from_station
                                                : rolledAboutScene(plan_.rendered_from_station,
                                                                   plan_.roll_rad, scene_);
    const Status status = memory_.renderer.begin(nth(memory_.rays, iteration.level), rendered,
                                                 iteration.render, surfaces_);
    if (status != Status::kOk) return endFaulted(Stage::kRender, status);
    stage_begun_ = true;
    memory_.tasks.open(memory_.renderer.tasks());
    if (memory_.tasks.count() > 0) return StepReport::of(Stage::kRender, false);
  }
  bool complete = false;
  const Status status = continueRender(complete);
  if (status != Status::kOk) return endFaulted(Stage::kRender, status);
  if (!complete) return StepReport::of(Stage::kRender, false);
  digestRender(iteration.render, digest_);
  stage_ = plan_.kind == PassKind::kRefine ? Stage::kRefine : Stage::kTemplates;
  stage_begun_ = false;
  if (iteration.render.pixel_count < TemplateSelector::kMinEdgePixels)
    return endFailed(Stage::kRender, LocalizationStatus::kTooFewEdges);
  return StepReport::of(Stage::kRender, true);
}

/// Runs one task of the render, or the step after the last task.
Status Pass::continueRender(bool& complete) {
  TaskList& tasks = memory_.tasks;
  complete = false;
  if (tasks.findNext()) {
    memory_.renderer.runTask(tasks.next(), 0);
    tasks.markDone(tasks.next());
    if (tasks.findNext()) return Status::kOk;
  }
  const Status status = memory_.renderer.step(complete);
  tasks.open(memory_.renderer.tasks());
  return status;
}

StepReport Pass::stepTemplates() {
  Iteration& iteration = record();
  const double depth_m = (iteration.render.camera_from_station * scene_.centre()).z();
  const double feature_size_m = options_.templates.feature_size_m > 0.0
                                    ? options_.templates.feature_size_m
                                    : scene_.diagonal() / 8.0;
  const int side_px = templateSide(options_.templates, feature_size_m, depth_m,
                                   iteration.render.camera, plan_.template_factor);
  const Status status = memory_.selector.select(iteration.render, side_px, problem_.ignore,
                                                iteration.level, iteration.templates);
  digestTemplates(iteration.templates, digest_);
  if (status == Status::kTooFewTemplates)
    return endFailed(Stage::kTemplates, LocalizationStatus::kTooFewTemplates);
  if (status != Status::kOk) return endFaulted(Stage::kTemplates, status);
  iteration.matches.count = iteration.templates.count;
  memory_.tasks.open(match_outside_ ? 0 : iteration.templates.count);
  matches_supplied_ = false;
  stage_ = Stage::kMatch;
  return StepReport::of(Stage::kTemplates, true);
}

StepReport Pass::stepMatch() {
  Iteration& iteration = record();
  TaskList& tasks = memory_.tasks;
  if (tasks.findNext()) {
    WhsSearch& search = memory_.searches.front();
    if (!task_begun_) task_begun_ = beginMatch(tasks.next(), search);
    if (task_begun_ && !search.step()) return StepReport::of(Stage::kMatch, false);
    if (task_begun_) finishMatch(tasks.next(), search);
    task_begun_ = false;
    tasks.markDone(tasks.next());
    if (tasks.findNext()) return StepReport::of(Stage::kMatch, false);
  }
  tasks.open(0);
  for (std::int32_t i = 0; i < iteration.matches.count; ++i) {
    if (nth(iteration.matches.matches, i).searched) ++iteration.matches.searched;
  }
  digestMatches(iteration.matches, digest_);
  collectCorrespondences();
  stage_ = Stage::kPose;
  stage_begun_ = false;
  if (iteration.correspondence_count < options_.pnp.min_inliers)
    return endFailed(Stage::kMatch, LocalizationStatus::kTooFewMatches);
  return StepReport::of(Stage::kMatch, true);
}

/// False when the template cannot be searched for.
bool Pass::beginMatch(int index, WhsSearch& search) {
  Iteration& iteration = record();
  const Template& item = nth(iteration.templates.templates, index);
  Match& match = nth(iteration.matches.matches, index);
  match = Match{};
  // The window lies around the hypothesis that is not rolled: the uncertainty refers to it.
  match.window =
      searchWindow(iteration.render.camera, plan_.camera_from_station * item.point_in_station_m,
                   iteration.uncertainty, iteration.templates.side_px);
  if (match.window.empty()) return false;
  return search.begin(viewOf(iteration, item), nth(workspace_.edges.level, iteration.level),
                      match.window, item.center_x, item.center_y,
                      kSecondPeakExclusion_px) == Status::kOk;
}

void Pass::finishMatch(int index, const WhsSearch& search) {
  Iteration& iteration = record();
  const Template& item = nth(iteration.templates.templates, index);
  Match& match = nth(iteration.matches.matches, index);
  match.peak = search.peak();
  match.norms = search.norms();
  match.x = match.peak.x;
  match.y = match.peak.y;
  if (options_.loop.subpixel_matches) {
    subpixelPeak(viewOf(iteration, item), nth(workspace_.edges.level, iteration.level), match.peak,
                 match.x, match.y);
  }
  match.searched = true;
  match.at_border = match.window.endsAt(match.peak.x, match.peak.y);
}

void Pass::collectCorrespondences() {
  Iteration& iteration = record();
  iteration.correspondence_count = 0;
  for (std::int32_t i = 0; i < iteration.matches.count; ++i) {
    const Match& match = nth(iteration.matches.matches, i);
    if (!match.searched) continue;
    const auto at = static_cast<std::size_t>(iteration.correspondence_count++);
    Correspondence& correspondence = iteration.correspondences[at];
    correspondence.point_in_station_m = nth(iteration.templates.templates, i).point_in_station_m;
    correspondence.pixel = atFullResolution({match.x, match.y}, iteration.level);
    correspondence.sigma_px = kMatchSigma_px * levelScale(iteration.level);
    iteration.template_of[at] = i;
  }
}

Status Pass::beginPose() {
  Iteration& iteration = record();
  const auto count = static_cast<std::size_t>(iteration.correspondence_count);
  iteration.pnp.inlier = {iteration.pnp.inlier.data(), count};
  iteration.pnp.residual_px = {iteration.pnp.residual_px.data(), count};
  stage_begun_ = true;
  return memory_.ransac.begin(iteration.correspondences.first(count), problem_.camera,
                              {plan_.camera_from_station, iteration.uncertainty},
                              iteration.threshold_px, options_.pnp, iteration.pnp);
}

StepReport Pass::stepPose() {
  if (solve_outside_) {
    solver_waits_ = true;
    return StepReport::of(Stage::kPose, false);
  }
  Iteration& iteration = record();
  Status status = stage_begun_ ? Status::kOk : beginPose();
  bool complete = false;
  if (status == Status::kOk) status = memory_.ransac.step(complete);
  if (status == Status::kOk && !complete) return StepReport::of(Stage::kPose, false);
  const bool solved = status == Status::kOk;
  if (!solved) {
    iteration.pnp.inlier_count = 0;
    iteration.pnp.camera_from_station = plan_.camera_from_station;
  }
  digestPnp(iteration.pnp, digest_);
  iteration.status = solved ? LocalizationStatus::kRunning : LocalizationStatus::kPnpFailed;
  return end(Stage::kPose);
}

Status Pass::beginRefinement() {
  Iteration& iteration = record();
  const Status status = memory_.refinement.begin(
      problem_.image, problem_.ignore, problem_.camera, problem_.mesh, iteration.render,
      iteration.threshold_px, plan_.anchored ? &plan_.anchor : nullptr,
      plan_.anchored ? &plan_.matched : nullptr, iteration.refinement, plan_.most_samples);
  memory_.refinement.startFrom(plan_.camera_from_station);
  stage_begun_ = true;
  return status;
}

StepReport Pass::stepRefine() {
  Iteration& iteration = record();
  TaskList& tasks = memory_.tasks;
  EdgeRefinement& refinement = memory_.refinement;
  Status status = Status::kOk;
  bool complete = false;
  if (!stage_begun_) {
    status = beginRefinement();
  } else {
    for (; tasks.findNext(); tasks.markDone(tasks.next())) refinement.searchChunk(tasks.next());
    status = refinement.finishRound(complete);
    complete = complete || isKnownPose(iteration.refinement.camera_from_station, plan_.known,
                                       plan_.known_px, scene_, problem_.camera);
  }
  if (status == Status::kOk && !complete) {
    tasks.open(refinement.chunks());
    return StepReport::of(Stage::kRefine, false);
  }
  digestRefinement(iteration.refinement, digest_);
  if (status != Status::kOk) return endFailed(Stage::kRefine, LocalizationStatus::kPnpFailed);
  return end(Stage::kRefine);
}

/// Edge support at once; after a search contours and regions in slices, and of the final pose the
/// focal length.
StepReport Pass::stepSupport() {
  if (!stage_begun_) {
    beginSupport();
    if (!searches()) return end(Stage::kSupport);
    if (plan_.evidence != nullptr) return takeEvidence(*plan_.evidence);
    if (!memory_.evidence.begin(searched_, record().render)) return end(Stage::kSupport);
  }
  const StepReport slice = StepReport::of(Stage::kSupport, false);
  if (!evidence_complete_) {
    return memory_.evidence.step() ? takeEvidence(measuredEvidence()) : slice;
  }
  if (!memory_.focal.step()) return slice;
  workspace_.focal = memory_.focal.fit();
  digestFocal(workspace_.focal, digest_);
  return end(Stage::kSupport);
}

void Pass::beginSupport() {
  const Iteration& iteration = record();
  workspace_.support = measureEdgeSupport(iteration.render, iteration.level, workspace_.edges,
                                          problem_.image, problem_.ignore);
  workspace_.evidence = {};
  workspace_.probability = 0.0;
  workspace_.edge_width = {};
  workspace_.focal = {};
  digest_.tag("support");
  digestSupport(workspace_.support, digest_);
  if (plan_.kind == PassKind::kSupport) {
    workspace_.edge_width =
        measureEdgeWidth(iteration.render, iteration.level, problem_.image, problem_.ignore);
    digestEdgeWidth(workspace_.edge_width, digest_);
  }
  stage_begun_ = true;
}

/// Contours and regions.
PoseEvidence Pass::measuredEvidence() {
  const Iteration& iteration = record();
  PoseEvidence evidence;
  evidence.contours = memory_.evidence.contours();
  evidence.region =
      memory_.region.measure(iteration.render, iteration.level, problem_.image, problem_.ignore);
  return evidence;
}

/// Adds the edge support; of the final pose the focal length follows.
StepReport Pass::takeEvidence(PoseEvidence evidence) {
  const Iteration& iteration = record();
  const bool is_refined = iteration.kind == IterationKind::kRefine;
  evidence_complete_ = true;
  evidence.edge_support = workspace_.support.share();
  workspace_.evidence = evidence;
  workspace_.probability = evidence.probability();
  digestEvidence(evidence, digest_);
  if (is_refined)
    outcome_.weak = weakDirections(iteration.refinement, problem_.camera, scene_.centre());
  if (plan_.kind == PassKind::kEvidence || !is_refined) return end(Stage::kSupport);
  memory_.focal.begin(problem_.camera, iteration.refinement);
  return StepReport::of(Stage::kSupport, false);
}

/// Works in the memory of the renders and of the samples: those of the iteration become invalid.
StepReport Pass::stepCompare() {
  CompetingPoseTest& competing = memory_.competing;
  const bool works =
      stage_begun_ || competing.begin(searched_, plan_.camera_from_station, memory_.renderer);
  stage_begun_ = true;
  if (works && !competing.step()) return StepReport::of(Stage::kSupport, false);
  workspace_.competing_poses = works ? competing.poses() : std::span<const CompetingPose>();
  digestCompetingPoses(workspace_.competing_poses, digest_);
  return end(Stage::kSupport);
}

/// Searches for what would contradict the pose: the mesh's mirror image, or a pose beyond the
/// seed's uncertainty. Works in the memory of the search.
StepReport Pass::stepSearchAgain() {
  PoseSearch& search = memory_.search;
  const bool is_mirror = plan_.kind == PassKind::kMirror;
  const bool works =
      stage_begun_ || search.begin(is_mirror ? mirrorSearch(searched_, plan_.camera_from_station)
                                             : widerSearch(searched_),
                                   memory_.renderer);
  stage_begun_ = true;
  if (works && (!search.step() || search.resume())) return StepReport::of(Stage::kSupport, false);
  if (is_mirror)
    takeMirrorImage(search.candidates());
  else
    takeOther(search.candidates());
  workspace_.competing_poses = memory_.competing.poses();
  workspace_.candidates = {};  // their memory was used
  digestCompetingPoses(workspace_.competing_poses, digest_);
  return end(Stage::kSupport);
}

void Pass::takeMirrorImage(std::span<const PoseCandidate> candidates) {
  double most_nats = 0.0;
  for (const PoseCandidate& candidate : candidates)
    most_nats = std::max(most_nats, candidate.evidence.total_nats());
  const double own_nats = workspace_.evidence.contours.front().total_nats();
  if (most_nats <= kMirrorExcess * std::max(own_nats, 0.0)) return;
  CompetingPose mirror;
  mirror.camera_from_station = plan_.camera_from_station;
  mirror.margin_nats = (own_nats - most_nats) / kAlongEdge_px;
  mirror.mirrored = true;
  memory_.competing.add(mirror);
}

/// Adds the distinct candidate with most evidence as a competing pose, when it has clearly more
/// evidence than the final pose, and than the candidates near it, which are refined as coarsely.
void Pass::takeOther(std::span<const PoseCandidate> candidates) {
  const double own_nats = std::max(0.0, workspace_.evidence.contours.front().total_nats());
  double same_nats = own_nats;
  const PoseCandidate* other = nullptr;
  for (const PoseCandidate& candidate : candidates) {
    const double nats = candidate.evidence.total_nats();
    if (!areDistinct(plan_.camera_from_station, candidate.camera_from_station, scene_,
                     problem_.camera))
      same_nats = std::max(same_nats, nats);
    else if (other == nullptr || nats > other->evidence.total_nats())
      other = &candidate;
  }
  if (other == nullptr || other->evidence.total_nats() <= kOtherExcess * same_nats) return;
  CompetingPose competing;
  competing.camera_from_station = other->camera_from_station;
  competing.margin_nats = (own_nats - other->evidence.total_nats()) / kAlongEdge_px;
  memory_.competing.add(competing);
}

}  // namespace boresight
