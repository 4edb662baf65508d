// SPDX-License-Identifier: Apache-2.0
// One pose from the matches of all views.
#include <algorithm>
#include <cmath>

#include "core/base/nth.h"
#include "core/views/views_localizer.h"

namespace boresight {
namespace {

/// Whether an edge of the template met an edge of the image. Without any edge every place scores as
/// well as the predicted one, so that such matches agree with any hypothesis.
bool meetsEdges(const Match& match) { return match.peak.counts.edge_hits > 0; }

}  // namespace

StepReport ViewsLocalizer::stepPose() {
  Status status = Status::kOk;
  if (!pose_begun_) {
    chooseViews();
    status = beginPose();
    pose_begun_ = true;
    if (status == Status::kOk) return StepReport::of(Stage::kPose, false);
  }
  bool complete = status != Status::kOk;
  if (!complete) status = ransac_.step(complete);
  if (!complete) return StepReport::of(Stage::kPose, false);
  noteInliers();
  if (status == Status::kOk && leaveOutDissenters()) {
    status = beginPose();
    if (status == Status::kOk) return StepReport::of(Stage::kPose, false);
  }
  pose_begun_ = false;
  return supplyPose(status);
}

/// Views with matches for this hypothesis.
void ViewsLocalizer::chooseViews() {
  for (std::size_t v = 0; v < views_.size(); ++v) {
    Share& share = shares()[v];
    share = {};
    if (!takesPart(v)) {
      share.status = LocalizationStatus::kNotSupported;
    } else if (views_[v].pass.failed() != LocalizationStatus::kRunning) {
      share.status = views_[v].pass.failed();
    } else if (views_.size() > 1 && seeing(v) < options_.pnp.min_inliers) {
      share.status = LocalizationStatus::kTooFewMatches;
    }
  }
}

/// Correspondences of a view that rest on edges of its image.
std::int32_t ViewsLocalizer::seeing(std::size_t index) const {
  const Iteration& iteration = *view(static_cast<int>(index)).workspace().iteration;
  std::int32_t count = 0;
  for (std::int32_t i = 0; i < iteration.correspondence_count; ++i) {
    const auto of = static_cast<std::size_t>(nth(iteration.template_of, i));
    count += meetsEdges(iteration.matches.matches[of]) ? 1 : 0;
  }
  return count;
}

/// Starts PnP on the correspondences of the chosen views. All correspondences of a single view
/// count, as in a run of that view alone; of several views only those that rest on edges.
Status ViewsLocalizer::beginPose() {
  const Shares& chosen = shares();
  const auto taking = std::count_if(
      chosen.begin(), chosen.begin() + static_cast<std::ptrdiff_t>(views_.size()),
      [](const Share& share) { return share.status == LocalizationStatus::kRunning; });
  std::int32_t end = 0;
  for (std::size_t v = 0; v < views_.size(); ++v) {
    pnp_views_[v] = {&problem_.views[v].camera, views_[v].camera_from_first, end};
    shares()[v].correspondences = 0;
    if (chosen[v].status == LocalizationStatus::kRunning) collect(v, taking == 1);
    end = pnp_views_[v].end;
  }
  const auto count = static_cast<std::size_t>(end);
  const Iteration& iteration = leading();
  const PosePrior hypothesis{iteration.camera_from_station_before, iteration.uncertainty};
  return ransac_.begin(correspondences_.first(count), std::span(pnp_views_).first(views_.size()),
                       hypothesis, iteration.threshold_px, options_.pnp, pnp_);
}

void ViewsLocalizer::collect(std::size_t index, bool all) {
  const Iteration& iteration = *view(static_cast<int>(index)).workspace().iteration;
  std::int32_t& end = pnp_views_[index].end;
  for (std::int32_t i = 0; i < iteration.correspondence_count; ++i) {
    const auto own = static_cast<std::size_t>(i);
    const auto of = static_cast<std::size_t>(iteration.template_of[own]);
    if (!all && !meetsEdges(iteration.matches.matches[of])) continue;
    nth(correspondences_, end) = iteration.correspondences[own];
    nth(own_index_, end) = i;
    ++end;
    ++shares()[index].correspondences;
  }
}

void ViewsLocalizer::noteInliers() {
  std::int32_t begin = 0;
  for (std::size_t v = 0; v < views_.size(); ++v) {
    shares()[v].inliers = 0;
    for (std::int32_t i = begin; i < pnp_views_[v].end; ++i)
      shares()[v].inliers += nth(pnp_.inlier, i);
    begin = pnp_views_[v].end;
  }
}

/// Leaves out views whose matches disagree with a pose that other views support; false when there
/// are none.
bool ViewsLocalizer::leaveOutDissenters() {
  const std::int32_t enough = options_.pnp.min_inliers;
  const std::span<Share> all = std::span(shares()).first(views_.size());
  const bool carried = std::any_of(all.begin(), all.end(),
                                   [&](const Share& share) { return share.inliers >= enough; });
  bool left_out = false;
  for (Share& share : all) {
    const bool dissents = share.status == LocalizationStatus::kRunning && share.inliers < enough;
    if (!carried || !dissents) continue;
    share.status = LocalizationStatus::kPnpFailed;
    left_out = true;
  }
  return left_out;
}

StepReport ViewsLocalizer::supplyPose(Status status) {
  JointPose joint;
  Agreement agreement;
  const bool solved = status == Status::kOk;
  for (const Share& share : std::span(shares()).first(views_.size())) {
    agreement.inliers += solved ? share.inliers : 0;
    agreement.correspondences += share.correspondences;
  }
  // With no view left, the first view's reason is reported.
  const LocalizationStatus own = first().failed();
  if (solved)
    joint.status = LocalizationStatus::kRunning;
  else if (agreement.correspondences == 0 && own != LocalizationStatus::kRunning)
    joint.status = own;
  joint.samples = pnp_.samples;
  for (std::size_t v = 0; v < views_.size(); ++v) {
    Pass& pass = views_[v].pass;
    if (pass.needs() != PassNeed::kPose) continue;
    fillSolution(v, status);
    joint.camera_from_station =
        poseOfView(std::span(pnp_views_).first(views_.size()), v, pnp_.camera_from_station);
    joint.covariance =
        v == 0 ? pnp_.covariance : covarianceIn(views_[v].camera_from_first, pnp_.covariance);
    pass.supplyPose(joint);
  }
  const Ruling ruling =
      attempt_.take(first().outcome(), agreement, first().context(), first().memory().records);
  latest_ = nth(shares_, ruling.record);
  chooseRefining();
  return decide(ruling);
}

/// Inliers and residuals of the view's own list. Correspondences left out are not inliers.
void ViewsLocalizer::fillSolution(std::size_t index, Status status) {
  PnpSolution& own = views_[index].pass.record().pnp;
  const Iteration& iteration = *view(static_cast<int>(index)).workspace().iteration;
  const auto count = static_cast<std::size_t>(iteration.correspondence_count);
  own.inlier = {own.inlier.data(), count};
  own.residual_px = {own.residual_px.data(), count};
  std::fill(own.inlier.begin(), own.inlier.end(), std::uint8_t{0});
  std::fill(own.residual_px.begin(), own.residual_px.end(), 1e6);
  own.inlier_count = status == Status::kOk ? shares()[index].inliers : 0;
  double sum_px2 = 0.0;
  const std::int32_t begin = index == 0 ? 0 : pnp_views_[index - 1].end;
  for (std::int32_t i = begin; i < pnp_views_[index].end; ++i) {
    const auto from = static_cast<std::size_t>(i);
    const auto to = static_cast<std::size_t>(own_index_[from]);
    own.inlier[to] = pnp_.inlier[from];
    own.residual_px[to] = pnp_.residual_px[from];
    if (own.inlier[to] != 0) sum_px2 += own.residual_px[to] * own.residual_px[to];
  }
  // All inliers, or some of them.
  const std::int32_t inliers = shares()[index].inliers;
  own.rms_px = inliers == pnp_.inlier_count ? pnp_.rms_px
               : inliers > 0                ? std::sqrt(sum_px2 / inliers)
                                            : 0.0;
}

}  // namespace boresight
