// SPDX-License-Identifier: Apache-2.0
#include "core/render/surface_render.h"

#include <algorithm>
#include <cmath>
#include <cstddef>

#include "core/render/rounding.h"

namespace boresight {
namespace {

/// Everything about one pixel of a surface.
struct Shaded {
  float depth_m = 0.0F;
  std::uint8_t intensity = 0;
  Eigen::Vector3f normal = Eigen::Vector3f::Zero();
};

Shaded shade(const CameraScene& scene, const Eigen::Vector3d& ray, float inverse_depth,
             std::int32_t face) {
  Shaded shaded;
  shaded.depth_m = 1.0F / inverse_depth;
  Eigen::Vector3d plane;
  if (!planeThrough(scene.corners(face), plane)) return shaded;
  const double exact = dotProduct(plane, ray);
  // The plane of a sliver is uncertain; the rendered depth then is within the face.
  if (std::abs(exact - static_cast<double>(inverse_depth)) <
      1e-6 * static_cast<double>(inverse_depth))
    shaded.depth_m = static_cast<float>(1.0 / exact);
  const double norm = std::sqrt(dotProduct(plane, plane));
  const double cosine = exact / (norm * std::sqrt(dotProduct(ray, ray)));
  shaded.intensity = static_cast<std::uint8_t>(floorClamped(30.5 + 225.0 * cosine, 0, 255));
  shaded.normal = (plane * (-1.0 / norm)).cast<float>();
  return shaded;
}

template <class T>
void put(std::span<T> image, std::size_t index, const T& value) {
  if (!image.empty()) image[index] = value;
}

}  // namespace

bool surfaceRenderFits(const SurfaceRender& surfaces, int width, int height) {
  const std::size_t pixels = static_cast<std::size_t>(width) * static_cast<std::size_t>(height);
  const auto fits = [pixels](std::size_t size) { return size == 0 || size >= pixels; };
  return fits(surfaces.depth_m.size()) && fits(surfaces.face.size()) &&
         fits(surfaces.intensity.size()) && fits(surfaces.normal_in_camera.size());
}

void copySurfaces(const CameraScene& scene, const RasterBand& band, const Camera& camera,
                  const SurfaceRender& surfaces) {
  for (int row = 1; row <= band.rows; ++row) {
    const std::size_t start =
        static_cast<std::size_t>(band.first_y + row - 1) * static_cast<std::size_t>(camera.width);
    for (int x = 0; x < camera.width; ++x) {
      const std::size_t to = start + static_cast<std::size_t>(x);
      const std::size_t from = band.index(x, row);
      const bool drawn = x >= band.x_begin && x < band.x_end && band.face[from] >= 0;
      const std::int32_t face = drawn ? band.face[from] : RasterBand::kBackground;
      const Shaded shaded =
          drawn ? shade(scene, band.ray(x, row), band.inverse_depth[from], face) : Shaded();
      put(surfaces.depth_m, to, shaded.depth_m);
      put(surfaces.face, to, face);
      put(surfaces.intensity, to, shaded.intensity);
      put(surfaces.normal_in_camera, to, shaded.normal);
    }
  }
}

}  // namespace boresight
