// SPDX-License-Identifier: Apache-2.0
#include "sessions/run/matching_method.h"

#include <algorithm>
#include <cmath>
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

SearchWindow MatchQuery::windowOf(const Eigen::Vector3d& point_in_station_m, int side_px) const {
  return searchWindow(iteration.render.camera,
                      iteration.camera_from_station_before * point_in_station_m,
                      iteration.uncertainty, side_px);
}

bool MatchQuery::pointAt(const Eigen::Vector2d& place_px, Template& item) const {
  const Camera& camera = iteration.render.camera;
  const Eigen::Vector2d pixel = (place_px.array() + 0.5).floor();
  if (!(pixel.x() >= 0.0 && pixel.y() >= 0.0 && pixel.x() < camera.width &&
        pixel.y() < camera.height))
    return false;
  if (!iteration.render.mask.get(static_cast<int>(pixel.x()), static_cast<int>(pixel.y())))
    return false;
  item.center_x = static_cast<int>(pixel.x());
  item.center_y = static_cast<int>(pixel.y());
  item.depth_m =
      depth[static_cast<std::size_t>(item.center_y) * static_cast<std::size_t>(camera.width) +
            static_cast<std::size_t>(item.center_x)];
  Ray ray;
  if (!(item.depth_m > 0.0F) || !unprojectRay(camera, place_px, ray)) return false;
  item.point_in_station_m =
      iteration.render.camera_from_station.inverse() * ray.at(static_cast<double>(item.depth_m));
  return true;
}

bool MatchQuery::ignored(int x, int y) const {
  if (ignore == nullptr) return false;
  const int level = iteration.level;
  const int x_end = std::min((x + 1) << level, ignore->width);
  const int y_end = std::min((y + 1) << level, ignore->height);
  for (int v = y << level; v < y_end; ++v)
    for (int u = x << level; u < x_end; ++u)
      if (ignore->get(u, v)) return true;
  return false;
}

OutsideMatching::OutsideMatching(Localizer& localizer, MatchingMethod& method,
                                 std::span<const double> albedo_of_part,
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
  const auto brightest = std::max_element(albedo_of_part.begin(), albedo_of_part.end());
  if (brightest != albedo_of_part.end() &&
      *std::min_element(albedo_of_part.begin(), albedo_of_part.end()) < *brightest) {
    for (const double albedo : albedo_of_part) relative_albedo_.push_back(albedo / *brightest);
    face_.resize(pixels);
    surfaces.face = face_;
  }
  localizer_.matchOutside(surfaces);
  method_.begin(stop);
}

ImageView OutsideMatching::imageAt(int level) {
  const ImageView& image = localizer_.problem().image;
  const int width = ((image.width - 1) >> level) + 1;
  const int height = ((image.height - 1) >> level) + 1;
  std::vector<std::uint8_t>& gray = images_[static_cast<std::size_t>(level)];
  if (gray.empty())
    for (int y = 0; y < height; ++y)
      for (int x = 0; x < width; ++x) gray.push_back(pooled(image, x, y, level));
  return {gray.data(), width, height, width};
}

void OutsideMatching::shadeByAlbedo(std::size_t pixels) {
  const std::span<const std::uint16_t> part_of_face = localizer_.problem().mesh.part_of_face;
  for (std::size_t i = 0; i < pixels; ++i) {
    if (face_[i] < 0) continue;
    const double albedo = relative_albedo_[part_of_face[static_cast<std::size_t>(face_[i])]];
    // At least 1: 0 is the background.
    intensity_[i] =
        static_cast<std::uint8_t>(std::max(1.0, std::floor(albedo * intensity_[i] + 0.5)));
  }
}

void OutsideMatching::serve() {
  if (!localizer_.awaitsMatches()) return;
  const Iteration& iteration = *localizer_.workspace().iteration;
  const Camera& camera = iteration.render.camera;
  if (!face_.empty())
    shadeByAlbedo(static_cast<std::size_t>(camera.width) * static_cast<std::size_t>(camera.height));
  const MatchQuery query{iteration,
                         localizer_.options(),
                         imageAt(iteration.level),
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
