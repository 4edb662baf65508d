// SPDX-License-Identifier: Apache-2.0
#include "core/localizer/global_search.h"

#include <array>

#include "core/localizer/pose_change.h"
#include "core/localizer/run_digest.h"
#include "core/localizer/schedule.h"

namespace boresight {

GlobalSearch::GlobalSearch(const LocalizationProblem& problem, const RunContext& run,
                           std::span<HypothesisSummary> restarts,
                           std::span<HypothesisSummary> finalists)
    : restarts_(restarts), finalists_(finalists) {
  if (!run.options.wide.isOn()) return;
  grid_ = RestartGrid(problem, run.scene, run.options.wide);
  round_ = Round::kRestarts;
}

PassPlan GlobalSearch::plan(const RunContext& run) const {
  const bool first = round_ == Round::kRestarts;
  PassPlan plan;
  plan.kind = PassKind::kMatch;
  plan.record = record_;
  plan.level = first ? run.levels.global : run.levels.coarse;
  plan.camera_from_station = first
                                 ? grid_.poseOf(place_)
                                 : finalists_[static_cast<std::size_t>(place_)].camera_from_station;
  plan.uncertainty =
      first ? grid_.uncertaintyOf(place_) : grid_.uncertaintyAfter(plan.camera_from_station);
  plan.threshold_px =
      thresholdAt(run.options, 0, plan.level) * (1 << (plan.level - run.levels.coarse));
  plan.measures_support = true;
  return plan;
}

Ruling GlobalSearch::take(const PassOutcome& outcome, const RunContext& run,
                          std::span<Iteration, 2> records, DigestWriter& digest) {
  reached_[record_] = outcome.reached;
  note(outcome, records, digest);
  const int other = 1 - record_;
  Iteration& now = records[static_cast<std::size_t>(record_)];
  const Iteration& best = records[static_cast<std::size_t>(other)];
  const HypothesisSummary& latest = now.restarts[static_cast<std::size_t>(place_)];
  const HypothesisSummary& leading =
      now.restarts[static_cast<std::size_t>(has_best_ ? best.chosen_hypothesis : place_)];
  const bool better =
      !has_best_ || (latest.solved && (!leading.solved || latest.evidence() > leading.evidence()));
  if (better) now.chosen_hypothesis = place_;
  const int kept = better ? record_ : other;
  ++place_;
  if (place_ < count()) {
    const int shown = record_;
    has_best_ = true;
    record_ = 1 - kept;
    return {Ruling::Next::kPass, LocalizationStatus::kRunning, outcome.reached, false, shown};
  }
  record_ = kept;
  return finishRound(run, records[static_cast<std::size_t>(kept)]);
}

void GlobalSearch::note(const PassOutcome& outcome, std::span<Iteration, 2> records,
                        DigestWriter& digest) {
  const Iteration& now = records[static_cast<std::size_t>(record_)];
  const auto index = static_cast<std::size_t>(place_);
  const bool first = round_ == Round::kRestarts;
  const std::span<HypothesisSummary> noted = first ? restarts_ : finalists_;
  HypothesisSummary summary = summaryOf(now);
  summary.roll_rad = first ? grid_.turnOf_rad(place_) : noted[index].roll_rad;
  summary.depth_offset_m = first ? grid_.depthOffsetOf_m(place_) : noted[index].depth_offset_m;
  summary.camera_from_station =
      summary.solved ? now.camera_from_station : now.camera_from_station_before;
  if (summary.solved) {
    const Evidence evidence = evidenceOf(now, outcome.support);
    summary.support = outcome.support.share();
    summary.inlier_nats = evidence.inliers;
    summary.edge_nats = evidence.edges;
  }
  noted[index] = summary;
  for (Iteration& record : records) record.restarts = noted.first(index + 1);
  digestEvidence(summary, outcome.support, digest);
}

Ruling GlobalSearch::finishRound(const RunContext& run, Iteration& chosen) {
  Ruling ruling{Ruling::Next::kPass, LocalizationStatus::kRunning, Stage::kPose, true, record_};
  if (chosen.status != LocalizationStatus::kRunning) {
    ruling.next = Ruling::Next::kFailed;
    ruling.status = chosen.status;
    ruling.stage = reached_[record_];
    return ruling;
  }
  measureCorrection(chosen.camera_from_station_before, chosen.camera_from_station, run, chosen);
  if (round_ == Round::kRestarts) {
    chooseRestarts(run);
    round_ = Round::kFinalists;
    place_ = 0;
    record_ = 0;
    has_best_ = false;
  } else {
    round_ = Round::kNone;
    ruling.next = Ruling::Next::kPose;
  }
  return ruling;
}

void GlobalSearch::chooseRestarts(const RunContext& run) {
  constexpr double kDistinct_px = 6.0;  // of the level: nearer ones end at the same place
  std::array<std::int32_t, 9> chosen{};
  const auto restarts = restarts_.first(static_cast<std::size_t>(grid_.count()));
  finalist_count_ =
      chooseFinalists(restarts, run.scene, run.camera, kDistinct_px * (1 << run.levels.global),
                      std::span(chosen).first(finalists_.size()));
  for (int i = 0; i < finalist_count_; ++i) {
    const auto index = static_cast<std::size_t>(i);
    finalists_[index] = restarts_[static_cast<std::size_t>(chosen[index])];
  }
}

/// -1: none.
int GlobalSearch::bestFinalist() const {
  int best = -1;
  for (int i = 0; i < finalist_count_; ++i) {
    const HypothesisSummary& finalist = finalists_[static_cast<std::size_t>(i)];
    const bool used = ((finalists_used_ >> i) & 1U) != 0;
    if (used || !finalist.solved) continue;
    if (best < 0 || finalist.evidence() > finalists_[static_cast<std::size_t>(best)].evidence())
      best = i;
  }
  return best;
}

/// The finalist's pass was the first iteration, if there are two that match.
Attempt GlobalSearch::nextAttempt(int index, const LocalizerOptions& options) {
  const int best = bestFinalist();
  finalists_used_ |= 1U << best;
  const Pose& pose = finalists_[static_cast<std::size_t>(best)].camera_from_station;
  return Attempt(index, {pose, grid_.uncertaintyAfter(pose)},
                 options.loop.match_iterations > 1 ? 1 : 0);
}

}  // namespace boresight
