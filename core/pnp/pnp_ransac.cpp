// SPDX-License-Identifier: Apache-2.0
#include "core/pnp/pnp_ransac.h"

#include <algorithm>
#include <cmath>

#include "core/base/nth.h"
#include "core/pnp/epnp.h"
#include "core/pnp/refine_pose.h"

namespace boresight {
namespace {

constexpr double kNoCost = 1e300;            ///< above every score
constexpr double kMissingResidual_px = 1e6;  ///< residual of a point that does not project
constexpr int kFewestInliersToRefit = 4;
constexpr int kGuidedSteps = 3;
constexpr int kLocalSteps = 5;
constexpr int kRefineRounds = 20;
constexpr int kProjectionsPerStep = 32768;  ///< about a millisecond
constexpr int kMaxSamplesPerStep = 64;
/// A guided sample of three needs fewer draws than one of four.
constexpr int kSampleSize = 3;
/// Four points may have several poses (EPnP's null space has four dimensions).
constexpr int kEpnpSampleSize = 5;
/// RANSAC ends at this probability of having drawn a sample without outliers.
constexpr double kConfidence = 0.999;
/// Refits on the inliers after each new best sample, at most.
constexpr int kLocalOptimizations = 3;
/// The prior's sigma in guided samples as a multiple of the uncertainty: weak against three
/// matches.
constexpr double kPriorFactor = 3.0;
/// Steps of a refit of the result, at most.
constexpr int kRefineSteps = 20;
constexpr int kMostRedraws = 32;

/// The pose of the first view, ready to be applied in each of them.
class Transforms {
 public:
  Transforms(std::span<const PnpView> views, const Pose& first_from_station) : views_(views) {
    for (std::size_t v = 0; v < views.size(); ++v)
      transform_[v] = PoseMatrix(poseOfView(views, v, first_from_station));
  }
  const PoseMatrix& of(std::size_t view) const { return transform_[view]; }
  /// Squared distance between pixel and projection; 1e12 px^2 where a point does not project.
  double squaredResidual(std::span<const Correspondence> correspondences, std::size_t i) const {
    const std::size_t view = viewOf(views_, i);
    const Correspondence& item = correspondences[i];
    Eigen::Vector2d projection;
    if (!project(*views_[view].camera, transform_[view] * item.point_in_station_m, projection))
      return kMissingResidual_px * kMissingResidual_px;
    return (item.pixel - projection).squaredNorm();
  }

 private:
  std::span<const PnpView> views_;
  std::array<PoseMatrix, kMaxPnpViews> transform_;
};

/// Unit vector from the camera's centre towards the point seen by a pixel. With a moving pupil it
/// depends on the point's depth; the hypothesis gives the depth accurately enough for a sample (a
/// pupil some millimetres off centre, a depth wrong by a tenth: 0.1 mrad at half a metre); scores
/// and refits use exact projection.
bool bearingOf(const Camera& camera, const Correspondence& item, const Pose& camera_from_station,
               Eigen::Vector3d& bearing) {
  Ray ray;
  if (!unprojectRay(camera, item.pixel, ray)) return false;
  bearing = ray.direction;
  if (pupilMoves(camera)) {
    const double depth_m = (camera_from_station * item.point_in_station_m).z() - ray.origin_m.z();
    if (depth_m > 0.0) bearing = ray.at(depth_m);
  }
  bearing.normalize();
  return true;
}

/// base^exponent by squaring: the same bits everywhere, unlike pow and log.
double power(double base, std::int32_t exponent) {
  double result = 1.0;
  for (std::int32_t left = exponent; left > 0; left >>= 1) {
    if ((left & 1) != 0) result *= base;
    base *= base;
  }
  return result;
}

}  // namespace

Status PnpRansac::create(int max_correspondences, Arena& arena) {
  if (max_correspondences < 0) return Status::kInvalidOption;
  const auto count = static_cast<std::size_t>(max_correspondences);
  phase_ = Phase::kIdle;
  status_ = Status::kTooFewPoints;
  usable_ = arena.allocate<std::int32_t>(count);
  place_px_ = arena.allocate<Eigen::Vector2d>(count);
  weight_ = arena.allocate<double>(count);
  selected_ = arena.allocate<std::uint8_t>(count);
  return arena.exhausted() ? Status::kArenaTooSmall : Status::kOk;
}

Status PnpRansac::begin(std::span<const Correspondence> correspondences, const Camera& camera,
                        const PosePrior& hypothesis, double threshold_px, const PnpOptions& options,
                        PnpSolution& solution) {
  camera_ = camera;
  single_ = {&camera_, Pose(), static_cast<std::int32_t>(correspondences.size())};
  return begin(correspondences, std::span(&single_, 1), hypothesis, threshold_px, options,
               solution);
}

Status PnpRansac::begin(std::span<const Correspondence> correspondences,
                        std::span<const PnpView> views, const PosePrior& hypothesis,
                        double threshold_px, const PnpOptions& options, PnpSolution& solution) {
  correspondences_ = correspondences;
  views_ = views;
  hypothesis_ = hypothesis;
  if (!isUsable(hypothesis.camera_from_station)) hypothesis_.camera_from_station = Pose();
  threshold_px_ = threshold_px;
  options_ = options;
  solution_ = &solution;
  samples_ = 0;
  best_ = hypothesis_.camera_from_station;
  best_score_ = {kNoCost, 0};
  const std::size_t count = correspondences.size();
  if (count > usable_.size() || count > solution.inlier.size() ||
      count > solution.residual_px.size()) {
    correspondences_ = {};
    std::fill(solution.inlier.begin(), solution.inlier.end(), std::uint8_t{0});
    std::fill(solution.residual_px.begin(), solution.residual_px.end(), kMissingResidual_px);
    return finish(Status::kCapacityExceeded);
  }
  const Status status = validate(threshold_px, hypothesis);
  if (status != Status::kOk) return finish(status);
  listUsable();
  if (usable_count_ < std::max(options_.min_inliers, sampleSize()))
    return finish(Status::kTooFewPoints);
  prior_ = {hypothesis.camera_from_station, scaled(hypothesis.sigma, kPriorFactor)};
  sampler_.begin(place_px_.first(static_cast<std::size_t>(usable_count_)), sampleSize(),
                 static_cast<std::uint64_t>(options.seed));
  phase_ = Phase::kSampling;
  status_ = Status::kOk;
  return status_;
}

Status PnpRansac::validate(double threshold_px, const PosePrior& hypothesis) const {
  if (firstInvalidOption(options_) != nullptr) return Status::kInvalidOption;
  if (!(threshold_px > 0.0 && threshold_px < kMissingResidual_px)) return Status::kInvalidOption;
  for (const PnpView& view : views_) {
    Camera checked = *view.camera;
    // An unprepared camera has no valid field and projects nothing.
    if (prepareCamera(checked) != Status::kOk || !(view.camera->valid_radius > 0.0))
      return Status::kInvalidCamera;
  }
  return isUsable(hypothesis) ? Status::kOk : Status::kInvalidPose;
}

void PnpRansac::listUsable() {
  const Transforms transforms(views_, hypothesis_.camera_from_station);
  const bool guided = options_.sampler == PnpSampler::kGuided;
  usable_count_ = 0;
  for (std::size_t i = 0; i < correspondences_.size(); ++i) {
    const Correspondence& item = correspondences_[i];
    weight_[i] = 0.0;
    if (!isUsable(item)) continue;
    weight_[i] = 1.0 / (item.sigma_px * item.sigma_px);
    // The spread of a guided sample is judged at the points' projections by the hypothesis, which
    // wrong matches cannot disturb.
    Eigen::Vector2d place = item.pixel;
    Eigen::Vector2d predicted;
    const std::size_t view = viewOf(views_, i);
    if (guided &&
        project(*views_[view].camera, transforms.of(view) * item.point_in_station_m, predicted)) {
      place = predicted;
    }
    nth(usable_, usable_count_) = static_cast<std::int32_t>(i);
    nth(place_px_, usable_count_) = place;
    ++usable_count_;
  }
}

Status PnpRansac::step(bool& done) {
  done = false;
  if (phase_ == Phase::kSampling) {
    const int batch = std::clamp(kProjectionsPerStep / usable_count_, 1, kMaxSamplesPerStep);
    if (samples_ == 0 && options_.sampler == PnpSampler::kGuided) {
      consider(hypothesis_.camera_from_station);
    }
    for (int i = 0; i < batch && !enoughSamples(); ++i) takeSample();
    if (enoughSamples()) phase_ = Phase::kRefining;
    return Status::kOk;
  }
  done = true;
  if (phase_ == Phase::kRefining) return finish(refine());
  return status_;
}

Status PnpRansac::finish(Status status) {
  if (status != Status::kOk) {
    writeSolution(hypothesis_.camera_from_station, false);
  }
  phase_ = Phase::kDone;
  status_ = status;
  return status;
}

std::size_t PnpRansac::viewOfUsable(std::int32_t k) const {
  return viewOf(views_, static_cast<std::size_t>(nth(usable_, k)));
}

const Correspondence& PnpRansac::usable(std::int32_t k) const {
  return nth(correspondences_, nth(usable_, k));
}

int PnpRansac::sampleSize() const {
  return options_.sampler == PnpSampler::kEpnp ? kEpnpSampleSize : kSampleSize;
}

/// Whether all points of a sample are of one view: EPnP solves for one camera.
bool PnpRansac::isOfOneView(const SpreadSampler::Sample& sample) const {
  const auto points = std::span(sample).first(static_cast<std::size_t>(sampleSize()));
  return std::all_of(points.begin(), points.end(),
                     [&](std::int32_t k) { return viewOfUsable(k) == viewOfUsable(sample[0]); });
}

void PnpRansac::takeSample() {
  SpreadSampler::Sample sample = sampler_.draw();
  const bool minimal = options_.sampler != PnpSampler::kGuided;
  for (int i = 0; minimal && i < kMostRedraws && !isOfOneView(sample); ++i)
    sample = sampler_.draw();
  ++samples_;
  switch (options_.sampler) {
    case PnpSampler::kGuided:
      return sampleGuided(sample);
    case PnpSampler::kEpnp:
      return sampleEpnp(sample);
  }
}

void PnpRansac::sampleEpnp(const SpreadSampler::Sample& sample) {
  std::array<Eigen::Vector3d, kEpnpSampleSize> bearing;
  std::array<Eigen::Vector3d, kEpnpSampleSize> point;
  if (!isOfOneView(sample)) return;
  const std::size_t view = viewOfUsable(sample[0]);
  const Pose camera_from_station = poseOfView(views_, view, hypothesis_.camera_from_station);
  for (std::size_t i = 0; i < kEpnpSampleSize; ++i) {
    const Correspondence& item = usable(sample[i]);
    if (!bearingOf(*views_[view].camera, item, camera_from_station, bearing[i])) return;
    point[i] = item.point_in_station_m;
  }
  Pose found;
  if (!solveEpnp(bearing, point, found)) return;
  consider(view == 0 ? found : views_[view].camera_from_first.inverse() * found);
}

void PnpRansac::sampleGuided(const SpreadSampler::Sample& sample) {
  std::array<Correspondence, 4> items;
  std::array<PnpView, kMaxPnpViews> views;
  constexpr std::size_t size = kSampleSize;
  std::size_t taken = 0;
  for (std::size_t v = 0; v < views_.size(); ++v) {
    for (std::size_t i = 0; i < size; ++i)
      if (viewOfUsable(sample[i]) == v) items[taken++] = usable(sample[i]);
    views[v] = {views_[v].camera, views_[v].camera_from_first, static_cast<std::int32_t>(taken)};
  }
  Pose pose = hypothesis_.camera_from_station;
  if (refinePose(std::span(items).first(size), {}, std::span(views).first(views_.size()), &prior_,
                 kGuidedSteps, pose) == Status::kOk) {
    consider(pose);
  }
}

void PnpRansac::consider(const Pose& camera_from_station) {
  Score found;
  if (!score(camera_from_station, best_score_.cost, found)) return;
  best_ = camera_from_station;
  best_score_ = found;
  if (options_.sampler != PnpSampler::kEpnp) optimizeLocally();
}

void PnpRansac::optimizeLocally() {
  const std::span<const std::uint8_t> selected = selected_.first(correspondences_.size());
  for (int round = 0; round < kLocalOptimizations; ++round) {
    std::int32_t count = 0;
    (void)selectInliers(best_, count);  // the result is not used
    if (count < kFewestInliersToRefit) return;
    Pose pose = best_;
    const Status status =
        refinePose(correspondences_, selected, views_, nullptr, kLocalSteps, pose);
    Score found;
    if (status != Status::kOk || !score(pose, best_score_.cost, found)) return;
    best_ = pose;
    best_score_ = found;
  }
}

bool PnpRansac::enoughSamples() const {
  if (samples_ >= options_.max_samples) return true;
  const double share =
      static_cast<double>(best_score_.inliers) / static_cast<double>(usable_count_);
  const double all_missed = power(1.0 - power(share, sampleSize()), samples_);
  return all_missed <= 1.0 - kConfidence;
}

/// False as soon as the cost reaches `limit`: the rest can only add.
bool PnpRansac::score(const Pose& camera_from_station, double limit, Score& result) const {
  const Transforms transforms(views_, camera_from_station);
  const double largest = threshold_px_ * threshold_px_;
  const bool counts_inliers = options_.sampler == PnpSampler::kEpnp;
  double cost = 0.0;
  std::int32_t inliers = 0;
  for (std::int32_t k = 0; k < usable_count_; ++k) {
    const auto i = static_cast<std::size_t>(nth(usable_, k));
    const double squared = transforms.squaredResidual(correspondences_, i);
    const bool inside = squared <= largest;  // false for a NaN
    inliers += inside ? 1 : 0;
    cost += weight_[i] * (!inside ? largest : counts_inliers ? 0.0 : squared);
    if (!(cost < limit)) return false;
  }
  result = {cost, inliers};
  return true;
}

/// Marks the inliers of a pose in selected_; true when that changed anything.
bool PnpRansac::selectInliers(const Pose& camera_from_station, std::int32_t& count) {
  const Transforms transforms(views_, camera_from_station);
  const double largest = threshold_px_ * threshold_px_;
  bool changed = false;
  count = 0;
  for (std::size_t i = 0; i < correspondences_.size(); ++i) {
    const bool inside =
        weight_[i] > 0.0 && transforms.squaredResidual(correspondences_, i) <= largest;
    const std::uint8_t mark = inside ? 1 : 0;
    changed = changed || mark != selected_[i];
    selected_[i] = mark;
    count += mark;
  }
  return changed;
}

Status PnpRansac::refine() {
  if (!(best_score_.cost < kNoCost)) return Status::kDegenerate;
  const std::span<const std::uint8_t> selected = selected_.first(correspondences_.size());
  Pose pose = best_;
  std::int32_t count = 0;
  bool changed = true;
  (void)selectInliers(pose, count);  // regardless of earlier marks
  const int rounds = options_.sampler == PnpSampler::kEpnp ? 1 : kRefineRounds;
  for (int round = 0; round < rounds && changed; ++round) {
    if (count < options_.min_inliers) return Status::kNoConsensus;
    const Status status =
        refinePose(correspondences_, selected, views_, nullptr, kRefineSteps, pose);
    if (status != Status::kOk) return status;
    changed = selectInliers(pose, count);
  }
  if (count < options_.min_inliers) return Status::kNoConsensus;
  Matrix6d covariance;
  const Status status = poseCovariance(correspondences_, selected, views_, pose, covariance);
  if (status != Status::kOk) return status;
  writeSolution(pose, true);
  solution_->covariance = covariance;
  return Status::kOk;
}

/// Fills the solution for a pose; `with_inliers` marks those of selected_, which must be the
/// pose's.
void PnpRansac::writeSolution(const Pose& camera_from_station, bool with_inliers) {
  PnpSolution& solution = *solution_;
  const Transforms transforms(views_, camera_from_station);
  double sum = 0.0;
  solution.camera_from_station = camera_from_station;
  solution.inlier_count = 0;
  solution.covariance = Matrix6d::Zero();
  solution.samples = samples_;
  for (std::size_t i = 0; i < correspondences_.size(); ++i) {
    const double squared = transforms.squaredResidual(correspondences_, i);
    const double residual_px = std::sqrt(squared);
    // Written so that a NaN, too, becomes kMissingResidual_px.
    solution.residual_px[i] = residual_px < kMissingResidual_px ? residual_px : kMissingResidual_px;
    solution.inlier[i] = with_inliers ? selected_[i] : std::uint8_t{0};
    if (solution.inlier[i] == 0) continue;
    ++solution.inlier_count;
    sum += squared;
  }
  solution.rms_px =
      solution.inlier_count > 0 ? std::sqrt(sum / static_cast<double>(solution.inlier_count)) : 0.0;
}

}  // namespace boresight
