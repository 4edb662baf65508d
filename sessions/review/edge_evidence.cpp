// SPDX-License-Identifier: Apache-2.0
#include "sessions/review/edge_evidence.h"

#include <algorithm>
#include <cmath>

#include "sessions/review/inlier_spread.h"

namespace boresight::sessions {
namespace {

constexpr double kExplained_px = 2.0;
constexpr double kSameDirection = 0.866;  // cos 30 deg
constexpr double kShareOfSlope = 0.5;

/// Which predicted place is nearest to a pixel of a region, within kExplained_px.
class NearestPlace {
 public:
  NearestPlace(const ImageRegion& region, const std::vector<EdgePlace>& places)
      : region_(region),
        nearest_(
            static_cast<std::size_t>(region.width()) * static_cast<std::size_t>(region.height()),
            -1) {
    for (std::size_t i = 0; i < places.size(); ++i) spread(static_cast<std::int32_t>(i), places);
  }

  std::int32_t at(int x, int y) const { return nearest_[indexOf(x, y)]; }

 private:
  std::size_t indexOf(int x, int y) const {
    return static_cast<std::size_t>(y - region_.y_min) * static_cast<std::size_t>(region_.width()) +
           static_cast<std::size_t>(x - region_.x_min);
  }

  void spread(std::int32_t index, const std::vector<EdgePlace>& places) {
    const Eigen::Vector2d& pixel = places[static_cast<std::size_t>(index)].pixel;
    const int reach = static_cast<int>(std::ceil(kExplained_px));
    const int x0 = static_cast<int>(std::lround(pixel.x()));
    const int y0 = static_cast<int>(std::lround(pixel.y()));
    for (int y = y0 - reach; y <= y0 + reach; ++y) {
      for (int x = x0 - reach; x <= x0 + reach; ++x) {
        if (!region_.contains(x, y)) continue;
        const double squared = (Eigen::Vector2d(x, y) - pixel).squaredNorm();
        if (squared > kExplained_px * kExplained_px) continue;
        std::int32_t& known = nearest_[indexOf(x, y)];
        if (known < 0 ||
            squared < (Eigen::Vector2d(x, y) - places[static_cast<std::size_t>(known)].pixel)
                          .squaredNorm())
          known = index;
      }
    }
  }

  ImageRegion region_;
  std::vector<std::int32_t> nearest_;
};

/// How steep an edge of the image is that counts as clutter.
double clutterSlope(const std::vector<LookedPlace>& looked, const EvidenceSettings& settings) {
  std::vector<double> slopes;
  for (const LookedPlace& one : looked)
    if (one.found && std::abs(one.found->offset_px) <= settings.near_px)
      slopes.push_back(one.found->slope);
  if (slopes.empty()) return 2.0 * settings.least_slope;
  return std::max(settings.least_slope, kShareOfSlope * medianOf(slopes));
}

}  // namespace

std::vector<LookedPlace> lookAt(const ImageEdges& image, const std::vector<EdgePlace>& places,
                                const EvidenceSettings& settings) {
  std::vector<LookedPlace> looked;
  looked.reserve(places.size());
  for (const EdgePlace& place : places) {
    if (!image.canLook(place.pixel, settings.radius_px)) continue;
    looked.push_back(
        {place, image.across(place.pixel, place.normal, settings.radius_px, settings.least_slope)});
  }
  return looked;
}

Share coverageOf(const std::vector<LookedPlace>& looked, double near_px) {
  Share share;
  for (const LookedPlace& one : looked) {
    share.whole += one.place.length_px;
    if (one.found && std::abs(one.found->offset_px) <= near_px) share.part += one.place.length_px;
  }
  return share;
}

Share coverageOfPose(const LoadedCase& loaded, const Pose& camera_from_station,
                     const EvidenceSettings& settings) {
  const PredictedEdges edges =
      predictEdges(loaded.source.camera, loaded.scene.view(), camera_from_station);
  const ImageEdges image(loaded.image.view(), loaded.ignore ? &loaded.ignore_bits : nullptr,
                         regionOf(edges, settings));
  return coverageOf(lookAt(image, thinned(edges.places, settings.places), settings),
                    settings.near_px);
}

Share clutterOf(const ImageEdges& image, const PredictedEdges& edges,
                const std::vector<LookedPlace>& looked, const EvidenceSettings& settings) {
  Share share;
  const ImageRegion& region = image.region();
  if (region.empty() || edges.mask.words.empty()) return share;
  const std::vector<std::uint8_t> seen = image.thinEdges(clutterSlope(looked, settings));
  const NearestPlace nearest(region, edges.places);
  const BitImage mask = edges.mask.view();
  std::size_t i = 0;
  for (int y = region.y_min; y <= region.y_max; ++y) {
    for (int x = region.x_min; x <= region.x_max; ++x, ++i) {
      if (seen[i] == 0 || !mask.get(x, y)) continue;
      share.whole += 1.0;
      const std::int32_t place = nearest.at(x, y);
      const bool explained =
          place >= 0 &&
          std::abs(image.gradient(x, y).normalized().dot(
              edges.places[static_cast<std::size_t>(place)].normal)) >= kSameDirection;
      if (!explained) share.part += 1.0;
    }
  }
  return share;
}

ImageRegion regionOf(const PredictedEdges& edges, const EvidenceSettings& settings) {
  if (edges.places.empty()) return {};
  Eigen::Vector2d least = edges.places.front().pixel;
  Eigen::Vector2d most = least;
  for (const EdgePlace& place : edges.places) {
    least = least.cwiseMin(place.pixel);
    most = most.cwiseMax(place.pixel);
  }
  // Displaced places move by a few times the root of the mean square at most.
  const double margin = settings.radius_px + 4.0 * settings.displaced_px + 2.0;
  const auto round = [](double value) { return static_cast<int>(std::lround(value)); };
  return {round(least.x() - margin), round(least.y() - margin), round(most.x() + margin),
          round(most.y() + margin)};
}

}  // namespace boresight::sessions
