// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>

#include <Eigen/Core>

namespace boresight {

/// Bounds of R(r) d, R(r) = Exp(r), for all rotation vectors r of a box.
/// Rodrigues: R d = d + a r x d + b (r (r.d) - |r|^2 d) with a = sin|r| / |r|, b = (1 - cos|r|) /
/// |r|^2. For any n, n.(R d) is linear in a and in b, so its maximum over their ranges is at an end
/// of each; and quadratic in r, where replacing r_i^2 by the chord between the ends of its range
/// leaves a function that is linear in each r_i, with its maximum at a corner of the box. The chord
/// is never below r_i^2 and at most width_i^2 / 4 above it. So
///   n.(R d) <= n.d + max over corners [max_a a n.(r x d) + max_b b n.(r (r.d) - |r|^2 d)]
///              + max b * sum_i max(0, -S_ii) width_i^2 / 4,  S_ii = n_i d_i - n.d,
/// exact but for the ranges of a and b and the last term, all of second order in the box.
class RotationBounds {
 public:
  /// The box r = low ... high, of angles up to about pi.
  RotationBounds(const Eigen::Vector3d& low_rad, const Eigen::Vector3d& high_rad,
                 const Eigen::Vector3d& d);

  /// An upper bound of n.(R d), and in `point` a place in R^3 with n.point + `excess` = the bound:
  /// the image of d at the corner that attains the maximum.
  double upper(const Eigen::Vector3d& n, Eigen::Vector3d& point, double& excess) const;
  /// The `excess` of upper() changes by at most this much per unit of n_z.
  double excessPerUnitOfZ() const { return b_max_ * (quarter_[0] + quarter_[1]) * abs_d_z_; }

 private:
  static constexpr int kCorners = 8;
  Eigen::Vector3d d_;
  double abs_d_z_ = 0.0;
  std::array<Eigen::Vector3d, kCorners> first_;   ///< r x d
  std::array<Eigen::Vector3d, kCorners> second_;  ///< r (r.d) - |r|^2 d
  double a_min_ = 1.0, a_max_ = 1.0, b_min_ = 0.5, b_max_ = 0.5;
  Eigen::Vector3d quarter_ = Eigen::Vector3d::Zero();  ///< width^2 / 4
};

}  // namespace boresight
