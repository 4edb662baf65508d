// SPDX-License-Identifier: Apache-2.0
#include "core/pnp/spread_sampler.h"

#include <algorithm>
#include <cmath>

#include "core/base/nth.h"

namespace boresight {
namespace {

constexpr int kMaxDraws = 16;
constexpr double kSmallestVarianceShare = 0.04;  ///< a fifth of the semi-axis

}  // namespace

void SpreadSampler::begin(std::span<const Eigen::Vector2d> place_px, int size, std::uint64_t seed) {
  place_px_ = place_px;
  size_ = size;
  random_ = Random(seed);
  const double count = static_cast<double>(place_px.size());
  center_px_.setZero();
  for (const Eigen::Vector2d& place : place_px) center_px_ += place / count;
  double xx = 0.0, xy = 0.0, yy = 0.0;
  for (const Eigen::Vector2d& place : place_px) {
    const Eigen::Vector2d d = place - center_px_;
    xx += d.x() * d.x();
    xy += d.x() * d.y();
    yy += d.y() * d.y();
  }
  all_ = scatterOf(count, Eigen::Vector2d::Zero(), xx, xy, yy);
}

SpreadSampler::Sample SpreadSampler::draw() {
  Sample sample = drawDistinct();
  for (int i = 1; i < kMaxDraws && !isSpread(sample); ++i) sample = drawDistinct();
  return sample;
}

SpreadSampler::Sample SpreadSampler::drawDistinct() {
  Sample sample{};
  Sample taken{};  // ascending
  const auto places = static_cast<std::uint32_t>(place_px_.size());
  for (int i = 0; i < size_; ++i) {
    const std::uint32_t left = places - static_cast<std::uint32_t>(i);
    auto index = static_cast<std::int32_t>(random_.below(left));
    int slot = 0;
    for (; slot < i && index >= nth(taken, slot); ++slot) ++index;
    for (int k = i; k > slot; --k) {
      nth(taken, k) = nth(taken, k - 1);
    }
    nth(taken, slot) = index;
    nth(sample, i) = index;
  }
  return sample;
}

bool SpreadSampler::isSpread(const Sample& sample) const {
  Eigen::Vector2d sum = Eigen::Vector2d::Zero();
  double xx = 0.0, xy = 0.0, yy = 0.0;
  for (int i = 0; i < size_; ++i) {
    const auto index = static_cast<std::size_t>(nth(sample, i));
    const Eigen::Vector2d d = place_px_[index] - center_px_;
    sum += d;
    xx += d.x() * d.x();
    xy += d.x() * d.y();
    yy += d.y() * d.y();
  }
  const Scatter scatter = scatterOf(static_cast<double>(size_), sum, xx, xy, yy);
  return scatter.larger_px2 >= kSmallestVarianceShare * all_.larger_px2 &&
         scatter.smaller_px2 >= kSmallestVarianceShare * all_.smaller_px2;
}

SpreadSampler::Scatter SpreadSampler::scatterOf(double count, const Eigen::Vector2d& sum, double xx,
                                                double xy, double yy) {
  const double vx = (xx - sum.x() * sum.x() / count) / count;
  const double vy = (yy - sum.y() * sum.y() / count) / count;
  const double cov = (xy - sum.x() * sum.y() / count) / count;
  const double mean = 0.5 * (vx + vy);
  const double half_difference = 0.5 * (vx - vy);
  const double reach = std::sqrt(half_difference * half_difference + cov * cov);
  return {mean + reach, std::max(mean - reach, 0.0)};
}

}  // namespace boresight
