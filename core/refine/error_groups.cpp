// SPDX-License-Identifier: Apache-2.0
#include "core/refine/error_groups.h"

#include <algorithm>
#include <cmath>

#include "core/base/nth.h"
#include "core/pnp/normal_equations.h"

namespace boresight {
namespace {

constexpr double kTan22 = 0.41421356237309503;  ///< tan 22.5 deg

}  // namespace

double robustScale_px(std::span<float> absolute_px) {
  const auto middle = absolute_px.begin() + static_cast<std::ptrdiff_t>(absolute_px.size() / 2);
  std::nth_element(absolute_px.begin(), middle, absolute_px.end());
  return std::max(kMinScale_px, kMadToSigma * static_cast<double>(*middle));
}

Status ErrorGroups::create(Arena& arena) {
  scores_ = arena.allocate<Vector6d>(kByPlace + kBySide + kByKind);
  return arena.exhausted() ? Status::kArenaTooSmall : Status::kOk;
}

void ErrorGroups::clear() {
  std::fill(scores_.begin(), scores_.end(), Vector6d::Zero());
  common_.fill(Vector6d::Zero());
}

int ErrorGroups::sectorOf(const Eigen::Vector2d& direction) {
  double along = direction.x();
  double across = direction.y();
  int quarter = 0;
  for (; quarter < 3 && !(along > 0.0 && across >= 0.0); ++quarter) {
    const double turned = across;  // by -90 deg
    across = -along;
    along = turned;
  }
  const int eighth = across < along ? 0 : 2;
  const double low = std::min(along, across);
  const double high = std::max(along, across);
  const bool near_axis = low < kTan22 * high;
  const int within = eighth == 0 ? (near_axis ? 0 : 1) : (near_axis ? 3 : 2);
  return 4 * quarter + within;
}

std::array<int, 3> ErrorGroups::groupsOf(const GroupedError& error) {
  const auto cell = [](double place) {
    return std::clamp(static_cast<int>(place * kCells), 0, kCells - 1);
  };
  const int sector = sectorOf(error.normal);
  return {cell(error.place.x()) * kCells + cell(error.place.y()),
          (sector / 2) * 2 + (error.brighter ? 1 : 0),
          sector * kKinds + (error.kind & (kKinds - 1))};
}

void ErrorGroups::add(const GroupedError& error, double residual_px, const Vector6d& slope) {
  constexpr std::array<int, 3> kFirst = {0, kByPlace, kByPlace + kBySide};
  const std::array<int, 3> groups = groupsOf(error);
  for (std::size_t i = 0; i < groups.size(); ++i)
    nth(scores_, kFirst[i] + groups[i]) += residual_px * slope;
  const double of_blur_px = kOffsetOfBlur * error.blur_px;
  const double outwards_px =
      std::sqrt(kCommonOffset_px * kCommonOffset_px + of_blur_px * of_blur_px);
  const std::array<double, 3> offsets_px = {outwards_px, kCommonOffset_px * error.normal.x(),
                                            kCommonOffset_px * error.normal.y()};
  for (std::size_t i = 0; i < offsets_px.size(); ++i) common_[i] += offsets_px[i] * slope;
}

bool ErrorGroups::addSquares(int first, int count, Matrix6d& squares) const {
  Matrix6d sum = Matrix6d::Zero();
  int filled = 0;
  for (int i = first; i < first + count; ++i) {
    const Vector6d& score = nth(scores_, i);
    if (score.squaredNorm() == 0.0) continue;
    ++filled;
    for (int a = 0; a < 6; ++a)
      for (int b = 0; b < 6; ++b) sum(a, b) += score[a] * score[b];
  }
  if (filled < 2) return false;
  squares += sum * (static_cast<double>(filled) / (filled - 1));
  return true;
}

void ErrorGroups::sum(ErrorSums& sums) const {
  sums.squares = Matrix6d::Zero();
  for (const Vector6d& slope : common_) sums.squares += slope * slope.transpose();
  sums.suffices = addSquares(0, kByPlace, sums.squares) &&
                  addSquares(kByPlace, kBySide, sums.squares) &&
                  addSquares(kByPlace + kBySide, kByKind, sums.squares);
}

void ErrorSums::add(const ErrorSums& other) {
  curvature += other.curvature;
  squares += other.squares;
  suffices = suffices && other.suffices;
}

ErrorSums ErrorSums::inFirst(const Pose& camera_from_first) const {
  const Matrix6d adjoint = adjointOf(camera_from_first);
  const Matrix6d whole = curvature.selfadjointView<Eigen::Lower>();
  return {adjoint.transpose() * whole * adjoint, adjoint.transpose() * squares * adjoint, suffices};
}

bool ErrorSums::covariance(Matrix6d& covariance) const {
  Matrix6d inverse;
  if (!suffices || !invert(curvature, inverse)) return false;
  const Matrix6d product = inverse * squares * inverse;
  for (int a = 0; a < 6; ++a)
    for (int b = 0; b <= a; ++b)
      covariance(a, b) = covariance(b, a) = 0.5 * (product(a, b) + product(b, a));
  return covariance.squaredNorm() < 1e300;
}

}  // namespace boresight
