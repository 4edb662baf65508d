// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <optional>

#include <QPointF>
#include <QSizeF>

#include "core/geometry/camera.h"
#include "core/geometry/mesh.h"
#include "core/geometry/pose.h"
#include "ui/views/view_transform.h"

namespace boresight::ui {

/// Pose and (pinhole) camera with which the scene is drawn, shared by canvases, picking and labels.
/// The camera's pixels are those of the canvas; the centre of the top-left pixel is (0, 0); the
/// principal point may lie anywhere.
struct Viewpoint {
  Pose view_from_station;
  Camera camera;

  /// Pixel of a point; empty for a point behind the viewer.
  std::optional<QPointF> toCanvas(const Eigen::Vector3d& point_in_station_m) const;
  /// Direction (not of unit length, z forward 1) of the ray through a pixel, station frame.
  Eigen::Vector3d rayInStation(const QPointF& pixel) const;
  Eigen::Vector3d eyeInStation_m() const;
};

/// The fixed directions to look from. "Front" looks along the station's +y.
enum class StandardView { kTop, kBottom, kFront, kBack, kLeft, kRight, kOblique };

/// A camera that orbits a target, with the station's z axis upright on the screen until it is
/// rolled.
class OrbitCamera {
 public:
  static constexpr double kFieldOfView_rad = 0.6;

  /// Looks at the box from the same side as before, at the distance that shows all of it.
  void frame(const BoundingBox& bounds);
  void lookFrom(StandardView view);

  /// Dragging by `pixels` on a canvas of this height.
  void orbit(const QPointF& pixels, double canvas_height);
  void pan(const QPointF& pixels, double canvas_height);
  /// Turns the picture clockwise.
  void roll(double angle_rad);
  /// A factor below 1 moves nearer.
  void dolly(double factor);

  Viewpoint viewpoint(const QSizeF& canvas) const;
  double distance_m() const { return distance_m_; }
  double elevation_rad() const { return elevation_rad_; }
  double azimuth_rad() const { return azimuth_rad_; }
  double roll_rad() const { return roll_rad_; }
  const Eigen::Vector3d& target_m() const { return target_m_; }

 private:
  Eigen::Matrix3d viewFromStation() const;

  Eigen::Vector3d target_m_ = Eigen::Vector3d::Zero();
  double radius_m_ = 1.0;  ///< of the scene
  double distance_m_ = 3.0;
  double azimuth_rad_ = -0.9;   ///< of the eye, seen from the target, from +x towards +y
  double elevation_rad_ = 0.6;  ///< of the eye above the xy plane
  double roll_rad_ = 0.0;       ///< of the picture, clockwise
};

/// The view through a case's camera, undistorted: `image` is where its image lies on the canvas.
Viewpoint throughCamera(const Camera& camera, const Pose& camera_from_station,
                        const ViewTransform& image, const QSizeF& canvas);

}  // namespace boresight::ui
