// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <cstdint>
#include <span>

#include <Eigen/Core>

#include "core/base/random.h"

namespace boresight {

/// Draws samples of three to five places without replacement, preferring well spread ones. A sample
/// nearly on a line or in one spot determines a pose badly, regardless of its matches.
class SpreadSampler {
 public:
  static constexpr std::size_t kMostPlaces = 5;          ///< of a sample
  using Sample = std::array<std::int32_t, kMostPlaces>;  ///< indices of places

  /// `place_px`: where the candidates lie in the image; must outlive the draws. `size`: 3 to
  /// kMostPlaces, not above the number of places.
  void begin(std::span<const Eigen::Vector2d> place_px, int size, std::uint64_t seed);

  /// Indices of one sample (the first `size` entries), in the order drawn. Draws again, at most 16
  /// times, while the smaller or the larger semi-axis of the sample's scatter is below a fifth of
  /// that of all places; then takes the last sample.
  Sample draw();

 private:
  /// Variances along the two principal axes.
  struct Scatter {
    double larger_px2 = 0.0;
    double smaller_px2 = 0.0;
  };

  Sample drawDistinct();
  bool isSpread(const Sample& sample) const;
  static Scatter scatterOf(double count, const Eigen::Vector2d& sum, double xx, double xy,
                           double yy);

  std::span<const Eigen::Vector2d> place_px_;
  Eigen::Vector2d center_px_ = Eigen::Vector2d::Zero();
  Scatter all_;
  int size_ = 4;
  Random random_{0};
};

}  // namespace boresight
