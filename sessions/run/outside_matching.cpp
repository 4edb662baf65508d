// SPDX-License-Identifier: Apache-2.0
#include "sessions/run/outside_matching.h"

#include <algorithm>
#include <string>

namespace boresight::sessions {
namespace {

/// Mean over the full-resolution pixels of a pixel of the level, those that exist, rounded.
std::uint8_t pooled(const ImageView& image, int x, int y, int level) {
  const int x_end = std::min((x + 1) << level, image.width);
  const int y_end = std::min((y + 1) << level, image.height);
  int sum = 0, count = 0;
  for (int v = y << level; v < y_end; ++v) {
    for (int u = x << level; u < x_end; ++u) {
      sum += image.at(u, v);
      ++count;
    }
  }
  return static_cast<std::uint8_t>((sum + count / 2) / count);
}

}  // namespace

OutsideMatching::OutsideMatching(Localizer& localizer, MatchingMethod& method,
                                 const std::stop_token& stop)
    : localizer_(localizer), method_(method) {
  const ImageView& image = localizer.problem().image;
  const auto pixels =
      static_cast<std::size_t>(image.width) * static_cast<std::size_t>(image.height);
  intensity_.resize(pixels);
  depth_m_.resize(pixels);
  SurfaceRender surfaces;
  surfaces.intensity = intensity_;
  surfaces.depth_m = depth_m_;
  localizer_.matchOutside(surfaces);
  method_.begin(stop);
}

const OutsideMatching::Picture& OutsideMatching::imageAt(int level) {
  Picture& picture = images_[static_cast<std::size_t>(level)];
  if (!picture.gray.empty()) return picture;
  const ImageView& image = localizer_.problem().image;
  picture.width = ((image.width - 1) >> level) + 1;
  picture.height = ((image.height - 1) >> level) + 1;
  for (int y = 0; y < picture.height; ++y)
    for (int x = 0; x < picture.width; ++x) picture.gray.push_back(pooled(image, x, y, level));
  return picture;
}

void OutsideMatching::serve() {
  if (!localizer_.awaitsMatches()) return;
  const Iteration& iteration = *localizer_.workspace().iteration;
  const Camera& camera = iteration.render.camera;
  const MatchQuery query{iteration,
                         localizer_.options(),
                         imageAt(iteration.level).view(),
                         {intensity_.data(), camera.width, camera.height, camera.width},
                         depth_m_,
                         localizer_.problem().ignore};
  found_.clear();
  method_.match(query, found_);
  const Status status = localizer_.supplyMatches(found_);
  if (status != Status::kOk)
    throw MethodError("the method gave " + std::to_string(found_.size()) +
                      " matches: " + statusText(status));
}

}  // namespace boresight::sessions
