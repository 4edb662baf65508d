// SPDX-License-Identifier: Apache-2.0
#include "tests/benchmarks/peers/visible_lines.h"

#include <algorithm>
#include <cmath>
#include <limits>

namespace boresight::peers {
namespace {

constexpr double kSide_px = 640.0;

/// Inverse depth of the nearest face in each pixel; 0 where there is none.
class DepthImage {
 public:
  explicit DepthImage(const PinholeImage& image)
      : scale_(std::min(1.0, kSide_px / std::max(image.gray.cols, image.gray.rows))),
        inverse_(cv::Mat::zeros(static_cast<int>(image.gray.rows * scale_),
                                static_cast<int>(image.gray.cols * scale_), CV_64F)),
        image_(&image) {}

  /// x, y px and inverse depth 1/m; inverse depth 0 behind the camera.
  Eigen::Vector3d project(const Eigen::Vector3d& point_in_camera_m) const {
    const double depth_m = point_in_camera_m.z();
    if (depth_m < 1e-3) return Eigen::Vector3d::Zero();
    return {scale_ * (image_->fx * point_in_camera_m.x() / depth_m + image_->cx),
            scale_ * (image_->fy * point_in_camera_m.y() / depth_m + image_->cy), 1.0 / depth_m};
  }

  void draw(const std::array<Eigen::Vector3d, 3>& corner) {
    if (corner[0].z() == 0.0 || corner[1].z() == 0.0 || corner[2].z() == 0.0) return;
    const double area = cross(corner[0], corner[1], corner[2]);
    if (std::abs(area) < 1e-9) return;
    const auto [left, right] = std::minmax({corner[0].x(), corner[1].x(), corner[2].x()});
    const auto [top, bottom] = std::minmax({corner[0].y(), corner[1].y(), corner[2].y()});
    const int last_x = static_cast<int>(std::min(right, inverse_.cols - 1.0));
    const int last_y = static_cast<int>(std::min(bottom, inverse_.rows - 1.0));
    for (int y = static_cast<int>(std::max(top, 0.0)); y <= last_y; ++y)
      for (int x = static_cast<int>(std::max(left, 0.0)); x <= last_x; ++x) {
        const Eigen::Vector3d pixel(x, y, 0.0);
        const double a = cross(pixel, corner[1], corner[2]) / area;
        const double b = cross(corner[0], pixel, corner[2]) / area;
        if (a < 0.0 || b < 0.0 || a + b > 1.0) continue;
        double& held = inverse_.at<double>(y, x);
        held =
            std::max(held, a * corner[0].z() + b * corner[1].z() + (1.0 - a - b) * corner[2].z());
      }
  }

  bool sees(const Eigen::Vector3d& point_in_camera_m) const {
    const Eigen::Vector3d place = project(point_in_camera_m);
    if (place.z() == 0.0 || place.x() < 0.0 || place.y() < 0.0 || place.x() > inverse_.cols - 1.0 ||
        place.y() > inverse_.rows - 1.0)
      return false;
    const double nearest = inverse_.at<double>(static_cast<int>(std::lround(place.y())),
                                               static_cast<int>(std::lround(place.x())));
    return nearest == 0.0 || 1.0 / nearest > 0.99 * point_in_camera_m.z() - 1e-3;
  }

 private:
  static double cross(const Eigen::Vector3d& a, const Eigen::Vector3d& b,
                      const Eigen::Vector3d& c) {
    return (b.x() - a.x()) * (c.y() - a.y()) - (b.y() - a.y()) * (c.x() - a.x());
  }

  double scale_;
  cv::Mat inverse_;
  const PinholeImage* image_;
};

}  // namespace

void keepVisibleLines(const PinholeImage& image, const Pose& camera_from_station,
                      WireModel& model) {
  std::vector<Eigen::Vector3d> points_in_camera_m;
  for (const Eigen::Vector3d& point : model.points_m)
    points_in_camera_m.push_back(camera_from_station * point);
  const auto at = [&](int index) { return points_in_camera_m[static_cast<std::size_t>(index)]; };
  DepthImage depth(image);
  for (const auto& face : model.faces)
    depth.draw(
        {depth.project(at(face[0])), depth.project(at(face[1])), depth.project(at(face[2]))});
  std::erase_if(model.lines, [&](const std::array<int, 2>& line) {
    int seen = 0;
    for (const double along : {0.2, 0.5, 0.8})
      seen += depth.sees((1.0 - along) * at(line[0]) + along * at(line[1])) ? 1 : 0;
    return seen < 2;
  });
}

}  // namespace boresight::peers
