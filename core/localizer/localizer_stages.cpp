// SPDX-License-Identifier: Apache-2.0
// What each stage does in a step, and the pieces that may be done side by side.
#include <algorithm>

#include "core/localizer/localizer.h"
#include "core/localizer/pose_change.h"
#include "core/localizer/run_digest.h"
#include "core/localizer/schedule.h"

namespace boresight {

int Localizer::pieces() const {
  const bool idle = status_ != Status::kOk || iteration_pending_ || hypothesis_pending_;
  // What step() has begun it also ends.
  return idle || piece_begun_ ? 0 : piece_count_;
}

void Localizer::openPieces(int count) {
  piece_count_ = count;
  piece_ = 0;
  piece_begun_ = false;
  std::fill_n(done_.begin(), count, std::uint8_t{0});
}

/// Moves on to the first piece that nobody has done; false when there is none.
bool Localizer::nextUndone() {
  while (piece_ < piece_count_ && done_[static_cast<std::size_t>(piece_)] != 0) ++piece_;
  return piece_ < piece_count_;
}

void Localizer::work(int piece, int worker) {
  if (piece < 0 || piece >= pieces() || worker < 0 || worker >= workers_) return;
  if (done_[static_cast<std::size_t>(piece)] != 0) return;
  if (stage_ == Stage::kRender || weighing_) {
    renderer_.work(piece, worker);
  } else if (stage_ == Stage::kMatch) {
    WarpedSearch& search = searches_[static_cast<std::size_t>(worker)];
    if (beginMatch(piece, search)) {
      while (!search.step()) {
      }
      finishMatch(piece, search);
    }
  } else {
    refinement_.searchChunk(piece);
  }
  done_[static_cast<std::size_t>(piece)] = 1;
}

StepReport Localizer::stepEdges() {
  const bool complete = detector_.step();
  if (complete) {
    digestEdgeMap(workspace_.edges, digest_);
    iteration_pending_ = link_.role != ViewRole::kFollows;
    if (!iteration_pending_) link_.need = ViewNeed::kPlace;
  }
  return StepReport::of(Stage::kEdges, complete);
}

StepReport Localizer::stepRender() {
  Iteration& now = buffers_[static_cast<std::size_t>(current_)];
  if (!stage_begun_ && canReuseRender(now)) {
    stage_ = Stage::kRefine;
    return StepReport::of(Stage::kRender, true);
  }
  if (!stage_begun_) {
    // Not turned, the pose keeps its bits.
    const double roll_rad = rollOf(hypothesis_, options_.loop.roll_spacing_rad);
    const Pose rendered = hypothesis_ == 0 || isWide()
                              ? camera_from_station_
                              : rolledAboutScene(camera_from_station_, roll_rad, bounds_);
    const Status status = renderer_.begin(rays_[static_cast<std::size_t>(now.level)], rendered,
                                          now.render, surfaces_);
    if (status != Status::kOk) return faulted(Stage::kRender, status);
    stage_begun_ = true;
    openPieces(renderer_.pieces());
    if (piece_count_ > 0) return StepReport::of(Stage::kRender, false);
  }
  bool complete = false;
  const Status status = continueRender(complete);
  if (status != Status::kOk) return faulted(Stage::kRender, status);
  if (complete) {
    digestRender(now.render, digest_);
    stage_ = now.kind == IterationKind::kRefine ? Stage::kRefine : Stage::kTemplates;
    stage_begun_ = false;
    if (now.render.pixel_count < options_.templates.min_edge_pixels) {
      return failHypothesis(Stage::kRender, LocalizationStatus::kTooFewEdges);
    }
  }
  return StepReport::of(Stage::kRender, complete);
}

/// One piece of the render under way, or what follows when there is none.
Status Localizer::continueRender(bool& complete) {
  complete = false;
  if (nextUndone()) {
    renderer_.work(piece_, 0);
    done_[static_cast<std::size_t>(piece_)] = 1;
    if (nextUndone()) return Status::kOk;
  }
  const Status status = renderer_.step(complete);
  openPieces(renderer_.pieces());
  return status;
}

StepReport Localizer::stepTemplates() {
  Iteration& now = buffers_[static_cast<std::size_t>(current_)];
  const double depth_m = (now.render.camera_from_station * bounds_.centre()).z();
  const int side_px = templateSide(options_.templates, templateFactorNow() * featureSize(), depth_m,
                                   now.render.camera);
  const Status status = selector_.select(
      now.render, side_px, problem_.ignore, now.level,
      failed_in_station_m_.first(static_cast<std::size_t>(failed_count_)), now.templates);
  digestTemplates(now.templates, digest_);
  if (status == Status::kTooFewTemplates)
    return failHypothesis(Stage::kTemplates, LocalizationStatus::kTooFewTemplates);
  if (status != Status::kOk) return faulted(Stage::kTemplates, status);
  now.matches.count = now.templates.count;
  openPieces(match_outside_ ? 0 : now.templates.count);
  supplied_ = false;
  stage_ = Stage::kMatch;
  return StepReport::of(Stage::kTemplates, true);
}

StepReport Localizer::stepMatch() {
  Iteration& now = buffers_[static_cast<std::size_t>(current_)];
  if (match_outside_ && !supplied_) return StepReport::of(Stage::kMatch, false);
  if (nextUndone()) {
    WarpedSearch& search = searches_.front();
    if (!piece_begun_) piece_begun_ = beginMatch(piece_, search);
    if (piece_begun_ && !search.step()) return StepReport::of(Stage::kMatch, false);
    if (piece_begun_) finishMatch(piece_, search);
    piece_begun_ = false;
    done_[static_cast<std::size_t>(piece_)] = 1;
    if (nextUndone()) return StepReport::of(Stage::kMatch, false);
  }
  openPieces(0);
  for (std::int32_t i = 0; i < now.matches.count; ++i) {
    if (now.matches.matches[static_cast<std::size_t>(i)].searched) ++now.matches.searched;
  }
  if (options_.templates.min_margin > 0.0) dropIndistinct();
  digestMatches(now.matches, digest_);
  if (options_.warp.enabled || options_.templates.min_margin > 0.0)
    digestWarps(now.matches, digest_);
  collectCorrespondences();
  stage_ = Stage::kPose;
  stage_begun_ = false;
  if (now.correspondence_count < options_.pnp.min_inliers) {
    return failHypothesis(Stage::kMatch, LocalizationStatus::kTooFewMatches);
  }
  return StepReport::of(Stage::kMatch, true);
}

/// As many warps as the schedule and the uncertainty ask for.
WarpGrid Localizer::warpsOf(const Iteration& now, const Eigen::Vector3d& point_in_camera_m) const {
  if (!options_.warp.enabled || isWide() || iteration_ >= options_.warp.iterations) return {};
  return warpGrid(options_.warp, now.uncertainty, point_in_camera_m, now.templates.side_px);
}

/// False when the template cannot be searched for.
bool Localizer::beginMatch(int index, WarpedSearch& search) {
  Iteration& now = buffers_[static_cast<std::size_t>(current_)];
  const Template& item = now.templates.templates[static_cast<std::size_t>(index)];
  Match& match = now.matches.matches[static_cast<std::size_t>(index)];
  match = Match{};
  // The window is about the unrolled hypothesis: that is what the uncertainty speaks of.
  const Eigen::Vector3d point_in_camera_m = camera_from_station_ * item.point_in_station_m;
  match.window =
      searchWindow(now.render.camera, point_in_camera_m, now.uncertainty, now.templates.side_px);
  if (match.window.empty()) return false;
  SearchTask task;
  task.view = {&now.render.edges, &now.render.mask, item.center_x, item.center_y,
               now.templates.side_px};
  task.test_edges = &workspace_.edges.level[static_cast<std::size_t>(now.level)];
  task.window = match.window;
  task.warps = warpsOf(now, point_in_camera_m);
  task.exclusion_px = options_.loop.second_peak_exclusion_px;
  task.subpixel = options_.loop.subpixel_matches;
  return search.begin(task) == Status::kOk;
}

void Localizer::finishMatch(int index, const WarpedSearch& search) {
  Iteration& now = buffers_[static_cast<std::size_t>(current_)];
  Match& match = now.matches.matches[static_cast<std::size_t>(index)];
  match.peak = search.peak();
  match.norms = search.norms();
  match.warp = search.warp();
  match.x = search.x();
  match.y = search.y();
  match.searched = true;
  match.at_border = match.peak.x == match.window.x_min || match.peak.x == match.window.x_max ||
                    match.peak.y == match.window.y_min || match.peak.y == match.window.y_max;
}

void Localizer::collectCorrespondences() {
  Iteration& now = buffers_[static_cast<std::size_t>(current_)];
  now.correspondence_count = 0;
  const double scale = static_cast<double>(1 << now.level);
  for (std::int32_t i = 0; i < now.matches.count; ++i) {
    const Match& match = now.matches.matches[static_cast<std::size_t>(i)];
    if (!match.searched || match.dropped) continue;
    Correspondence& made = now.correspondences[static_cast<std::size_t>(now.correspondence_count)];
    made.point_in_station_m =
        now.templates.templates[static_cast<std::size_t>(i)].point_in_station_m;
    made.pixel = Eigen::Vector2d((match.x + 0.5) * scale - 0.5, (match.y + 0.5) * scale - 0.5);
    made.sigma_px = options_.loop.match_sigma_px * scale;
    now.template_of[static_cast<std::size_t>(now.correspondence_count)] = i;
    ++now.correspondence_count;
  }
}

StepReport Localizer::stepPose() {
  if (weighing_) return stepEvidence();
  if (link_.role != ViewRole::kAlone) {
    link_.need = ViewNeed::kPose;
    return StepReport::of(Stage::kPose, false);
  }
  Iteration& now = buffers_[static_cast<std::size_t>(current_)];
  const auto count = static_cast<std::size_t>(now.correspondence_count);
  Status status = Status::kOk;
  if (!stage_begun_) {
    now.pnp.inlier = {now.pnp.inlier.data(), count};
    now.pnp.residual_px = {now.pnp.residual_px.data(), count};
    status = ransac_.begin(now.correspondences.first(count), problem_.camera,
                           {camera_from_station_, now.uncertainty}, now.threshold_px, options_.pnp,
                           now.pnp);
    stage_begun_ = true;
  }
  bool complete = false;
  if (status == Status::kOk) status = ransac_.step(complete);
  if (status == Status::kOk && !complete) return StepReport::of(Stage::kPose, false);
  if (status != Status::kOk) {
    now.pnp.inlier_count = 0;
    now.pnp.camera_from_station = camera_from_station_;
  }
  digestPnp(now.pnp, digest_);
  now.status =
      status == Status::kOk ? LocalizationStatus::kRunning : LocalizationStatus::kPnpFailed;
  if (isWide() && status == Status::kOk) return beginEvidence();
  return finishHypothesis(Stage::kPose);
}

Status Localizer::beginRefinement() {
  Iteration& now = buffers_[static_cast<std::size_t>(current_)];
  const Status status = refinement_.begin(
      problem_.image, problem_.ignore, problem_.camera, problem_.mesh, now.render, now.threshold_px,
      anchor(), options_.loop.anchored ? &matched_ : nullptr, now.refinement);
  refinement_.startFrom(camera_from_station_);
  stage_begun_ = true;
  return status;
}

StepReport Localizer::stepRefine() {
  if (link_.role != ViewRole::kAlone) return stepLinkedRefine();
  Iteration& now = buffers_[static_cast<std::size_t>(current_)];
  Status status = Status::kOk;
  if (!stage_begun_) {
    status = beginRefinement();
    if (status == Status::kOk) {
      openPieces(refinement_.chunks());
      return StepReport::of(Stage::kRefine, false);
    }
  }
  bool complete = false;
  if (status == Status::kOk) {
    for (; nextUndone(); ++piece_) refinement_.searchChunk(piece_);
    status = refinement_.finishRound(complete);
    if (status == Status::kOk && !complete) {
      openPieces(refinement_.chunks());
      return StepReport::of(Stage::kRefine, false);
    }
  }
  openPieces(0);
  digestRefinement(now.refinement, digest_);
  if (status != Status::kOk) return fail(Stage::kRefine, LocalizationStatus::kPnpFailed);
  return finishIteration(Stage::kRefine, now.refinement.camera_from_station,
                         now.refinement.covariance);
}

StepReport Localizer::stepSupport() {
  if (rival_round_ == RivalRound::kScan) return stepScan();
  const Iteration& now = buffers_[static_cast<std::size_t>(current_)];
  workspace_.support = measureEdgeSupport(now.render, now.level, workspace_.edges, problem_.image,
                                          problem_.ignore, options_.support, &workspace_.partial);
  digest_.tag("support");
  digestSupport(workspace_.support, digest_);
  if (options_.support.partial) digestPartialSupport(workspace_.partial, digest_);
  if (link_.role != ViewRole::kAlone) {
    link_.need = ViewNeed::kSupport;
    return StepReport::of(Stage::kSupport, false);
  }
  const bool supported =
      !options_.support.gate || workspace_.support.share() >= options_.support.min_support ||
      (options_.support.partial && workspace_.partial.suffices(options_.support));
  return supported ? finishSupported() : failUnsupported();
}

StepReport Localizer::failUnsupported() {
  StepReport failed = fail(Stage::kSupport, LocalizationStatus::kNotSupported);
  failed.iteration_complete = false;  // it was reported when its pose came out
  return failed;
}

StepReport Localizer::finishSupported() {
  if (weighsRivals()) return weighRivals();
  finish(verdict());
  StepReport made = StepReport::of(Stage::kSupport, true);
  made.finished = true;
  return made;
}

double Localizer::featureSize() const {
  return options_.templates.feature_size_m > 0.0 ? options_.templates.feature_size_m
                                                 : bounds_.diagonal() / 8.0;
}

const PosePrior* Localizer::anchor() const { return options_.loop.anchored ? &anchor_ : nullptr; }

}  // namespace boresight
