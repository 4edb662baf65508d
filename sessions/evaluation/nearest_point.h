// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <vector>

#include <Eigen/Core>

namespace boresight::sessions {

/// Finds the nearest of many points (a k-d tree, cut at medians). Any unit.
class NearestPoint {
 public:
  explicit NearestPoint(std::vector<Eigen::Vector3d> points);

  /// From `point` to the nearest; infinity when there are none.
  double distance(const Eigen::Vector3d& point) const;

 private:
  struct Span {
    std::size_t begin = 0;
    std::size_t end = 0;
    double bound = 0.0;  ///< squared distance below which nothing in it lies
  };

  /// Cut at the middle of [begin, end): that point is the node, halves on its sides.
  std::vector<Eigen::Vector3d> points_;
  std::vector<int> axis_;  ///< of the cut at each node
};

}  // namespace boresight::sessions
