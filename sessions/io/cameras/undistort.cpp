// SPDX-License-Identifier: Apache-2.0
#include "sessions/io/cameras/undistort.h"

#include <algorithm>
#include <cmath>

#include <opencv2/imgproc.hpp>

namespace boresight::sessions {
namespace {

/// Where the camera sees the ray; far outside of the image where it does not see it.
cv::Vec2f placeOf(const Camera& camera, const Eigen::Vector3d& ray) {
  Eigen::Vector2d place;
  if (!projectDirection(camera, ray, place) || place.x() < -0.5 || place.y() < -0.5 ||
      place.x() > camera.width - 0.5 || place.y() > camera.height - 0.5)
    return {-2.0F, -2.0F};
  // The outermost half pixel has the value of its pixel.
  return {static_cast<float>(std::clamp(place.x(), 0.0, camera.width - 1.0)),
          static_cast<float>(std::clamp(place.y(), 0.0, camera.height - 1.0))};
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
  cv::Mat target(camera.height, camera.width, CV_8UC1, output.pixels.data());
  // OpenCV has no const headers; nothing is written.
  const cv::Mat source(image.height, image.width, CV_8UC1, const_cast<std::uint8_t*>(image.data),
                       static_cast<std::size_t>(image.stride));
  if (camera.model == CameraModel::kPinhole) {
    source.copyTo(target);
    return output;
  }
  cv::Mat places(camera.height, camera.width, CV_32FC2);
  const Camera& pinhole = output.camera;
  cv::parallel_for_(cv::Range(0, camera.height), [&](const cv::Range& rows) {
    for (int y = rows.start; y < rows.end; ++y)
      for (int x = 0; x < pinhole.width; ++x)
        places.at<cv::Vec2f>(y, x) =
            placeOf(camera, {(x - pinhole.cx) / pinhole.fx, (y - pinhole.cy) / pinhole.fy, 1.0});
  });
  cv::remap(source, target, places, {}, cv::INTER_LINEAR, cv::BORDER_CONSTANT);
  return output;
}

}  // namespace boresight::sessions
