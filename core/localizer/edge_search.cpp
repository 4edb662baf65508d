// SPDX-License-Identifier: Apache-2.0
#include "core/localizer/edge_search.h"

#include <algorithm>
#include <cmath>

#include "core/base/math.h"

namespace boresight {
namespace {

constexpr double kStep_px = 0.5;

/// Bilinear gray value; false outside the image.
bool grayAt(const ImageView& image, double x, double y, double& gray) {
  if (!(x >= 0.0 && y >= 0.0 && x < image.width - 1 && y < image.height - 1)) return false;
  const int ix = static_cast<int>(x);
  const int iy = static_cast<int>(y);
  const double fx = x - ix;
  const double fy = y - iy;
  const std::uint8_t* upper = image.row(iy) + ix;
  const std::uint8_t* lower = image.row(iy + 1) + ix;
  const double top = upper[0] + fx * (upper[1] - upper[0]);
  const double bottom = lower[0] + fx * (lower[1] - lower[0]);
  gray = top + fy * (bottom - top);
  return true;
}

}  // namespace

EdgeSearch::EdgeSearch(double sigma_px) {
  taps_ = std::clamp(static_cast<int>(3.0 * sigma_px / kStep_px + 0.5), 1, kMaxTaps);
  double ramp = 0.0;
  for (int k = 1; k <= taps_; ++k) {
    const double s_px = k * kStep_px;
    const double weight = s_px * exponential(-0.5 * s_px * s_px / (sigma_px * sigma_px));
    kernel_[static_cast<std::size_t>(k - 1)] = weight;
    ramp += 2.0 * s_px * weight;
  }
  for (double& weight : kernel_) weight /= ramp;  // a ramp of 1 gray per px gives 1
}

bool EdgeSearch::sample(const ImageView& image, const Eigen::Vector2d& predicted_px,
                        const Eigen::Vector2d& normal, int reach, Profile& profile) const {
  const Eigen::Vector2d tangent(-normal.y(), normal.x());
  for (int i = -reach; i <= reach; ++i) {
    const Eigen::Vector2d at = predicted_px + (i * kStep_px) * normal;
    double sum = 0.0;
    for (int side = -1; side <= 1; ++side) {
      double gray = 0.0;
      const Eigen::Vector2d place = at + side * tangent;
      if (!grayAt(image, place.x(), place.y(), gray)) return false;
      sum += (side == 0 ? 2.0 : 1.0) * gray;
    }
    profile[static_cast<std::size_t>(i + reach)] = 0.25 * sum;
  }
  return true;
}

double EdgeSearch::derivative(const Profile& profile, int middle) const {
  double sum = 0.0;
  for (int k = 1; k <= taps_; ++k) {
    sum +=
        kernel_[static_cast<std::size_t>(k - 1)] * (profile[static_cast<std::size_t>(middle + k)] -
                                                    profile[static_cast<std::size_t>(middle - k)]);
  }
  return sum;
}

EdgePeak EdgeSearch::find(const ImageView& image, const BitImage* ignore,
                          const Eigen::Vector2d& predicted_px, const Eigen::Vector2d& normal,
                          double radius_px, double min_gradient) const {
  EdgePeak peak;
  const int reach =
      std::min((kMaxProfile - 1) / 2, static_cast<int>(radius_px / kStep_px) + 1 + taps_);
  Profile profile;
  if (!sample(image, predicted_px, normal, reach, profile)) return peak;
  const int inner = reach - taps_;
  double before = derivative(profile, reach - inner);
  double here = derivative(profile, reach - inner + 1);
  double best = 0.0;
  for (int i = -inner + 1; i < inner; ++i) {
    const double after = derivative(profile, reach + i + 1);
    const double strength = std::abs(here);
    // A weaker edge nearby is likelier than a strong one at the rim of the search.
    const double away = i / static_cast<double>(inner + 1);
    const double preference = strength * (1.0 - away * away);
    const bool local_maximum = strength >= std::abs(before) && strength > std::abs(after);
    if (local_maximum && preference > best && strength >= min_gradient) {
      best = preference;
      const double bend = std::abs(before) - 2.0 * strength + std::abs(after);
      const double shift = bend < 0.0 ? 0.5 * (std::abs(before) - std::abs(after)) / bend : 0.0;
      peak = {(i + std::clamp(shift, -0.5, 0.5)) * kStep_px, here};
    }
    before = here;
    here = after;
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
