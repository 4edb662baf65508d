// SPDX-License-Identifier: Apache-2.0
// Input to a pass from outside: matches of other methods, and the pose of several views.
#include <algorithm>
#include <cmath>

#include "core/base/math.h"
#include "core/localizer/pass.h"
#include "core/localizer/run_digest.h"

namespace boresight {
namespace {

/// A score as counts from which whsScore() gives it back: records and views keep counts.
constexpr std::int32_t kScoreNorm = 1000000;

WhsCounts countsOf(double score) {
  const double clamped = score > 0.0 ? std::min(score, 2.0) : 0.0;  // NaN is 0
  return {static_cast<std::int32_t>(std::floor(clamped * kScoreNorm + 0.5)), 0};
}

bool isUsable(const SuppliedMatch& supplied, const Camera& camera) {
  return supplied.found && supplied.item.point_in_station_m.allFinite() && supplied.x >= -0.5 &&
         supplied.x <= camera.width - 0.5 && supplied.y >= -0.5 &&
         supplied.y <= camera.height - 0.5;
}

/// The item with its centre inside the render.
Template insideOf(const Camera& camera, Template item) {
  item.center_x = std::clamp(item.center_x, 0, camera.width - 1);
  item.center_y = std::clamp(item.center_y, 0, camera.height - 1);
  return item;
}

Match matchOf(const SuppliedMatch& supplied, const Camera& camera) {
  Match match;
  match.window = supplied.window;
  if (!isUsable(supplied, camera)) return match;
  match.norms = {kScoreNorm, 0};
  match.x = supplied.x;
  match.y = supplied.y;
  match.peak.x = nearestInt(supplied.x);
  match.peak.y = nearestInt(supplied.y);
  match.peak.counts = countsOf(supplied.score);
  match.peak.has_second = supplied.has_second;
  if (supplied.has_second) match.peak.second_counts = countsOf(supplied.second_score);
  match.searched = true;
  match.at_border = match.window.endsAt(match.peak.x, match.peak.y);
  return match;
}

}  // namespace

void Pass::matchOutside(const SurfaceRender& surfaces) {
  match_outside_ = true;
  surfaces_ = surfaces;
  digest_.tag("matches from outside");
}

Status Pass::supplyMatches(std::span<const SuppliedMatch> supplied) {
  if (needs() != PassNeed::kMatches) return Status::kInvalidOption;
  Iteration& iteration = record();
  if (supplied.size() > iteration.matches.matches.size()) return Status::kCapacityExceeded;
  for (std::size_t i = 0; i < supplied.size(); ++i) {
    iteration.templates.templates[i] = insideOf(iteration.render.camera, supplied[i].item);
    iteration.matches.matches[i] = matchOf(supplied[i], iteration.render.camera);
  }
  iteration.templates.count = static_cast<std::int32_t>(supplied.size());
  iteration.matches.count = iteration.templates.count;
  digestTemplates(iteration.templates, digest_);
  matches_supplied_ = true;
  return Status::kOk;
}

void Pass::supplyPose(const JointPose& joint) {
  Iteration& iteration = record();
  const bool solved = joint.status == LocalizationStatus::kRunning;
  const bool matched = failed_ == LocalizationStatus::kRunning;
  iteration.status = joint.status;
  iteration.pnp.camera_from_station =
      solved ? joint.camera_from_station : plan_.camera_from_station;
  iteration.pnp.covariance = joint.covariance;
  iteration.pnp.samples = joint.samples;
  if (!solved || !matched) iteration.pnp.inlier_count = 0;
  if (matched) digestPnp(iteration.pnp, digest_);
  iteration.camera_from_station = iteration.pnp.camera_from_station;
  (void)end(solved || matched ? Stage::kPose : outcome_.reached);
}

/// A refinement round up to its normal equations.
StepReport Pass::stepOutsideRound() {
  TaskList& tasks = memory_.tasks;
  const auto lose = [this] {
    if (failed_ != LocalizationStatus::kRunning) return;
    failed_ = LocalizationStatus::kPnpFailed;
    outcome_.reached = Stage::kRefine;
  };
  if (!stage_begun_) {
    if (beginRefinement() != Status::kOk) lose();
    const bool searches = failed_ == LocalizationStatus::kRunning;
    tasks.open(searches ? memory_.refinement.chunks() : 0);
    return StepReport::of(Stage::kRefine, false);
  }
  for (; tasks.findNext(); tasks.markDone(tasks.next()))
    memory_.refinement.searchChunk(tasks.next());
  tasks.open(0);
  if (memory_.refinement.gather(round_) != Status::kOk) lose();
  solver_waits_ = true;
  return StepReport::of(Stage::kRefine, false);
}

void Pass::endRound(Status status, bool ends) {
  Iteration& iteration = record();
  solver_waits_ = false;
  if (!ends) {
    const bool searches = failed_ == LocalizationStatus::kRunning;
    memory_.tasks.open(searches ? memory_.refinement.chunks() : 0);
    return;
  }
  const bool rendered =
      failed_ == LocalizationStatus::kRunning || outcome_.reached != Stage::kRender;
  if (rendered) digestRefinement(iteration.refinement, digest_);
  const LocalizationStatus failed = rendered ? LocalizationStatus::kPnpFailed : failed_;
  iteration.status = status == Status::kOk ? LocalizationStatus::kRunning : failed;
  iteration.camera_from_station = iteration.refinement.camera_from_station;
  (void)end(status == Status::kOk || rendered ? Stage::kRefine : Stage::kRender);
}

}  // namespace boresight
