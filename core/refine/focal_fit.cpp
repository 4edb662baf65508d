// SPDX-License-Identifier: Apache-2.0
#include "core/refine/focal_fit.h"

#include <cmath>

#include "core/base/nth.h"
#include "core/refine/error_groups.h"

namespace boresight {
namespace {

/// The focal length is undetermined when the pose explains all but this share of it.
constexpr double kLeastFocalShare = 1e-9;

/// Sums of the errors of one unknown over the groups of one way of grouping.
template <std::size_t N>
class ScalarGroups {
 public:
  void add(int group, double error) { nth(sums_, group) += error; }
  /// The squares, weighted by G / (G - 1) for G non-empty groups; 0 for fewer than two.
  double squares() const {
    double squares = 0.0;
    int filled = 0;
    for (const double sum : sums_) {
      if (sum == 0.0) continue;
      ++filled;
      squares += sum * sum;
    }
    return filled < 2 ? 0.0 : squares * filled / (filled - 1);
  }

 private:
  std::array<double, N> sums_{};
};

}  // namespace

/// H and g of the pose and the focal length.
struct FocalFitter::Sums {
  Matrix6d pose = Matrix6d::Zero();  ///< the lower triangle
  Vector6d mixed = Vector6d::Zero();
  double focal = 0.0;
  Vector6d pose_gradient = Vector6d::Zero();
  double focal_gradient = 0.0;
};

Status FocalFitter::create(std::int32_t max_samples, Arena& arena) {
  residuals_ = arena.allocate<float>(max_samples);
  return arena.exhausted() ? Status::kArenaTooSmall : Status::kOk;
}

void FocalFitter::begin(const Camera& camera, const RefinementResult& refined) {
  camera_ = camera;
  refined_ = &refined;
  camera_from_station_ = PoseMatrix(refined.camera_from_station);
  round_ = 0;
  xi_ = Vector6d::Zero();
  fit_ = {};
}

bool FocalFitter::step() {
  Sums sums;
  fit_.determined = false;
  if (!measureScale()) return true;
  weigh(sums);
  if (!solve(sums)) return true;
  if (++round_ < kRounds) return false;
  measureSigma();
  return true;
}

/// False for samples without an edge.
bool FocalFitter::rowOf(const EdgeSample& sample, Row& row) const {
  if (sample.gradient == 0.0) return false;
  const Eigen::Vector3d point_m = camera_from_station_ * sample.point_in_station_m;
  Eigen::Matrix<double, 2, 3> jacobian;
  if (!projectWithJacobian(camera_, point_m, row.pixel, jacobian)) return false;
  row.by_pose = lineRow(point_m, sample.normal(), jacobian);
  row.by_focal = sample.normal().dot(row.pixel - Eigen::Vector2d(camera_.cx, camera_.cy));
  row.residual_px = sample.residual_px - row.by_pose.dot(xi_) - row.by_focal * fit_.change;
  return true;
}

/// The residuals' robust scale. False when there are too few.
bool FocalFitter::measureScale() {
  std::size_t count = 0;
  box_px_.setEmpty();
  Row row;
  for (std::int32_t i = 0; i < refined_->sample_count; ++i) {
    if (!rowOf(nth(refined_->samples, i), row)) continue;
    residuals_[count++] = static_cast<float>(std::abs(row.residual_px));
    box_px_.extend(row.pixel);
  }
  if (count < EdgeRefinement::kMinFound) return false;
  cut_px_ = kTukey * robustScale_px(residuals_.first(count));
  return true;
}

double FocalFitter::weightOf(const EdgeSample& sample, const Row& row) const {
  const double ratio = row.residual_px / cut_px_;
  if (!(std::abs(ratio) < 1.0)) return 0.0;
  return EdgeRefinement::shareOf(sample) * (1.0 - ratio * ratio) * (1.0 - ratio * ratio);
}

void FocalFitter::weigh(Sums& sums) const {
  Row row;
  for (std::int32_t i = 0; i < refined_->sample_count; ++i) {
    const EdgeSample& sample = nth(refined_->samples, i);
    if (!rowOf(sample, row)) continue;
    const double weight = weightOf(sample, row);
    for (int a = 0; a < 6; ++a) {
      const double weighted = weight * row.by_pose[a];
      for (int b = 0; b <= a; ++b) sums.pose(a, b) += weighted * row.by_pose[b];
      sums.mixed[a] += weighted * row.by_focal;
      sums.pose_gradient[a] += weighted * row.residual_px;
    }
    sums.focal += weight * row.by_focal * row.by_focal;
    sums.focal_gradient += weight * row.by_focal * row.residual_px;
  }
}

/// A Gauss-Newton step, the pose eliminated first. False when the edges do not determine all
/// unknowns.
bool FocalFitter::solve(const Sums& sums) {
  Matrix6d covariance;
  if (!invert(sums.pose, covariance)) return false;
  coupling_ = covariance * sums.mixed;
  information_ = sums.focal - sums.mixed.dot(coupling_);
  if (!(information_ > kLeastFocalShare * sums.focal)) return false;
  const double change = (sums.focal_gradient - coupling_.dot(sums.pose_gradient)) / information_;
  fit_.change += change;
  xi_ += covariance * (sums.pose_gradient - sums.mixed * change);
  return std::abs(fit_.change) < 1.0 && xi_.squaredNorm() < 1.0;
}

/// With the weights in place of the slopes of Tukey's influence, sigma alone would be 1.2 times too
/// small; errors that are counted in each of three ways of grouping make up for it. An error that
/// all edges share beyond kCommonOffset_px is not in it: right cameras of photographs are up to 3.5
/// sigma off.
void FocalFitter::measureSigma() {
  ScalarGroups<ErrorGroups::kByPlace> by_place;
  ScalarGroups<ErrorGroups::kBySide> by_side;
  ScalarGroups<ErrorGroups::kByKind> by_kind;
  Eigen::Vector3d common = Eigen::Vector3d::Zero();
  Row row;
  for (std::int32_t i = 0; i < refined_->sample_count; ++i) {
    const EdgeSample& sample = nth(refined_->samples, i);
    if (!rowOf(sample, row)) continue;
    const double slope = weightOf(sample, row) * (row.by_focal - coupling_.dot(row.by_pose));
    const double error = slope * row.residual_px;
    const std::array<int, 3> groups =
        ErrorGroups::groupsOf(groupedError(sample, row.pixel, box_px_));
    by_place.add(groups[0], error);
    by_side.add(groups[1], error);
    by_kind.add(groups[2], error);
    common += slope * Eigen::Vector3d(1.0, sample.normal().x(), sample.normal().y());
  }
  const double squares =
      by_place.squares() + by_side.squares() + by_kind.squares() +
      ErrorGroups::kCommonOffset_px * ErrorGroups::kCommonOffset_px * common.squaredNorm();
  fit_.sigma = std::sqrt(squares) / information_;
  fit_.determined = fit_.sigma > 0.0;
}

}  // namespace boresight
