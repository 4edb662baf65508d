// SPDX-License-Identifier: Apache-2.0
#include "core/accept/edge_width.h"

#include <algorithm>
#include <cmath>
#include <optional>

#include "core/base/nth.h"

namespace boresight {
namespace {

constexpr int kMostProfiles = 4000;
constexpr std::int32_t kLeastProfiles = 30;  ///< of a direction
constexpr int kReach_px = 24;                ///< of a profile, to either side
constexpr int kNear_px = 4;                  ///< range of the search for its steepest slope
constexpr double kLeastHeight = 20.0;        ///< gray values
constexpr int kProfileSamples = 2 * kReach_px + 1;

using Profile = std::array<double, kProfileSamples>;

/// Bilinear.
double sample(const ImageView& image, const Eigen::Vector2d& place) {
  const int x = static_cast<int>(place.x());
  const int y = static_cast<int>(place.y());
  const double right = place.x() - x;
  const double down = place.y() - y;
  const double above = (1.0 - right) * image.at(x, y) + right * image.at(x + 1, y);
  const double below = (1.0 - right) * image.at(x, y + 1) + right * image.at(x + 1, y + 1);
  return (1.0 - down) * above + down * below;
}

/// Gray values along the normal. False when a part is outside the image, or ignored.
bool takeProfile(const ImageView& image, const BitImage* ignore, const Eigen::Vector2d& place,
                 const Eigen::Vector2d& normal, Profile& profile) {
  for (int i = 0; i < kProfileSamples; ++i) {
    const Eigen::Vector2d at = place + (i - kReach_px) * normal;
    if (!(at.x() >= 0.0 && at.y() >= 0.0 && at.x() < image.width - 1 && at.y() < image.height - 1))
      return false;
    if (ignore != nullptr && ignore->get(static_cast<int>(at.x()), static_cast<int>(at.y())))
      return false;
    nth(profile, i) = sample(image, at);
  }
  return true;
}

/// Width of the ramp around the steepest slope near the middle; none when the ramp is too low.
std::optional<double> rampWidth_px(const Profile& profile) {
  const auto at = [&profile](int i) { return nth(profile, i); };
  int steepest = kReach_px;
  double slope = 0.0;
  for (int i = kReach_px - kNear_px; i <= kReach_px + kNear_px; ++i) {
    const double slope_at_i = 0.5 * (at(i + 1) - at(i - 1));
    if (std::abs(slope_at_i) <= std::abs(slope)) continue;
    slope = slope_at_i;
    steepest = i;
  }
  const double sign = slope > 0.0 ? 1.0 : -1.0;
  int first = steepest;
  int last = steepest;
  while (first > 0 && sign * (at(first) - at(first - 1)) > 0.0) --first;
  while (last + 1 < kProfileSamples && sign * (at(last + 1) - at(last)) > 0.0) ++last;
  const double height = sign * (at(last) - at(first));
  if (!(height >= kLeastHeight)) return std::nullopt;
  return height / std::abs(slope);
}

}  // namespace

int EdgeWidth::widestDirection() const {
  int widest = -1;
  for (int i = 0; i < kEdgeDirections; ++i) {
    const auto at = static_cast<std::size_t>(i);
    if (places[at] < kLeastProfiles) continue;
    if (widest < 0 || width_px[at] > nth(width_px, widest)) widest = i;
  }
  return widest;
}

double EdgeWidth::widest_px() const {
  const int widest = widestDirection();
  return widest < 0 ? 0.0 : nth(width_px, widest);
}

void EdgeWidthMeter::add(const Eigen::Vector2d& place_px, const Eigen::Vector2d& normal) {
  Profile profile;
  if (!takeProfile(image_, ignore_, place_px, normal, profile)) return;
  const std::optional<double> width_px = rampWidth_px(profile);
  if (!width_px) return;
  const Eigen::Vector2d way = 1024.0 * normal;
  const int direction =
      edgeDirectionOf(static_cast<std::int32_t>(way.x()), static_cast<std::int32_t>(way.y()));
  const int bin = std::min(kBins - 1, static_cast<int>(*width_px / kBin_px));
  ++nth(nth(histograms_, direction), bin);
}

EdgeWidth EdgeWidthMeter::width() const {
  EdgeWidth result;
  for (std::size_t d = 0; d < histograms_.size(); ++d) {
    const Histogram& histogram = histograms_[d];
    for (const std::int32_t count : histogram) result.places[d] += count;
    if (result.places[d] == 0) continue;
    std::int32_t below = 0;
    std::size_t bin = 0;
    while (2 * (below + histogram[bin]) < result.places[d]) below += histogram[bin++];
    result.width_px[d] = (static_cast<double>(bin) + 0.5) * kBin_px;
  }
  return result;
}

EdgeWidth measureEdgeWidth(const EdgeRender& render, int level, const ImageView& image,
                           const BitImage* ignore) {
  EdgeWidthMeter meter(image, ignore);
  for (const EdgePixel& pixel : render.eachPixel(render.strideFor(kMostProfiles)))
    meter.add(atFullResolution(pixel.onLine_px(), level), pixel.normal());
  return meter.width();
}

}  // namespace boresight
