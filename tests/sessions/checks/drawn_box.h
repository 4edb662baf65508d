// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <memory>
#include <set>
#include <utility>
#include <vector>

#include <gtest/gtest.h>
#include <opencv2/imgproc.hpp>

#include "sessions/checks/edge_evidence.h"
#include "sessions/checks/review_subject.h"
#include "tests/support/box_mesh.h"
#include "tests/support/random_pose.h"

namespace boresight::test {

/// Of a pose that is known to this sigma along each of the camera's axes, and not turned.
inline Matrix6d translationCovariance(double sigma_m) {
  Matrix6d covariance = Matrix6d::Zero();
  covariance.bottomRightCorner<3, 3>().diagonal().setConstant(sigma_m * sigma_m);
  return covariance;
}

/// A box of 12 x 8 x 5 cm half a metre from a camera of 800 x 600 pixels, that sees three of its
/// faces, and an image of it drawn by OpenCV: no renderer of ours has a part in it.
class DrawnBox {
 public:
  DrawnBox() {
    camera_from_station_.rotation = rotationExp({2.4, 0.0, 0.0}) * rotationExp({0.0, 0.0, 0.6});
    camera_from_station_.translation_m = {0.01, -0.005, 0.5};
    draw();
  }

  /// The edges that the pose which was drawn predicts.
  sessions::PredictedEdges edges() const {
    return sessions::predictEdges(camera_, scene_.view(), camera_from_station_);
  }

  /// A subject with this image, to be checked at a pose of its own.
  sessions::ReviewSubject subject(const Pose& camera_from_station) const {
    auto loaded = std::make_shared<sessions::LoadedCase>();
    loaded->source.camera = camera_;
    loaded->scene = scene_;
    loaded->image.width = camera_.width;
    loaded->image.height = camera_.height;
    loaded->image.pixels.assign(image_.datastart, image_.dataend);
    sessions::ReviewSubject review_subject;
    review_subject.loaded = loaded;
    review_subject.camera_from_station = camera_from_station;
    review_subject.requirement.normal_mm = 0.4;
    review_subject.source = sessions::PoseSource::kAnnotation;
    return review_subject;
  }

  Eigen::Vector2d pixelOf(const Eigen::Vector3d& point_m) const {
    Eigen::Vector2d pixel = Eigen::Vector2d::Zero();
    EXPECT_TRUE(project(camera_, camera_from_station_ * point_m, pixel));
    return pixel;
  }

  /// Fills a polygon of the image, its corners to a sixteenth of a pixel, with smooth borders.
  void fill(const std::vector<Eigen::Vector2d>& corners, int gray) {
    std::vector<cv::Point> points;
    for (const Eigen::Vector2d& corner : corners)
      points.emplace_back(static_cast<int>(std::lround((corner.x() + 0.5) * kFine * 16.0 - 8.0)),
                          static_cast<int>(std::lround((corner.y() + 0.5) * kFine * 16.0 - 8.0)));
    cv::fillConvexPoly(fine_, points, cv::Scalar(gray), cv::LINE_8, 4);
    cv::resize(fine_, image_, cv::Size(camera_.width, camera_.height), 0, 0, cv::INTER_AREA);
  }

  /// A patch on the top face, `share` of it in either direction, and the length of its border, px.
  double addPatch(double share, int gray) {
    std::vector<Eigen::Vector2d> corners;
    for (const auto& [x, y] : {std::pair{-1, -1}, {1, -1}, {1, 1}, {-1, 1}})
      corners.push_back(pixelOf({share * x * kHalf.x(), share * y * kHalf.y(), kHalf.z()}));
    fill(corners, gray);
    double length_px = 0.0;
    for (std::size_t i = 0; i < 4; ++i) length_px += (corners[(i + 1) % 4] - corners[i]).norm();
    return length_px;
  }

  /// Length of the edges that are seen, px: three faces' borders, each shared one once.
  double visibleLength_px() const { return visible_px_; }

  Camera camera_ = makePinhole(800, 600, 1000.0);
  Pose camera_from_station_;
  sessions::SceneMesh scene_ = boxMesh(kHalf);
  cv::Mat image_;

 private:
  static constexpr int kFine = 4;
  inline static const Eigen::Vector3d kHalf{0.06, 0.04, 0.025};
  static Eigen::Vector3d corner(int i) { return boxCorner(kHalf, i); }

  void draw() {
    fine_ = cv::Mat(camera_.height * kFine, camera_.width * kFine, CV_8U, cv::Scalar(40));
    std::set<std::pair<int, int>> known;
    int gray = 90;
    for (const auto& quad : kBoxQuads) {
      const Eigen::Vector3d a = camera_from_station_ * corner(quad[0]);
      const Eigen::Vector3d ab = camera_from_station_ * corner(quad[1]) - a;
      const Eigen::Vector3d ad = camera_from_station_ * corner(quad[3]) - a;
      if (ab.cross(ad).dot(a) >= 0.0) continue;  // turned away
      std::vector<Eigen::Vector2d> corners;
      for (const int i : quad) corners.push_back(pixelOf(corner(i)));
      fill(corners, gray);
      gray += 50;
      for (std::size_t i = 0; i < 4; ++i) {
        const auto [from, to] = std::minmax({quad[i], quad[(i + 1) % 4]});
        if (known.emplace(from, to).second)
          visible_px_ += (pixelOf(corner(from)) - pixelOf(corner(to))).norm();
      }
    }
  }

  cv::Mat fine_;
  double visible_px_ = 0.0;
};

}  // namespace boresight::test
