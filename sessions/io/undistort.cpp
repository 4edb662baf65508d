// SPDX-License-Identifier: Apache-2.0
#include "sessions/io/undistort.h"

#include <algorithm>
#include <cmath>

#include <opencv2/core.hpp>

namespace boresight::sessions {
namespace {

/// Gray value at a place between pixel centres; 0 beyond the image's outermost half pixel.
std::uint8_t sample(const ImageView& image, const Eigen::Vector2d& place) {
  if (!(place.x() >= -0.5 && place.y() >= -0.5 && place.x() <= image.width - 0.5 &&
        place.y() <= image.height - 0.5))
    return 0;
  const double x = std::clamp(place.x(), 0.0, image.width - 1.0);
  const double y = std::clamp(place.y(), 0.0, image.height - 1.0);
  const int left = std::min(static_cast<int>(x), std::max(image.width - 2, 0));
  const int top = std::min(static_cast<int>(y), std::max(image.height - 2, 0));
  const int right = std::min(left + 1, image.width - 1);
  const int bottom = std::min(top + 1, image.height - 1);
  const double u = x - left;
  const double v = y - top;
  const double upper = (1.0 - u) * image.at(left, top) + u * image.at(right, top);
  const double lower = (1.0 - u) * image.at(left, bottom) + u * image.at(right, bottom);
  return static_cast<std::uint8_t>((1.0 - v) * upper + v * lower + 0.5);
}

void undistortRows(const Camera& camera, const ImageView& image, const cv::Range& rows,
                   UndistortedImage& output) {
  const Camera& pinhole = output.camera;
  for (int y = rows.start; y < rows.end; ++y)
    for (int x = 0; x < pinhole.width; ++x) {
      const Eigen::Vector3d ray((x - pinhole.cx) / pinhole.fx, (y - pinhole.cy) / pinhole.fy, 1.0);
      Eigen::Vector2d place;
      const std::size_t index =
          static_cast<std::size_t>(y) * static_cast<std::size_t>(pinhole.width) +
          static_cast<std::size_t>(x);
      if (projectDirection(camera, ray, place)) output.pixels[index] = sample(image, place);
    }
}

}  // namespace

Camera pinholeOf(const Camera& camera) {
  Camera pinhole = camera;
  pinhole.model = CameraModel::kPinhole;
  pinhole.distortion = {};
  pinhole.cahv = {};
  pinhole.fy = std::abs(pinhole.fy);
  if (prepareCamera(pinhole) != Status::kOk) pinhole.valid_radius = 0.0;
  return pinhole;
}

UndistortedImage undistort(const Camera& camera, const ImageView& image) {
  UndistortedImage output;
  output.camera = pinholeOf(camera);
  output.pixels.assign(
      static_cast<std::size_t>(camera.width) * static_cast<std::size_t>(camera.height), 0);
  if (camera.model == CameraModel::kPinhole) {
    for (int y = 0; y < image.height; ++y)
      std::copy_n(image.row(y), image.width,
                  output.pixels.begin() + static_cast<std::ptrdiff_t>(y) * image.width);
    return output;
  }
  cv::parallel_for_(cv::Range(0, camera.height),
                    [&](const cv::Range& rows) { undistortRows(camera, image, rows, output); });
  return output;
}

}  // namespace boresight::sessions
