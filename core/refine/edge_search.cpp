// SPDX-License-Identifier: Apache-2.0
#include "core/refine/edge_search.h"

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <cstdint>

#include "core/base/math.h"
#include "core/base/nth.h"

namespace boresight {
namespace {

constexpr int kPlaceBits = 20;   ///< of a place: its unit is 2^-20 px
constexpr int kWeightBits = 10;  ///< of a bilinear weight
constexpr std::int32_t kWeightMask = (1 << kWeightBits) - 1;
/// Unit of a profile: the three parallels weigh 1, 2, 1.
constexpr double kProfileUnit_gray = 1.0 / (4 << (2 * kWeightBits));
/// Above the change of a place by rounding.
constexpr double kMargin_px = 1e-3;
constexpr double kMostBlur_px = 6.0;  ///< of an edge that is measured

/// Rounded steps and places relative to a pixel; symmetric about 0, so that a line searched from
/// its other side is sampled at the same places.
std::int32_t toPlace(double value_px) {
  const double scaled = value_px * (1 << kPlaceBits);
  return static_cast<std::int32_t>(scaled < 0.0 ? scaled - 0.5 : scaled + 0.5);
}

/// Bilinear gray value in units of 2^-20 at a place relative to `origin`.
std::int32_t grayAt(const std::uint8_t* origin, std::ptrdiff_t stride, std::int32_t x,
                    std::int32_t y) {
  const std::uint8_t* upper = origin + (y >> kPlaceBits) * stride + (x >> kPlaceBits);
  const std::uint8_t* lower = upper + stride;
  const std::int32_t right = (x >> (kPlaceBits - kWeightBits)) & kWeightMask;
  const std::int32_t down = (y >> (kPlaceBits - kWeightBits)) & kWeightMask;
  const std::int32_t top = (upper[0] << kWeightBits) + right * (upper[1] - upper[0]);
  const std::int32_t bottom = (lower[0] << kWeightBits) + right * (lower[1] - lower[0]);
  return (top << kWeightBits) + down * (bottom - top);
}

}  // namespace

EdgeSearch::EdgeSearch(double sigma_px, double step_px) : step_px_(step_px), sigma_px_(sigma_px) {
  taps_ = std::clamp(static_cast<int>(3.0 * sigma_px / step_px_ + 0.5), 1, kMaxTaps);
  double ramp = 0.0;
  std::array<double, kMaxTaps> weights{};
  for (int k = 1; k <= taps_; ++k) {
    const double s_px = k * step_px_;
    const double weight = s_px * exp(-0.5 * s_px * s_px / (sigma_px * sigma_px));
    nth(weights, k - 1) = weight;
    ramp += 2.0 * s_px * weight;
  }
  // A ramp of 1 gray per px gives 1.
  for (std::size_t k = 0; k < kernel_.size(); ++k)
    kernel_[k] = static_cast<float>(weights[k] / ramp * kProfileUnit_gray);
}

/// 2 reach + 1 places; false when one lies outside the image.
bool EdgeSearch::sample(const ImageView& image, const Eigen::Vector2d& predicted_px,
                        const Eigen::Vector2d& normal, int reach, Profile& profile) const {
  const Eigen::Vector2d extent_px =
      (reach * step_px_) * normal.cwiseAbs() +
      Eigen::Vector2d(std::abs(normal.y()) + kMargin_px, std::abs(normal.x()) + kMargin_px);
  const Eigen::Vector2d first_px = predicted_px - extent_px;
  const Eigen::Vector2d last_px = predicted_px + extent_px;
  if (!(first_px.x() >= 0.0 && first_px.y() >= 0.0 && last_px.x() < image.width - 1 &&
        last_px.y() < image.height - 1)) {
    return false;
  }
  const int pixel_x = static_cast<int>(predicted_px.x());
  const int pixel_y = static_cast<int>(predicted_px.y());
  const std::uint8_t* origin = image.row(pixel_y) + pixel_x;
  const auto stride = static_cast<std::ptrdiff_t>(image.stride);
  const std::int32_t step_x = toPlace(step_px_ * normal.x());
  const std::int32_t step_y = toPlace(step_px_ * normal.y());
  const std::int32_t aside_x = -toPlace(normal.y());
  const std::int32_t aside_y = toPlace(normal.x());
  std::int32_t x = toPlace(predicted_px.x() - pixel_x) - reach * step_x;
  std::int32_t y = toPlace(predicted_px.y() - pixel_y) - reach * step_y;
  for (int i = 0; i <= 2 * reach; ++i) {
    const std::int32_t sum = grayAt(origin, stride, x - aside_x, y - aside_y) +
                             2 * grayAt(origin, stride, x, y) +
                             grayAt(origin, stride, x + aside_x, y + aside_y);
    nth(profile, i) = static_cast<float>(sum);
    x += step_x;
    y += step_y;
  }
  return true;
}

/// The derivative at `count` places, the first of them at the profile's place taps_.
void EdgeSearch::derive(const Profile& profile, int count, Profile& slope) const {
  std::fill_n(slope.begin(), count, 0.0F);
  for (int k = 1; k <= taps_; ++k) {
    const float weight = nth(kernel_, k - 1);
    const float* before = profile.data() + taps_ - k;
    const float* after = profile.data() + taps_ + k;
    for (int i = 0; i < count; ++i) nth(slope, i) += weight * (after[i] - before[i]);
  }
}

/// Of a Gaussian edge whose derivative has this height and second difference at its peak.
double EdgeSearch::blurOf_px(double strength, double bend) const {
  if (!(bend < 0.0)) return kMostBlur_px;
  const double squared_px2 = -strength * step_px_ * step_px_ / bend - sigma_px_ * sigma_px_;
  return squared_px2 > 0.0 ? std::min(std::sqrt(squared_px2), kMostBlur_px) : 0.0;
}

EdgePeak EdgeSearch::find(const ImageView& image, const BitImage* ignore,
                          const Eigen::Vector2d& predicted_px, const Eigen::Vector2d& normal,
                          double radius_px, double min_gradient) const {
  EdgePeak peak;
  const int reach =
      std::min((kMaxProfile - 1) / 2, static_cast<int>(radius_px / step_px_) + 1 + taps_);
  Profile profile;
  if (!sample(image, predicted_px, normal, reach, profile)) return peak;
  const int inner = reach - taps_;
  Profile slope;
  derive(profile, 2 * inner + 1, slope);
  const float* middle = slope.data() + inner;
  double best = 0.0;
  for (int i = -inner + 1; i < inner; ++i) {
    const double slope_at_i = middle[i];
    const double strength = std::abs(slope_at_i);
    const double before = std::abs(static_cast<double>(middle[i - 1]));
    const double after = std::abs(static_cast<double>(middle[i + 1]));
    if (!(strength >= before && strength > after && strength >= min_gradient)) continue;
    // A weaker edge nearby is likelier than a strong one at the rim of the search.
    const double away = i / static_cast<double>(inner + 1);
    const double preference = strength * (1.0 - away * away);
    if (preference <= best) continue;
    best = preference;
    const double bend = before - 2.0 * strength + after;
    const double shift = bend < 0.0 ? 0.5 * (before - after) / bend : 0.0;
    peak = {(i + std::clamp(shift, -0.5, 0.5)) * step_px_, slope_at_i, blurOf_px(strength, bend)};
  }
  if (ignore != nullptr && peak.gradient != 0.0) {
    // Inside: the profile around it was sampled.
    const Eigen::Vector2d found = predicted_px + peak.offset_px * normal;
    if (ignore->get(static_cast<int>(found.x() + 0.5), static_cast<int>(found.y() + 0.5)))
      peak = {};
  }
  return peak;
}

}  // namespace boresight
