// SPDX-License-Identifier: Apache-2.0
#include "core/match/rotation_bounds.h"

#include <algorithm>

#include <Eigen/Geometry>

namespace boresight {
namespace {

// sin t / t and (1 - cos t) / t^2 as functions of s = t^2, by their series; the error is below 1e-9
// up to t = 1.8 pi, the largest angle of a box of half-sides pi. The second falls up to 2 pi, the
// first up to t = 4.49, where it has its minimum.
constexpr double kSineRatioFallsUpTo = 20.0;  // of s
constexpr double kLeastSineRatio = -0.2173;
double sineRatio(double s) {
  double value = 0.0;
  for (int k = 12; k >= 1; --k) value = s / (2.0 * k * (2.0 * k + 1.0)) * (1.0 - value);
  return 1.0 - value;
}
double cosineRatio(double s) {
  double value = 0.0;
  for (int k = 12; k >= 1; --k) value = s / ((2.0 * k + 1.0) * (2.0 * k + 2.0)) * (1.0 - value);
  return 0.5 * (1.0 - value);
}

}  // namespace

RotationBounds::RotationBounds(const Eigen::Vector3d& low_rad, const Eigen::Vector3d& high_rad,
                               const Eigen::Vector3d& d)
    : d_(d), abs_d_z_(d.z() < 0.0 ? -d.z() : d.z()) {
  double smallest = 0.0, largest = 0.0;  // of |r|^2
  for (int i = 0; i < 3; ++i) {
    const double low2 = low_rad[i] * low_rad[i];
    const double high2 = high_rad[i] * high_rad[i];
    largest += std::max(low2, high2);
    if (low_rad[i] > 0.0 || high_rad[i] < 0.0) smallest += std::min(low2, high2);
    const double width = high_rad[i] - low_rad[i];
    quarter_[i] = 0.25 * width * width;
  }
  a_max_ = std::max(sineRatio(smallest), sineRatio(largest));
  a_min_ = largest < kSineRatioFallsUpTo ? sineRatio(largest) : kLeastSineRatio;
  b_max_ = cosineRatio(smallest);
  b_min_ = cosineRatio(largest);
  for (unsigned corner = 0; corner < kCorners; ++corner) {
    const Eigen::Vector3d r((corner & 1u) != 0 ? high_rad[0] : low_rad[0],
                            (corner & 2u) != 0 ? high_rad[1] : low_rad[1],
                            (corner & 4u) != 0 ? high_rad[2] : low_rad[2]);
    first_[corner] = r.cross(d);
    second_[corner] = r * r.dot(d) - d * r.squaredNorm();
  }
}

double RotationBounds::upper(const Eigen::Vector3d& n, Eigen::Vector3d& point,
                             double& excess) const {
  const double start = n.dot(d_);
  double best = 0.0, best_a = 0.0, best_b = 0.0;
  std::size_t best_corner = kCorners;
  for (std::size_t corner = 0; corner < kCorners; ++corner) {
    const double first = n.dot(first_[corner]);
    const double second = n.dot(second_[corner]);
    const double a = first > 0.0 ? a_max_ : a_min_;
    const double b = second > 0.0 ? b_max_ : b_min_;
    const double sum = a * first + b * second;
    if (best_corner != kCorners && sum <= best) continue;
    best = sum;
    best_corner = corner;
    best_a = a;
    best_b = b;
  }
  point = d_ + best_a * first_[best_corner] + best_b * second_[best_corner];
  excess = 0.0;
  for (int i = 0; i < 3; ++i) excess += std::max(0.0, start - n[i] * d_[i]) * quarter_[i];
  excess *= b_max_;
  return start + best + excess;
}

}  // namespace boresight
