// SPDX-License-Identifier: Apache-2.0
// The loop: one bounded slice per step.
#include "core/localizer/localizer.h"

#include <algorithm>
#include <cmath>

#include "core/base/math.h"
#include "core/localizer/run_digest.h"

namespace boresight {
namespace {

/// The render turned about the camera's view axis.
Pose rolledAboutAxis(const Pose& camera_from_station, double roll_rad,
                     const Eigen::Vector3d& centre_in_camera_m) {
  // About the ray through the scene's middle, so that the scene stays where it is.
  const Eigen::Vector3d axis = centre_in_camera_m.normalized();
  const Eigen::Quaterniond turn = rotationExp(axis * roll_rad);
  Pose rolled;
  rolled.rotation = (turn * camera_from_station.rotation).normalized();
  rolled.translation_m = turn * camera_from_station.translation_m;
  return rolled;
}

/// 0, +s, -s, +2s, -2s, ...
double rollOf(int hypothesis, double spacing_rad) {
  const int step = (hypothesis + 1) / 2;
  return (hypothesis % 2 == 1 ? 1.0 : -1.0) * step * spacing_rad;
}

StepReport report(Stage stage, bool stage_complete) {
  StepReport made;
  made.stage = stage;
  made.stage_complete = stage_complete;
  return made;
}

}  // namespace

StepReport Localizer::step() {
  if (status_ != Status::kOk && stage_ != Stage::kFinished) return faulted(stage_, status_);
  if (iteration_pending_) startIteration();
  if (hypothesis_pending_) startHypothesis();
  switch (stage_) {
    case Stage::kEdges:
      return stepEdges();
    case Stage::kRender:
      return stepRender();
    case Stage::kTemplates:
      return stepTemplates();
    case Stage::kMatch:
      return stepMatch();
    case Stage::kPose:
      return stepPose();
    case Stage::kRefine:
      return stepRefine();
    case Stage::kSupport:
      return stepSupport();
    case Stage::kFinished:
      break;
  }
  StepReport finished = report(Stage::kFinished, false);
  finished.finished = true;
  return finished;
}

StepReport Localizer::stepEdges() {
  const bool complete = detector_.step();
  if (complete) {
    digestEdgeMap(workspace_.edges, digest_);
    iteration_pending_ = true;
  }
  return report(Stage::kEdges, complete);
}

Status Localizer::restart(const Pose& camera_from_station_seed, const LocalizerOptions& options) {
  if (!isUsable(PosePrior{camera_from_station_seed, problem_.uncertainty}))
    return Status::kInvalidPose;
  std::size_t bytes = 0;
  Status status = requiredBytes(sizeOf(problem_), options, workers_, bytes, kernels_);
  if (status == Status::kOk && bytes > memory_.size()) status = Status::kArenaTooSmall;
  if (status != Status::kOk) return status;
  problem_.camera_from_station_seed = camera_from_station_seed;
  options_ = options;
  begin();
  return status_;
}

void Localizer::startIteration() {
  iteration_pending_ = false;
  hypothesis_ = 0;
  has_best_ = false;
  current_ = 0;
  // The renderer works where the finer edge maps were.
  for (int level = 0; level < fine_level_; ++level)
    workspace_.edges.level[static_cast<std::size_t>(level)] = BitImage();
  hypothesis_pending_ = true;
}

void Localizer::startHypothesis() {
  hypothesis_pending_ = false;
  Iteration& now = buffers_[static_cast<std::size_t>(current_)];
  now.index = workspace_.iterations;
  now.attempt = attempt_;
  now.kind = isRefinement(iteration_) ? IterationKind::kRefine : IterationKind::kMatch;
  now.level = levelOf(now.kind, iteration_);
  now.camera_from_station_before = camera_from_station_;
  now.uncertainty = uncertaintyAt(iteration_, camera_from_station_);
  if (now.kind == IterationKind::kMatch) {
    now.threshold_px =
        shrinkAt(options_.loop.threshold_shrink, iteration_) * options_.loop.inlier_threshold_px;
  } else {
    const bool first = iteration_ == options_.loop.match_iterations;
    const double radius_px =
        first ? options_.refinement.first_radius_px : options_.refinement.last_radius_px;
    now.threshold_px = radius_px * static_cast<double>(1 << now.level);
  }
  now.status = LocalizationStatus::kRunning;
  if (!canReuseRender(now)) {
    now.render = now.level == coarse_level_ ? coarse_render_[static_cast<std::size_t>(current_)]
                                            : fine_render_;
  }
  now.templates.count = 0;
  now.matches.count = 0;
  now.matches.searched = 0;
  now.correspondence_count = 0;
  now.pnp.inlier_count = 0;
  now.refinement.sample_count = 0;
  now.refinement.found_count = 0;
  now.refinement.used_count = 0;
  workspace_.iteration = &now;
  stage_ = Stage::kRender;
  stage_begun_ = false;
}

StepReport Localizer::stepRender() {
  Iteration& now = buffers_[static_cast<std::size_t>(current_)];
  if (!stage_begun_ && canReuseRender(now)) {
    stage_ = Stage::kRefine;
    return report(Stage::kRender, true);
  }
  if (!stage_begun_) {
    const Eigen::Vector3d centre_in_camera_m = camera_from_station_ * bounds_.centre();
    const Pose rendered = hypothesis_ == 0
                              ? camera_from_station_
                              : rolledAboutAxis(camera_from_station_,
                                                rollOf(hypothesis_, options_.loop.roll_spacing_rad),
                                                centre_in_camera_m);
    const Status status =
        renderer_.begin(rays_[static_cast<std::size_t>(now.level)], rendered, now.render);
    if (status != Status::kOk) return faulted(Stage::kRender, status);
    stage_begun_ = true;
    openPieces(renderer_.pieces());
    if (piece_count_ > 0) return report(Stage::kRender, false);
  }
  if (nextUndone()) {
    renderer_.work(piece_, 0);
    done_[static_cast<std::size_t>(piece_)] = 1;
    if (nextUndone()) return report(Stage::kRender, false);
  }
  bool complete = false;
  const Status status = renderer_.step(complete);
  openPieces(renderer_.pieces());
  if (status != Status::kOk) return faulted(Stage::kRender, status);
  if (complete) {
    digestRender(now.render, digest_);
    stage_ = now.kind == IterationKind::kRefine ? Stage::kRefine : Stage::kTemplates;
    stage_begun_ = false;
    if (now.render.pixel_count < options_.templates.min_edge_pixels) {
      return failHypothesis(Stage::kRender, LocalizationStatus::kTooFewEdges);
    }
  }
  return report(Stage::kRender, complete);
}

/// The last refinement's render shows the scene as it would be rendered again.
bool Localizer::canReuseRender(const Iteration& now) const {
  return now.kind == IterationKind::kRefine && iteration_ > options_.loop.match_iterations &&
         imageDisplacement(now.render.camera_from_station, camera_from_station_) <
             options_.loop.render_again_px;
}

StepReport Localizer::stepTemplates() {
  Iteration& now = buffers_[static_cast<std::size_t>(current_)];
  const double depth_m = (now.render.camera_from_station * bounds_.centre()).z();
  const int side_px = templateSide(options_.templates, templateFactor() * featureSize(), depth_m,
                                   now.render.camera);
  const Status status =
      selector_.select(now.render, side_px, problem_.ignore, now.level, now.templates);
  digestTemplates(now.templates, digest_);
  if (status == Status::kTooFewTemplates)
    return failHypothesis(Stage::kTemplates, LocalizationStatus::kTooFewTemplates);
  if (status != Status::kOk) return faulted(Stage::kTemplates, status);
  now.matches.count = now.templates.count;
  openPieces(now.templates.count);
  stage_ = Stage::kMatch;
  return report(Stage::kTemplates, true);
}

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
  if (stage_ == Stage::kRender) {
    renderer_.work(piece, worker);
  } else if (stage_ == Stage::kMatch) {
    WhsSearch& search = searches_[static_cast<std::size_t>(worker)];
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

StepReport Localizer::stepMatch() {
  Iteration& now = buffers_[static_cast<std::size_t>(current_)];
  if (nextUndone()) {
    WhsSearch& search = searches_.front();
    if (!piece_begun_) piece_begun_ = beginMatch(piece_, search);
    if (piece_begun_ && !search.step()) return report(Stage::kMatch, false);
    if (piece_begun_) finishMatch(piece_, search);
    piece_begun_ = false;
    done_[static_cast<std::size_t>(piece_)] = 1;
    if (nextUndone()) return report(Stage::kMatch, false);
  }
  openPieces(0);
  for (std::int32_t i = 0; i < now.matches.count; ++i) {
    if (now.matches.matches[static_cast<std::size_t>(i)].searched) ++now.matches.searched;
  }
  digestMatches(now.matches, digest_);
  collectCorrespondences();
  stage_ = Stage::kPose;
  stage_begun_ = false;
  if (now.correspondence_count < options_.pnp.min_inliers) {
    return failHypothesis(Stage::kMatch, LocalizationStatus::kTooFewMatches);
  }
  return report(Stage::kMatch, true);
}

/// False when the template cannot be searched for.
bool Localizer::beginMatch(int index, WhsSearch& search) {
  Iteration& now = buffers_[static_cast<std::size_t>(current_)];
  const Template& item = now.templates.templates[static_cast<std::size_t>(index)];
  Match& match = now.matches.matches[static_cast<std::size_t>(index)];
  const TemplateView view{&now.render.edges, &now.render.mask, item.center_x, item.center_y,
                          now.templates.side_px};
  match = Match{};
  // The window is about the unrolled hypothesis: that is what the uncertainty speaks of.
  match.window = searchWindow(now.render.camera, camera_from_station_ * item.point_in_station_m,
                              now.uncertainty, now.templates.side_px);
  return !match.window.empty() &&
         search.begin(view, workspace_.edges.level[static_cast<std::size_t>(now.level)],
                      match.window, item.center_x, item.center_y,
                      options_.loop.second_peak_exclusion_px) == Status::kOk;
}

void Localizer::finishMatch(int index, const WhsSearch& search) {
  Iteration& now = buffers_[static_cast<std::size_t>(current_)];
  const Template& item = now.templates.templates[static_cast<std::size_t>(index)];
  Match& match = now.matches.matches[static_cast<std::size_t>(index)];
  const TemplateView view{&now.render.edges, &now.render.mask, item.center_x, item.center_y,
                          now.templates.side_px};
  match.peak = search.peak();
  match.norms = search.norms();
  match.x = match.peak.x;
  match.y = match.peak.y;
  if (options_.loop.subpixel_matches) {
    subpixelPeak(view, workspace_.edges.level[static_cast<std::size_t>(now.level)], match.peak,
                 match.x, match.y);
  }
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
    if (!match.searched) continue;
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
  if (status == Status::kOk && !complete) return report(Stage::kPose, false);
  if (status != Status::kOk) {
    now.pnp.inlier_count = 0;
    now.pnp.camera_from_station = camera_from_station_;
  }
  digestPnp(now.pnp, digest_);
  now.status =
      status == Status::kOk ? LocalizationStatus::kRunning : LocalizationStatus::kPnpFailed;
  return finishHypothesis(Stage::kPose);
}

void Localizer::noteHypothesis() {
  const Iteration& now = buffers_[static_cast<std::size_t>(current_)];
  HypothesisSummary summary;
  summary.roll_rad = hypothesis_ == 0 ? 0.0 : rollOf(hypothesis_, options_.loop.roll_spacing_rad);
  summary.templates = now.templates.count;
  summary.matches = now.correspondence_count;
  summary.inliers = now.pnp.inlier_count;
  summary.solved = now.status == LocalizationStatus::kRunning;
  summary.camera_from_station = now.pnp.camera_from_station;
  for (std::int32_t i = 0; i < now.correspondence_count; ++i) {
    const double ratio =
        summary.solved ? now.pnp.residual_px[static_cast<std::size_t>(i)] / now.threshold_px : 1.0;
    summary.cost += std::min(1.0, ratio * ratio);
  }
  for (Iteration& buffer : buffers_) {
    buffer.hypotheses[static_cast<std::size_t>(hypothesis_)] = summary;
    buffer.hypothesis_count = hypothesis_ + 1;
  }
}

/// Too little to go on with. Another hypothesis may have more: it counts as one without a pose.
StepReport Localizer::failHypothesis(Stage stage, LocalizationStatus status) {
  Iteration& now = buffers_[static_cast<std::size_t>(current_)];
  now.status = status;
  if (now.kind == IterationKind::kRefine) return fail(stage, status);
  now.pnp.inlier_count = 0;
  now.pnp.camera_from_station = camera_from_station_;
  return finishHypothesis(stage);
}

StepReport Localizer::finishHypothesis(Stage stage) {
  reached_[static_cast<std::size_t>(current_)] = stage;
  noteHypothesis();
  const int other = 1 - current_;
  const Iteration& now = buffers_[static_cast<std::size_t>(current_)];
  const Iteration& best = buffers_[static_cast<std::size_t>(other)];
  const bool better = !has_best_ || now.pnp.inlier_count > best.pnp.inlier_count;
  buffers_[static_cast<std::size_t>(better ? current_ : other)].chosen_hypothesis =
      better ? hypothesis_ : best.chosen_hypothesis;
  const int kept = better ? current_ : other;
  ++hypothesis_;
  const int wanted = iteration_ == 0 ? rolledHypotheses() : 1;
  if (hypothesis_ < wanted && !isConvincing(buffers_[static_cast<std::size_t>(kept)])) {
    has_best_ = true;
    current_ = 1 - kept;
    // Started by the next step: until then the caller sees the hypothesis that has ended.
    hypothesis_pending_ = true;
    return report(stage, true);
  }
  current_ = kept;
  Iteration& chosen = buffers_[static_cast<std::size_t>(kept)];
  workspace_.iteration = &chosen;
  if (chosen.status != LocalizationStatus::kRunning)
    return fail(reached_[static_cast<std::size_t>(kept)], chosen.status);
  return finishIteration(Stage::kPose, chosen.pnp.camera_from_station, chosen.pnp.covariance);
}

/// So many matches agree by chance with no pose. A further attempt looks at every roll.
bool Localizer::isConvincing(const Iteration& iteration) const {
  return attempt_ == 0 && iteration.status == LocalizationStatus::kRunning &&
         iteration.pnp.inlier_count >=
             options_.loop.enough_inliers * iteration.correspondence_count;
}

StepReport Localizer::stepRefine() {
  Iteration& now = buffers_[static_cast<std::size_t>(current_)];
  Status status = Status::kOk;
  if (!stage_begun_) {
    status = refinement_.begin(problem_.image, problem_.ignore, problem_.camera, problem_.mesh,
                               now.render, now.threshold_px, anchor(),
                               options_.loop.anchored ? &matched_ : nullptr, now.refinement);
    refinement_.startFrom(camera_from_station_);
    stage_begun_ = true;
    if (status == Status::kOk) {
      openPieces(refinement_.chunks());
      return report(Stage::kRefine, false);
    }
  }
  bool complete = false;
  if (status == Status::kOk) {
    for (; nextUndone(); ++piece_) refinement_.searchChunk(piece_);
    status = refinement_.finishRound(complete);
    if (status == Status::kOk && !complete) {
      openPieces(refinement_.chunks());
      return report(Stage::kRefine, false);
    }
  }
  openPieces(0);
  digestRefinement(now.refinement, digest_);
  if (status != Status::kOk) return fail(Stage::kRefine, LocalizationStatus::kPnpFailed);
  return finishIteration(Stage::kRefine, now.refinement.camera_from_station,
                         now.refinement.covariance);
}

StepReport Localizer::finishIteration(Stage stage, const Pose& camera_from_station,
                                      const Matrix6d& covariance) {
  Iteration& now = buffers_[static_cast<std::size_t>(current_)];
  const bool matched = now.kind == IterationKind::kMatch;
  const bool pull = options_.loop.anchored && matched && options_.refinement.enabled;
  now.camera_from_station = pull ? pulledBack(camera_from_station) : camera_from_station;
  measureCorrection(camera_from_station_, now.camera_from_station);
  small_corrections_ = isSmall(now) ? small_corrections_ + 1 : 0;
  camera_from_station_ = now.camera_from_station;
  covariance_ = covariance;
  if (matched) {
    // Templates overlap and share their errors.
    matched_.camera_from_station = camera_from_station_;
    if (!invert(covariance * options_.loop.match_inflation, matched_.information))
      matched_.information.setZero();
  }
  StepReport made = report(stage, true);
  made.iteration_complete = true;
  ++iteration_;
  ++workspace_.iterations;
  if (leftUncertainty(camera_from_station_))
    return fail(stage, LocalizationStatus::kLeftUncertainty);
  const int needed = options_.refinement.enabled
                         ? std::max(options_.loop.match_iterations + options_.refinement.min_passes,
                                    options_.loop.converged_iterations)
                         : options_.loop.converged_iterations;
  if (iteration_ >= needed && small_corrections_ >= options_.loop.converged_iterations) {
    stage_ = Stage::kSupport;
    return made;
  }
  if (iteration_ >= options_.loop.max_iterations)
    return fail(stage, LocalizationStatus::kIterationLimit);
  // Started by the next step: until then the caller sees the iteration that has ended.
  iteration_pending_ = true;
  return made;
}

bool Localizer::isSmall(const Iteration& iteration) const {
  if (iteration.correction_image_px < options_.loop.converged_image_px) return true;
  return iteration.correction_translation_m < options_.loop.converged_translation_m &&
         iteration.correction_rotation_rad < options_.loop.converged_rotation_rad;
}

/// A coarse estimate may overshoot where the image says little: nearest pose inside the
/// uncertainty.
Pose Localizer::pulledBack(const Pose& camera_from_station) const {
  const SeedUncertainty& box = problem_.uncertainty;
  Vector6d offset = offsetAboutPivot(problem_.camera_from_station_seed, camera_from_station,
                                     box.pivot_in_camera_m);
  bool outside = false;
  for (int i = 0; i < 6; ++i) {
    const double limit = i < 3 ? box.rotation_rad[i] : box.translation_m[i - 3];
    outside = outside || std::abs(offset[i]) > limit;
    offset[i] = std::clamp(offset[i], -limit, limit);
  }
  if (!outside) return camera_from_station;
  return displacedAboutPivot(problem_.camera_from_station_seed, offset, box.pivot_in_camera_m);
}

const PosePrior* Localizer::anchor() const { return options_.loop.anchored ? &anchor_ : nullptr; }

StepReport Localizer::stepSupport() {
  const Iteration& now = buffers_[static_cast<std::size_t>(current_)];
  workspace_.support = measureEdgeSupport(now.render, now.level, workspace_.edges, problem_.image,
                                          problem_.ignore, options_.support);
  digest_.tag("support");
  digest_.i32(workspace_.support.rendered);
  digest_.i32(workspace_.support.covered);
  digest_.i32(workspace_.support.displaced);
  digest_.i32(workspace_.support.displaced_covered);
  digest_.i32(workspace_.support.seen);
  digest_.i32(workspace_.support.explained);
  digest_.i32(workspace_.support.displaced_explained);
  const bool supported =
      !options_.support.gate || workspace_.support.share() >= options_.support.min_support;
  if (!supported) {
    StepReport failed = fail(Stage::kSupport, LocalizationStatus::kNotSupported);
    failed.iteration_complete = false;  // it was reported when its pose came out
    return failed;
  }
  finish(LocalizationStatus::kConverged);
  StepReport made = report(Stage::kSupport, true);
  made.finished = true;
  return made;
}

StepReport Localizer::fail(Stage stage, LocalizationStatus status) {
  Iteration& now = buffers_[static_cast<std::size_t>(current_)];
  now.status = status;
  StepReport made = report(stage, true);
  made.iteration_complete = workspace_.iteration != nullptr;  // a fault may come before the first
  // One whose pose came out has been counted.
  if (made.iteration_complete && now.index == workspace_.iterations) ++workspace_.iterations;
  if (status != LocalizationStatus::kFault && attempt_ + 1 < options_.loop.max_attempts) {
    startAttempt();
    return made;
  }
  finish(status);
  made.finished = true;
  return made;
}

/// From the seed again, with other templates and other samples: what failed may have been one of
/// them.
void Localizer::startAttempt() {
  ++attempt_;
  workspace_.attempts = attempt_ + 1;
  iteration_ = 0;
  small_corrections_ = 0;
  camera_from_station_ = problem_.camera_from_station_seed;
  iteration_pending_ = true;
}

double Localizer::templateFactor() const {
  constexpr double kFactors[3] = {1.0, 2.0, 0.5};
  return kFactors[std::min(attempt_, 2)];
}

StepReport Localizer::faulted(Stage stage, Status fault) {
  workspace_.fault = fault;
  return fail(stage, LocalizationStatus::kFault);
}

void Localizer::finish(LocalizationStatus status) {
  workspace_.status = status;
  const bool converged = status == LocalizationStatus::kConverged;
  workspace_.camera_from_station =
      converged ? camera_from_station_ : problem_.camera_from_station_seed;
  if (converged) workspace_.covariance = covariance_;
  digest_.tag(localizationStatusText(status));
  digestPose(workspace_.camera_from_station, digest_);
  stage_ = Stage::kFinished;
}

void Localizer::measureCorrection(const Pose& before, const Pose& after) {
  Iteration& now = buffers_[static_cast<std::size_t>(current_)];
  if (options_.loop.correction_point == CorrectionPoint::kStation) {
    now.correction_translation_m = (after * bounds_.centre() - before * bounds_.centre()).norm();
  } else {
    now.correction_translation_m =
        (after.inverse().translation_m - before.inverse().translation_m).norm();
  }
  now.correction_image_px = imageDisplacement(before, after);
  now.correction_rotation_rad =
      rotationLog((after.rotation * before.rotation.conjugate()).normalized()).norm();
}

/// Mean displacement of the corners of the scene's box in the image.
double Localizer::imageDisplacement(const Pose& before, const Pose& after) const {
  double sum_px = 0.0;
  int seen = 0;
  for (int corner = 0; corner < 8; ++corner) {
    Eigen::Vector3d point_in_station_m;
    for (int axis = 0; axis < 3; ++axis) {
      point_in_station_m[axis] =
          ((corner >> axis) & 1) != 0 ? bounds_.maximum_m[axis] : bounds_.minimum_m[axis];
    }
    Eigen::Vector2d from_px;
    Eigen::Vector2d to_px;
    if (!project(problem_.camera, before * point_in_station_m, from_px)) continue;
    if (!project(problem_.camera, after * point_in_station_m, to_px)) continue;
    sum_px += (to_px - from_px).norm();
    ++seen;
  }
  return seen > 0 ? sum_px / seen : 1e6;
}

bool Localizer::leftUncertainty(const Pose& camera_from_station) const {
  const Vector6d offset = offsetAboutPivot(problem_.camera_from_station_seed, camera_from_station,
                                           problem_.uncertainty.pivot_in_camera_m);
  for (int i = 0; i < 3; ++i) {
    if (std::abs(offset[i]) > options_.loop.leave_factor * problem_.uncertainty.rotation_rad[i])
      return true;
    if (std::abs(offset[i + 3]) >
        options_.loop.leave_factor * problem_.uncertainty.translation_m[i])
      return true;
  }
  return false;
}

double Localizer::shrinkAt(double factor, int iteration) const {
  double product = 1.0;
  for (int i = 0; i < std::min(iteration, options_.loop.shrink_iterations); ++i) product *= factor;
  return product;
}

SeedUncertainty Localizer::uncertaintyAt(int iteration, const Pose& camera_from_station) const {
  SeedUncertainty now =
      scaled(problem_.uncertainty, shrinkAt(options_.loop.uncertainty_shrink, iteration));
  // The pivot belongs to the scene: it goes where the hypothesis takes it, unless it is the
  // camera's centre.
  if (problem_.uncertainty.pivot_in_camera_m.squaredNorm() > 0.0) {
    now.pivot_in_camera_m = camera_from_station * (problem_.camera_from_station_seed.inverse() *
                                                   problem_.uncertainty.pivot_in_camera_m);
  }
  return now;
}

bool Localizer::isRefinement(int iteration) const {
  return options_.refinement.enabled && iteration >= options_.loop.match_iterations;
}

int Localizer::levelOf(IterationKind kind, int iteration) const {
  return kind == IterationKind::kMatch && iteration == 0 ? coarse_level_ : fine_level_;
}

int Localizer::rolledHypotheses() const {
  // Each render serves half a spacing to either side.
  const double half_rad = 0.5 * options_.loop.roll_spacing_rad;
  const double uncovered_rad = problem_.uncertainty.rotation_rad.z() - half_rad;
  int count = 1;
  while (count + 2 <= options_.loop.max_rolled_hypotheses && (count - 1) * half_rad < uncovered_rad)
    count += 2;
  return count;
}

double Localizer::featureSize() const {
  return options_.templates.feature_size_m > 0.0 ? options_.templates.feature_size_m
                                                 : bounds_.diagonal() / 8.0;
}

}  // namespace boresight
