// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <Eigen/Core>
#include <array>
#include <cstdint>

#include "core/base/image.h"

namespace boresight {

/// Result of a search along an edge's normal.
struct EdgePeak {
  double offset_px = 0.0;  ///< along the normal, from the predicted place
  double gradient = 0.0;   ///< signed derivative along the normal, gray/px; 0: nothing found
  double blur_px = 0.0;    ///< standard deviation of the edge's blur in the image
};

/// Searches a raw image along a line's normal for its largest derivative: profiles of small steps,
/// averaged over three parallels, against the derivative of a Gaussian. Gray values between
/// pixels are bilinear with weights of 1/1024, in integers.
class EdgeSearch {
 public:
  /// For peaks to a few hundredths of a pixel.
  static constexpr double kFineStep_px = 0.5;
  /// For peaks to a tenth of a pixel, at half the cost.
  static constexpr double kWideStep_px = 1.0;

  /// `sigma_px`: scale of the derivative along the normal. Peaks are interpolated between steps.
  explicit EdgeSearch(double sigma_px, double step_px = kFineStep_px);

  /// Nearer peaks are preferred: a strength is weighted by 1 - (offset / (radius + 1 px))^2. Peaks
  /// weaker than `min_gradient`, on ignored pixels (`ignore` may be nullptr) or whose profile
  /// leaves the image are excluded.
  EdgePeak find(const ImageView& image, const BitImage* ignore, const Eigen::Vector2d& predicted_px,
                const Eigen::Vector2d& normal, double radius_px, double min_gradient) const;

 private:
  static constexpr int kMaxTaps = 32;
  static constexpr int kMaxProfile = 512;
  using Profile = std::array<float, kMaxProfile>;

  bool sample(const ImageView& image, const Eigen::Vector2d& predicted_px,
              const Eigen::Vector2d& normal, int reach, Profile& profile) const;
  void derive(const Profile& profile, int count, Profile& slope) const;
  double blurOf_px(double strength, double bend) const;

  std::array<float, kMaxTaps> kernel_{};  ///< one side; antisymmetric; for the profile's unit
  double step_px_ = kFineStep_px;
  double sigma_px_ = 1.0;  ///< of the derivative
  int taps_ = 1;
};

}  // namespace boresight
