// SPDX-License-Identifier: Apache-2.0
#include "core/match/search_window.h"

#include <algorithm>
#include <array>
#include <cmath>

#include "core/base/math.h"
#include "core/base/nth.h"
#include "core/match/rotation_bounds.h"
#include "core/render/rounding.h"

namespace boresight {
namespace {

// Bounds loosen with the square of a box's width: wider boxes of rotations are cut.
constexpr double kWidestRotation_rad = 0.2;
constexpr int kMostParts = 18;
constexpr double kNearest_m = 1e-6;

/// The directions q = (x/z, y/z) with normal.q <= bound.
struct HalfPlane {
  Eigen::Vector2d normal = Eigen::Vector2d::Zero();
  double bound = 0.0;
};

/// Bounds of the directions of a point: the first four half planes are x/z <=, y/z <=, -x/z <=,
/// -y/z <=; where lenses distort, the rest cut the corners of that rectangle.
struct DirectionBounds {
  static constexpr int kMost = 12;
  std::array<HalfPlane, kMost> half_planes;
  std::size_t count = 0;

  void add(const Eigen::Vector2d& normal, const Eigen::Vector2d& inside) {
    half_planes[count++] = {normal, normal.dot(inside)};
  }
};

bool isUsable(const Eigen::Vector3d& point, const SeedUncertainty& uncertainty) {
  const Eigen::Vector3d& translation_m = uncertainty.translation_m;
  const Eigen::Vector3d& rotation_rad = uncertainty.rotation_rad;
  return point.allFinite() && point.z() > 0.0 && uncertainty.pivot_in_camera_m.allFinite() &&
         translation_m.allFinite() && translation_m.minCoeff() >= 0.0 && rotation_rad.allFinite() &&
         rotation_rad.minCoeff() >= 0.0 && rotation_rad.maxCoeff() <= kPi;
}

/// The places p' = R d + c + t of a point for the rotations of a box and |t_i| <= translation_i.
class PlaceBounds {
 public:
  PlaceBounds(const RotationBounds& rotated, const SeedUncertainty& uncertainty)
      : rotated_(rotated),
        c_(uncertainty.pivot_in_camera_m),
        translation_m_(uncertainty.translation_m) {
    Eigen::Vector3d point;
    double excess = 0.0;
    const double nearest = rotated_.upper({0.0, 0.0, -1.0}, point, excess);
    least_z_m_ = c_.z() - translation_m_.z() - nearest - rotated_.excessPerUnitOfZ();
  }

  /// Positive when all places lie in front of the camera.
  double leastZ() const { return least_z_m_; }

  /// The least k >= `start` found such that (normal.p'_xy) / p'_z <= k at all places.
  /// That is F(k) <= 0 for F(k) = max (normal, -k).p', which is convex and falls with a slope of at
  /// least the least z: Newton's method comes from below, and the last step, with the least slope,
  /// ends above.
  double largestRatio(const Eigen::Vector2d& normal, double start) const {
    constexpr int kNewtonSteps = 3;
    const double translation =
        std::abs(normal.x()) * translation_m_.x() + std::abs(normal.y()) * translation_m_.y();
    double k = start;
    for (int step = 0; step <= kNewtonSteps; ++step) {
      const Eigen::Vector3d n(normal.x(), normal.y(), -k);
      Eigen::Vector3d point;
      double excess = 0.0;
      const double value = rotated_.upper(n, point, excess) + n.dot(c_) + translation +
                           std::abs(k) * translation_m_.z();
      if (value <= 0.0) return k;
      const double z = point.z() + c_.z() - (k < 0.0 ? -1.0 : 1.0) * translation_m_.z();
      k += value / (step < kNewtonSteps ? z : least_z_m_);
    }
    return k;
  }

 private:
  const RotationBounds& rotated_;
  const Eigen::Vector3d& c_;
  const Eigen::Vector3d& translation_m_;
  double least_z_m_ = 0.0;
};

int partsFor(double rotation_rad) {
  const double parts = std::floor(2.0 * rotation_rad / kWidestRotation_rad) + 1.0;
  return static_cast<int>(std::clamp(parts, 1.0, static_cast<double>(kMostParts)));
}

/// Half planes across the diagonals, and along and across the radius: the further from the axis,
/// the more the places spread along it, and lenses bend rectangles.
void addOblique(const Eigen::Vector2d& inside, DirectionBounds& bounds) {
  constexpr double kLeastRadius = 0.1;
  for (const double sign : {-1.0, 1.0}) {
    bounds.add({sign, 1.0}, inside);
    bounds.add({sign, -1.0}, inside);
    if (inside.squaredNorm() < kLeastRadius * kLeastRadius) continue;
    bounds.add(sign * inside, inside);
    bounds.add({sign * inside.y(), -sign * inside.x()}, inside);
  }
}

/// Loosens the bounds until they hold over the whole uncertainty; false when the point may come to
/// lie behind the camera.
bool boundDirections(const Eigen::Vector3d& point_in_camera_m, const SeedUncertainty& uncertainty,
                     DirectionBounds& bounds) {
  const Eigen::Vector3d d = point_in_camera_m - uncertainty.pivot_in_camera_m;
  const Eigen::Vector3d& widest = uncertainty.rotation_rad;
  const std::array<int, 3> parts{partsFor(widest[0]), partsFor(widest[1]), partsFor(widest[2])};
  const auto corner = [&](int axis, int k) {
    return widest[axis] * (2.0 * k / nth(parts, axis) - 1.0);
  };
  for (int i = 0; i < parts[0]; ++i) {
    for (int j = 0; j < parts[1]; ++j) {
      for (int k = 0; k < parts[2]; ++k) {
        const RotationBounds rotated({corner(0, i), corner(1, j), corner(2, k)},
                                     {corner(0, i + 1), corner(1, j + 1), corner(2, k + 1)}, d);
        const PlaceBounds places(rotated, uncertainty);
        if (places.leastZ() < kNearest_m) return false;
        for (std::size_t h = 0; h < bounds.count; ++h) {
          HalfPlane& half_plane = bounds.half_planes[h];
          half_plane.bound = places.largestRatio(half_plane.normal, half_plane.bound);
        }
      }
    }
  }
  return true;
}

/// A convex polygon of directions, in order.
struct Polygon {
  std::array<Eigen::Vector2d, DirectionBounds::kMost + 1> corners;
  std::size_t count = 0;

  void add(const Eigen::Vector2d& corner) {
    if (count < corners.size()) corners[count++] = corner;
  }
};

/// The part of a convex polygon inside a half plane (Sutherland and Hodgman).
Polygon clipped(const Polygon& polygon, const HalfPlane& half_plane) {
  Polygon result;
  for (std::size_t k = 0; k < polygon.count; ++k) {
    const Eigen::Vector2d& from = polygon.corners[k];
    const Eigen::Vector2d& to = polygon.corners[(k + 1) % polygon.count];
    const double before = half_plane.normal.dot(from) - half_plane.bound;
    const double after = half_plane.normal.dot(to) - half_plane.bound;
    if (before <= 0.0) result.add(from);
    if ((before < 0.0 && after > 0.0) || (before > 0.0 && after < 0.0)) {
      result.add(from + before / (before - after) * (to - from));
    }
  }
  return result;
}

Polygon polygonOf(const DirectionBounds& bounds) {
  const auto& h = bounds.half_planes;
  Polygon polygon;
  polygon.add({-h[2].bound, -h[3].bound});
  polygon.add({h[0].bound, -h[3].bound});
  polygon.add({h[0].bound, h[1].bound});
  polygon.add({-h[2].bound, h[1].bound});
  for (std::size_t k = 4; k < bounds.count; ++k) polygon = clipped(polygon, h[k]);
  return polygon;
}

/// Pixel of a direction; where the camera cannot see it, of the last direction towards it from
/// `inside` (which the camera sees) that it can. Along the border of a polygon that moves the part
/// outside the valid field to the field's border.
Eigen::Vector2d pixelTowards(const Camera& camera, const Eigen::Vector2d& inside,
                             const Eigen::Vector2d& direction, bool& pulled_in) {
  constexpr int kBisections = 20;
  Eigen::Vector2d pixel;
  if (projectDirection(camera, {direction.x(), direction.y(), 1.0}, pixel)) return pixel;
  pulled_in = true;
  double low = 0.0, high = 1.0;
  for (int k = 0; k < kBisections; ++k) {
    const double middle = 0.5 * (low + high);
    const Eigen::Vector2d tried = inside + middle * (direction - inside);
    (projectDirection(camera, {tried.x(), tried.y(), 1.0}, pixel) ? low : high) = middle;
  }
  const Eigen::Vector2d last = inside + low * (direction - inside);
  if (!projectDirection(camera, {last.x(), last.y(), 1.0}, pixel)) {
    pixel = {camera.cx, camera.cy};  // `inside` itself cannot be seen: excluded by the caller
  }
  return pixel;
}

/// Extends `pixels` by the image of one side of a polygon of directions. Between samples the image
/// bends away from its chord by an eighth of the second difference, for smooth distortion; twice
/// that is allowed for where the extreme may lie between samples, and the whole distance between
/// samples where the side leaves the valid field.
void extendBySide(const Camera& camera, const Eigen::Vector2d& inside, const Eigen::Vector2d& from,
                  const Eigen::Vector2d& to, Eigen::AlignedBox2d& pixels) {
  constexpr std::size_t kSegments = 4;
  std::array<Eigen::Vector2d, kSegments + 1> samples;
  bool pulled_in = false;
  for (std::size_t k = 0; k <= kSegments; ++k) {
    const double share = static_cast<double>(k) / static_cast<double>(kSegments);
    samples[k] = pixelTowards(camera, inside, from + share * (to - from), pulled_in);
    pixels.extend(samples[k]);
  }
  for (int axis = 0; axis < 2; ++axis) {
    double bend = 0.0;
    for (std::size_t k = 1; k < kSegments; ++k) {
      bend = std::max(
          bend, std::abs(samples[k - 1][axis] - 2.0 * samples[k][axis] + samples[k + 1][axis]));
    }
    for (std::size_t k = 1; k <= kSegments; ++k) {
      const double change = std::abs(samples[k][axis] - samples[k - 1][axis]);
      double slack = change < bend ? 0.25 * bend : 0.0;
      if (pulled_in) slack = change;
      const auto [low, high] = std::minmax(samples[k - 1][axis], samples[k][axis]);
      pixels.min()[axis] = std::min(pixels.min()[axis], low - slack);
      pixels.max()[axis] = std::max(pixels.max()[axis], high + slack);
    }
  }
}

/// With a pupil that moves along O, the view from the pupil equals the view from the camera's
/// centre after the opposite translation. The pupil's range is therefore a further unknown
/// translation.
void seeFromPupil(const Camera& camera, Eigen::Vector3d& point_in_camera_m,
                  SeedUncertainty& uncertainty) {
  if (!pupilMoves(camera)) return;
  const CahvLens& lens = camera.cahv;
  const double middle_m = 0.5 * (lens.pupil_low_m + lens.pupil_high_m);
  const double reach_m = 0.5 * (lens.pupil_high_m - lens.pupil_low_m);
  point_in_camera_m -= middle_m * lens.optical_axis;
  uncertainty.pivot_in_camera_m -= middle_m * lens.optical_axis;
  uncertainty.translation_m += reach_m * lens.optical_axis.cwiseAbs();
}

/// Bounds of the pixels of a point. The Jacobian of every distortion model is regular in the valid
/// field, which it maps one to one: extremes lie on the sides of the polygon.
bool boundPixels(const Camera& camera, Eigen::Vector3d point_in_camera_m,
                 SeedUncertainty uncertainty, Eigen::AlignedBox2d& pixels) {
  Eigen::Vector2d pixel;
  if (!project(camera, point_in_camera_m, pixel)) return false;
  pixels.extend(pixel);
  seeFromPupil(camera, point_in_camera_m, uncertainty);
  Eigen::Vector2d seen;
  if (pupilMoves(camera) && !projectDirection(camera, point_in_camera_m, seen)) return false;
  const Eigen::Vector2d inside = point_in_camera_m.head<2>() / point_in_camera_m.z();
  DirectionBounds bounds;
  bounds.add({1.0, 0.0}, inside);
  bounds.add({0.0, 1.0}, inside);
  bounds.add({-1.0, 0.0}, inside);
  bounds.add({0.0, -1.0}, inside);
  if (camera.model == CameraModel::kPinhole) {
    if (!boundDirections(point_in_camera_m, uncertainty, bounds)) return false;
    const auto& h = bounds.half_planes;
    pixels.max() = {camera.fx * h[0].bound + camera.cx, camera.fy * h[1].bound + camera.cy};
    pixels.min() = {camera.cx - camera.fx * h[2].bound, camera.cy - camera.fy * h[3].bound};
    return true;
  }
  addOblique(inside, bounds);
  if (!boundDirections(point_in_camera_m, uncertainty, bounds)) return false;
  const Polygon polygon = polygonOf(bounds);
  for (std::size_t k = 0; k < polygon.count; ++k) {
    extendBySide(camera, inside, polygon.corners[k], polygon.corners[(k + 1) % polygon.count],
                 pixels);
  }
  return true;
}

}  // namespace

SearchWindow searchWindow(const Camera& camera, const Eigen::Vector3d& point_in_camera_m,
                          const SeedUncertainty& uncertainty, int template_side_px) {
  constexpr double kRounding_px = 1e-6;
  const int half = template_side_px / 2;
  if (half < 1 || !isUsable(point_in_camera_m, uncertainty)) return {};
  if (camera.width < template_side_px || camera.height < template_side_px) return {};
  Eigen::AlignedBox2d pixels;
  if (!boundPixels(camera, point_in_camera_m, uncertainty, pixels)) return {};

  // Rounded outwards, so that the window holds the pixels on both sides of every place; one pixel
  // beyond the clipped range marks a bound outside.
  SearchWindow window;
  window.x_min = floorClamped(pixels.min().x() - kRounding_px, -1, camera.width + 1);
  window.y_min = floorClamped(pixels.min().y() - kRounding_px, -1, camera.height + 1);
  window.x_max = floorClamped(pixels.max().x() + kRounding_px, -2, camera.width + 1) + 1;
  window.y_max = floorClamped(pixels.max().y() + kRounding_px, -2, camera.height + 1) + 1;
  window.x_min = std::max(window.x_min, half);
  window.y_min = std::max(window.y_min, half);
  window.x_max = std::min(window.x_max, camera.width - half);
  window.y_max = std::min(window.y_max, camera.height - half);
  return window.empty() ? SearchWindow{} : window;
}

}  // namespace boresight
