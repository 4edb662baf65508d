// SPDX-License-Identifier: Apache-2.0
#include "ui/scene/viewpoint.h"

#include <algorithm>
#include <array>
#include <cmath>

#include "core/base/math.h"

namespace boresight::ui {
namespace {

/// A prepared pinhole of the canvas' size.
Camera pinhole(const QSizeF& canvas, const QPointF& focal_px, const QPointF& centre) {
  Camera camera;
  camera.width = std::max(1, static_cast<int>(std::lround(canvas.width())));
  camera.height = std::max(1, static_cast<int>(std::lround(canvas.height())));
  camera.fx = focal_px.x();
  camera.fy = focal_px.y();
  camera.cx = centre.x();
  camera.cy = centre.y();
  if (prepareCamera(camera) != Status::kOk) camera.valid_radius = 0.0;
  return camera;
}

}  // namespace

std::optional<QPointF> Viewpoint::toCanvas(const Eigen::Vector3d& point_in_station_m) const {
  const Eigen::Vector3d seen = view_from_station * point_in_station_m;
  if (!(seen.z() > 0.0)) return std::nullopt;
  return QPointF(camera.fx * seen.x() / seen.z() + camera.cx,
                 camera.fy * seen.y() / seen.z() + camera.cy);
}

Eigen::Vector3d Viewpoint::rayInStation(const QPointF& pixel) const {
  const Eigen::Vector3d ray((pixel.x() - camera.cx) / camera.fx,
                            (pixel.y() - camera.cy) / camera.fy, 1.0);
  return view_from_station.rotation.conjugate() * ray;
}

Eigen::Vector3d Viewpoint::eyeInStation_m() const {
  return view_from_station.inverse().translation_m;
}

void OrbitCamera::frame(const BoundingBox& bounds) {
  target_m_ = bounds.centre();
  radius_m_ = std::max(0.5 * bounds.diagonal(), 1e-6);
  distance_m_ = 1.1 * radius_m_ / std::sin(0.5 * kFieldOfView_rad);
}

void OrbitCamera::lookFrom(StandardView view) {
  constexpr std::array<std::array<double, 2>, 7> kDirections = {{{-0.5 * kPi, 0.5 * kPi},
                                                                 {-0.5 * kPi, -0.5 * kPi},
                                                                 {-0.5 * kPi, 0.0},
                                                                 {0.5 * kPi, 0.0},
                                                                 {kPi, 0.0},
                                                                 {0.0, 0.0},
                                                                 {-0.9, 0.6}}};
  const auto& [azimuth_rad, elevation_rad] = kDirections[static_cast<std::size_t>(view)];
  azimuth_rad_ = azimuth_rad;
  elevation_rad_ = elevation_rad;
  roll_rad_ = 0.0;
}

void OrbitCamera::orbit(const QPointF& pixels, double canvas_height) {
  const double rad_per_px = kPi / std::max(canvas_height, 1.0);
  // What is dragged follows the pointer also in a rolled picture.
  const double right = std::cos(roll_rad_) * pixels.x() + std::sin(roll_rad_) * pixels.y();
  const double down = std::cos(roll_rad_) * pixels.y() - std::sin(roll_rad_) * pixels.x();
  azimuth_rad_ = std::remainder(azimuth_rad_ - rad_per_px * right, 2.0 * kPi);
  elevation_rad_ = std::clamp(elevation_rad_ + rad_per_px * down, -0.5 * kPi, 0.5 * kPi);
}

void OrbitCamera::roll(double angle_rad) {
  roll_rad_ = std::remainder(roll_rad_ + angle_rad, 2.0 * kPi);
}

void OrbitCamera::pan(const QPointF& pixels, double canvas_height) {
  const Eigen::Matrix3d station_from_view = viewFromStation().transpose();
  const double metres_per_pixel =
      2.0 * distance_m_ * std::tan(0.5 * kFieldOfView_rad) / std::max(canvas_height, 1.0);
  target_m_ -= metres_per_pixel *
               (station_from_view.col(0) * pixels.x() + station_from_view.col(1) * pixels.y());
}

void OrbitCamera::dolly(double factor) {
  distance_m_ = std::clamp(distance_m_ * factor, 1e-3 * radius_m_, 1e3 * radius_m_);
}

Eigen::Matrix3d OrbitCamera::viewFromStation() const {
  const double ca = std::cos(azimuth_rad_);
  const double sa = std::sin(azimuth_rad_);
  const double ce = std::cos(elevation_rad_);
  const double se = std::sin(elevation_rad_);
  Eigen::Matrix3d rows;  // right, down, forward; well defined at the poles too
  rows.row(0) = Eigen::Vector3d(-sa, ca, 0.0);
  rows.row(1) = Eigen::Vector3d(se * ca, se * sa, -ce);
  rows.row(2) = Eigen::Vector3d(-ce * ca, -ce * sa, -se);
  return Eigen::AngleAxisd(roll_rad_, Eigen::Vector3d::UnitZ()).toRotationMatrix() * rows;
}

Viewpoint OrbitCamera::viewpoint(const QSizeF& canvas) const {
  Viewpoint view;
  const Eigen::Matrix3d rotation = viewFromStation();
  view.view_from_station.rotation = Eigen::Quaterniond(rotation).normalized();
  view.view_from_station.translation_m =
      Eigen::Vector3d(0.0, 0.0, distance_m_) - rotation * target_m_;
  // The field of view is that of the smaller side, so that a narrow canvas shows the scene too.
  const double side = std::max(1.0, std::min(canvas.width(), canvas.height()));
  const double focal_px = 0.5 * side / std::tan(0.5 * kFieldOfView_rad);
  view.camera = pinhole(canvas, {focal_px, focal_px},
                        {0.5 * (canvas.width() - 1.0), 0.5 * (canvas.height() - 1.0)});
  return view;
}

Viewpoint throughCamera(const Camera& camera, const Pose& camera_from_station,
                        const ViewTransform& image, const QSizeF& canvas) {
  // A canvas pixel's centre (u, v) lies at (u + 0.5, v + 0.5) in the canvas' coordinates.
  const QPointF centre = image.toWidget(QPointF(camera.cx, camera.cy));
  return {camera_from_station, pinhole(canvas, image.scale() * QPointF(camera.fx, camera.fy),
                                       centre - QPointF(0.5, 0.5))};
}

}  // namespace boresight::ui
