// SPDX-License-Identifier: Apache-2.0
// The wide search: restarts, then the best of them once more one level finer, and from there on the
// loop as from any seed.
#include <algorithm>

#include "core/localizer/localizer.h"
#include "core/localizer/pose_change.h"
#include "core/localizer/run_digest.h"
#include "core/localizer/schedule.h"

namespace boresight {

void Localizer::layOutWideSearch() {
  const bool coarser = wide_level_ != coarse_level_;
  for (std::size_t i = 0; i < wide_render_.size(); ++i)
    wide_render_[i] = coarser ? createRender(wide_level_) : coarse_render_[i];
  evidence_render_[1] = createRender(coarse_level_);
  evidence_render_[0] = coarser ? createRender(wide_level_) : evidence_render_[1];
  restarts_ =
      kept_.allocate<HypothesisSummary>(static_cast<std::size_t>(options_.wide.max_restarts));
  finalists_ = kept_.allocate<HypothesisSummary>(static_cast<std::size_t>(options_.wide.finalists));
}

int Localizer::restartCount() const {
  return wide_round_ == WideRound::kRestarts ? grid_.count() : finalist_count_;
}

void Localizer::placeRestart(Iteration& now) {
  const auto index = static_cast<std::size_t>(hypothesis_);
  const bool first = wide_round_ == WideRound::kRestarts;
  camera_from_station_ = first ? grid_.poseOf(hypothesis_) : finalists_[index].camera_from_station;
  now.kind = IterationKind::kMatch;
  now.level = first ? wide_level_ : coarse_level_;
  now.camera_from_station_before = camera_from_station_;
  now.uncertainty =
      first ? grid_.uncertaintyOf(hypothesis_) : grid_.uncertaintyAfter(camera_from_station_);
  now.threshold_px = thresholdAt(options_, 0, now.level) * (1 << (now.level - coarse_level_));
  now.render = (first ? wide_render_ : coarse_render_)[static_cast<std::size_t>(current_)];
  now.hypothesis_count = 0;
}

/// The pose that came out is rendered and compared with the image: matches alone may agree on
/// somebody else's edges.
StepReport Localizer::beginEvidence() {
  Iteration& now = buffers_[static_cast<std::size_t>(current_)];
  now.camera_from_station = pulledBack(PosePrior{now.camera_from_station_before, now.uncertainty},
                                       now.pnp.camera_from_station);
  EdgeRender& render = evidence_render_[wide_round_ == WideRound::kRestarts ? 0 : 1];
  const Status status =
      renderer_.begin(rays_[static_cast<std::size_t>(now.level)], now.camera_from_station, render);
  if (status != Status::kOk) return faulted(Stage::kPose, status);
  weighing_ = true;
  openPieces(renderer_.pieces());
  return StepReport::of(Stage::kPose, false);
}

StepReport Localizer::stepEvidence() {
  bool complete = false;
  const Status status = continueRender(complete);
  if (status != Status::kOk) return faulted(Stage::kPose, status);
  if (!complete) return StepReport::of(Stage::kPose, false);
  weighing_ = false;
  const Iteration& now = buffers_[static_cast<std::size_t>(current_)];
  const EdgeRender& render = evidence_render_[wide_round_ == WideRound::kRestarts ? 0 : 1];
  return finishRestart(Stage::kPose,
                       measureEdgeSupport(render, now.level, workspace_.edges, problem_.image,
                                          problem_.ignore, options_.support));
}

void Localizer::noteRestart(const EdgeSupport& support) {
  const Iteration& now = buffers_[static_cast<std::size_t>(current_)];
  const auto index = static_cast<std::size_t>(hypothesis_);
  const bool first = wide_round_ == WideRound::kRestarts;
  const std::span<HypothesisSummary> noted = first ? restarts_ : finalists_;
  HypothesisSummary summary = summaryOf(now);
  summary.roll_rad = first ? grid_.turnOf_rad(hypothesis_) : noted[index].roll_rad;
  summary.depth_offset_m = first ? grid_.depthOffsetOf_m(hypothesis_) : noted[index].depth_offset_m;
  summary.camera_from_station =
      summary.solved ? now.camera_from_station : now.camera_from_station_before;
  if (summary.solved) {
    const Evidence evidence = evidenceOf(now, support);
    summary.support = support.share();
    summary.inlier_nats = evidence.inliers;
    summary.edge_nats = evidence.edges;
  }
  noted[index] = summary;
  for (Iteration& buffer : buffers_) buffer.restarts = noted.first(index + 1);
  digestEvidence(summary, support, digest_);
}

StepReport Localizer::finishRestart(Stage stage, const EdgeSupport& support) {
  reached_[static_cast<std::size_t>(current_)] = stage;
  noteRestart(support);
  const int other = 1 - current_;
  Iteration& now = buffers_[static_cast<std::size_t>(current_)];
  Iteration& best = buffers_[static_cast<std::size_t>(other)];
  const auto summary = [&now](int index) -> const HypothesisSummary& {
    return now.restarts[static_cast<std::size_t>(index)];
  };
  const HypothesisSummary& made = summary(hypothesis_);
  const bool better =
      !has_best_ || (made.solved && (!summary(best.chosen_hypothesis).solved ||
                                     made.evidence() > summary(best.chosen_hypothesis).evidence()));
  if (better) now.chosen_hypothesis = hypothesis_;
  const int kept = better ? current_ : other;
  ++hypothesis_;
  if (hypothesis_ < restartCount()) {
    has_best_ = true;
    current_ = 1 - kept;
    hypothesis_pending_ = true;
    return StepReport::of(stage, true);
  }
  current_ = kept;
  return finishWideRound();
}

StepReport Localizer::finishWideRound() {
  Iteration& chosen = buffers_[static_cast<std::size_t>(current_)];
  workspace_.iteration = &chosen;
  camera_from_station_ = chosen.camera_from_station_before;
  if (chosen.status != LocalizationStatus::kRunning)
    return fail(reached_[static_cast<std::size_t>(current_)], chosen.status);
  measureCorrection(camera_from_station_, chosen.camera_from_station);
  ++workspace_.iterations;
  if (wide_round_ == WideRound::kRestarts) {
    chooseRestarts();
    wide_round_ = WideRound::kFinalists;
    iteration_pending_ = true;
  } else {
    wide_round_ = WideRound::kNone;
    startFinalist(chosen.chosen_hypothesis);
  }
  StepReport made = StepReport::of(Stage::kPose, true);
  made.iteration_complete = true;
  return made;
}

void Localizer::chooseRestarts() {
  constexpr double kDistinct_px = 6.0;  // of the level: nearer ones end at the same place
  std::array<std::int32_t, 9> chosen{};
  const auto restarts = restarts_.first(static_cast<std::size_t>(grid_.count()));
  finalist_count_ =
      chooseFinalists(restarts, bounds_, problem_.camera, kDistinct_px * (1 << wide_level_),
                      std::span(chosen).first(finalists_.size()));
  for (int i = 0; i < finalist_count_; ++i) {
    const auto index = static_cast<std::size_t>(i);
    finalists_[index] = restarts_[static_cast<std::size_t>(chosen[index])];
  }
}

/// -1: none.
int Localizer::bestFinalistLeft() const {
  int best = -1;
  for (int i = 0; i < finalist_count_; ++i) {
    const HypothesisSummary& one = finalists_[static_cast<std::size_t>(i)];
    const bool used = ((finalists_used_ >> i) & 1U) != 0;
    if (used || !one.solved) continue;
    if (best < 0 || one.evidence() > finalists_[static_cast<std::size_t>(best)].evidence())
      best = i;
  }
  return best;
}

/// The finalist's iteration was the attempt's first, as far as there are two that match.
void Localizer::startFinalist(int finalist) {
  finalists_used_ |= 1U << finalist;
  camera_from_station_ = finalists_[static_cast<std::size_t>(finalist)].camera_from_station;
  started_.camera_from_station_seed = camera_from_station_;
  started_.uncertainty = grid_.uncertaintyAfter(camera_from_station_);
  constexpr double kUniform = 0.57735026918962576;  // half-width to standard deviation
  anchor_ = {camera_from_station_, scaled(started_.uncertainty, kUniform)};
  iteration_ = options_.loop.match_iterations > 1 ? 1 : 0;
  small_corrections_ = 0;
  iteration_pending_ = true;
}

}  // namespace boresight
