// SPDX-License-Identifier: Apache-2.0
#include "sessions/evaluation/nearest_point.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <utility>

#include <Eigen/Geometry>

namespace boresight::sessions {

NearestPoint::NearestPoint(std::vector<Eigen::Vector3d> points)
    : points_(std::move(points)), axis_(points_.size(), 0) {
  std::vector<Span> open = {{0, points_.size(), 0.0}};
  while (!open.empty()) {
    const auto [begin, end, unused] = open.back();
    open.pop_back();
    if (end - begin < 2) continue;
    Eigen::AlignedBox3d box;
    for (std::size_t i = begin; i < end; ++i) box.extend(points_[i]);
    int axis = 0;
    box.sizes().maxCoeff(&axis);
    const std::size_t middle = begin + (end - begin) / 2;
    const auto at = [this](std::size_t i) {
      return points_.begin() + static_cast<std::ptrdiff_t>(i);
    };
    std::nth_element(at(begin), at(middle), at(end),
                     [axis](const auto& a, const auto& b) { return a[axis] < b[axis]; });
    axis_[middle] = axis;
    open.push_back({begin, middle, 0.0});
    open.push_back({middle + 1, end, 0.0});
  }
}

double NearestPoint::distance(const Eigen::Vector3d& point) const {
  double best = std::numeric_limits<double>::infinity();
  std::vector<Span> open = {{0, points_.size(), 0.0}};
  while (!open.empty()) {
    const auto [begin, end, bound] = open.back();
    open.pop_back();
    if (begin >= end || bound >= best) continue;
    const std::size_t middle = begin + (end - begin) / 2;
    best = std::min(best, (points_[middle] - point).squaredNorm());
    const double across = point[axis_[middle]] - points_[middle][axis_[middle]];
    const Span low = {begin, middle, across > 0.0 ? across * across : bound};
    const Span high = {middle + 1, end, across > 0.0 ? bound : across * across};
    // The half with the point in it comes off the stack first.
    open.push_back(across > 0.0 ? low : high);
    open.push_back(across > 0.0 ? high : low);
  }
  return std::sqrt(best);
}

}  // namespace boresight::sessions
