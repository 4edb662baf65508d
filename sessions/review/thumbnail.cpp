// SPDX-License-Identifier: Apache-2.0
#include "sessions/review/thumbnail.h"

#include <algorithm>
#include <cmath>
#include <opencv2/imgproc.hpp>

#include "sessions/session/case_annotations.h"

namespace boresight::sessions {
namespace {

constexpr double kStationMargin = 1.15;  // of the station's size in the image
constexpr double kLeastPart = 0.125;     // of the image's width, that is shown

/// Bounding box in the image of the station box's corners from all poses; empty when none is
/// visible.
cv::Rect2d stationBox(const Camera& camera, const MeshView& mesh, std::span<const Pose> poses) {
  const cv::Rect2d image(0.0, 0.0, camera.width, camera.height);
  cv::Rect2d all;
  for (const Pose& camera_from_station : poses) {
    Eigen::AlignedBox2d box;
    for (const Eigen::Vector3d& corner : boxCorners(matchedBounds(mesh))) {
      Eigen::Vector2d pixel;
      if (project(camera, camera_from_station * corner, pixel)) box.extend(pixel);
    }
    if (box.isEmpty()) continue;
    const cv::Rect2d rect2d =
        cv::Rect2d(box.min().x(), box.min().y(), box.sizes().x(), box.sizes().y()) & image;
    if (rect2d.area() > 0.0) all = all.area() > 0.0 ? all | rect2d : rect2d;
  }
  return all;
}

/// Of the picture's shape where the image allows it, inside the image.
cv::Rect partToShow(const Camera& camera, const cv::Rect2d& box, double aspect) {
  const cv::Rect image(0, 0, camera.width, camera.height);
  if (box.area() <= 0.0) return image;
  double width = std::max({kStationMargin * box.width, kStationMargin * box.height * aspect,
                           kLeastPart * camera.width});
  width = std::min(width, std::max<double>(camera.width, camera.height * aspect));
  const double height = width / aspect;
  const auto start = [](double centre, double size, int limit) {
    return std::clamp(centre - size / 2.0, 0.0, std::max(0.0, limit - size));
  };
  const cv::Rect part(static_cast<int>(start(box.x + box.width / 2.0, width, camera.width)),
                      static_cast<int>(start(box.y + box.height / 2.0, height, camera.height)),
                      static_cast<int>(std::ceil(width)), static_cast<int>(std::ceil(height)));
  return part & image;
}

/// The camera of a part of its image, scaled; pixel centres at integers.
Camera cameraOfPart(Camera camera, const cv::Rect& part, const cv::Size& size) {
  const double sx = static_cast<double>(size.width) / part.width;
  const double sy = static_cast<double>(size.height) / part.height;
  camera.fx *= sx;
  camera.fy *= sy;
  camera.cx = (camera.cx - part.x + 0.5) * sx - 0.5;
  camera.cy = (camera.cy - part.y + 0.5) * sy - 0.5;
  camera.width = size.width;
  camera.height = size.height;
  return camera;
}

/// As large as fits into the picture without another shape.
cv::Size sizeWithin(const cv::Rect& part, int width_px, int height_px) {
  const double scale = std::min(static_cast<double>(width_px) / part.width,
                                static_cast<double>(height_px) / part.height);
  return {std::max(1, static_cast<int>(std::lround(scale * part.width))),
          std::max(1, static_cast<int>(std::lround(scale * part.height)))};
}

}  // namespace

ColorImage stationPicture(const ImageView& image, Camera camera, const MeshView& mesh,
                          std::span<const Pose> framed, std::span<const OverlayLayer> layers,
                          int width_px, int height_px) {
  const bool projects = prepareCamera(camera) == Status::kOk;
  const cv::Mat whole(image.height, image.width, CV_8UC1, const_cast<std::uint8_t*>(image.data),
                      static_cast<std::size_t>(image.stride));
  const cv::Rect part = partToShow(camera, stationBox(camera, mesh, framed),
                                   static_cast<double>(width_px) / height_px);
  const cv::Size size = sizeWithin(part, width_px, height_px);
  cv::Mat small;
  const bool shrinks = size.width < part.width;
  cv::resize(whole(part & cv::Rect(0, 0, image.width, image.height)), small, size, 0.0, 0.0,
             shrinks ? cv::INTER_AREA : cv::INTER_LINEAR);
  Camera scaled = cameraOfPart(camera, part, size);
  const ImageView view{small.data, small.cols, small.rows, static_cast<std::ptrdiff_t>(small.step)};
  if (!projects || prepareCamera(scaled) != Status::kOk) layers = {};
  return drawOverlay(view, scaled, mesh, layers);
}

}  // namespace boresight::sessions
