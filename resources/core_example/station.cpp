// SPDX-License-Identifier: Apache-2.0
#include "station.h"

#include <algorithm>
#include <array>
#include <limits>

#include <Eigen/Geometry>

namespace example {
namespace {

struct Triangle {
  Eigen::Vector3d corner, to_second, to_third;  ///< camera frame, metres
  double gray = 0.0;
};

/// Distance along the ray in units of its length; infinite where it passes by (Moeller, Trumbore).
double hit(const Triangle& triangle, const Eigen::Vector3d& ray) {
  constexpr double kNever = std::numeric_limits<double>::infinity();
  const Eigen::Vector3d across = ray.cross(triangle.to_third);
  const double determinant = triangle.to_second.dot(across);
  if (determinant == 0.0) return kNever;
  const double u = -triangle.corner.dot(across) / determinant;
  const Eigen::Vector3d along = (-triangle.corner).cross(triangle.to_second);
  const double v = ray.dot(along) / determinant;
  if (u < 0.0 || v < 0.0 || u + v > 1.0) return kNever;
  const double distance = triangle.to_third.dot(along) / determinant;
  return distance > 0.0 ? distance : kNever;
}

std::vector<Triangle> litTriangles(const Station& station,
                                   const boresight::Pose& camera_from_station) {
  const Eigen::Vector3d lamp = Eigen::Vector3d(-0.5, -0.6, -0.62).normalized();
  std::vector<Triangle> triangles;
  for (const boresight::Face& face : station.faces) {
    std::array<Eigen::Vector3d, 3> corners;
    for (std::size_t i = 0; i < 3; ++i) {
      const auto vertex = static_cast<std::size_t>(face.vertex[i]);
      corners[i] = camera_from_station * station.vertices_in_station_m[vertex].cast<double>();
    }
    Triangle one{corners[0], corners[1] - corners[0], corners[2] - corners[0]};
    const Eigen::Vector3d normal = one.to_second.cross(one.to_third).normalized();
    one.gray = 60.0 + 180.0 * std::max(0.0, normal.dot(lamp));
    triangles.push_back(one);
  }
  return triangles;
}

double grayAlong(const std::vector<Triangle>& triangles, const Eigen::Vector3d& ray) {
  double nearest = std::numeric_limits<double>::infinity();
  double gray = 25.0;  // of the background
  for (const Triangle& triangle : triangles) {
    const double distance = hit(triangle, ray);
    if (distance >= nearest) continue;
    nearest = distance;
    gray = triangle.gray;
  }
  return gray;
}

}  // namespace

void Station::addBox(const Eigen::Vector3d& minimum_m, const Eigen::Vector3d& maximum_m) {
  const auto first = static_cast<std::int32_t>(vertices_in_station_m.size());
  for (int corner = 0; corner < 8; ++corner) {
    const Eigen::Vector3d place((corner & 1) != 0 ? maximum_m.x() : minimum_m.x(),
                                (corner & 2) != 0 ? maximum_m.y() : minimum_m.y(),
                                (corner & 4) != 0 ? maximum_m.z() : minimum_m.z());
    vertices_in_station_m.push_back(place.cast<float>());
  }
  // Corners of each side, counter-clockwise from outside.
  constexpr std::array<std::array<std::int32_t, 4>, 6> kSides = {
      {{0, 2, 3, 1}, {4, 5, 7, 6}, {0, 1, 5, 4}, {2, 6, 7, 3}, {0, 4, 6, 2}, {1, 3, 7, 5}}};
  for (const auto& side : kSides) {
    faces.push_back({{first + side[0], first + side[1], first + side[2]}});
    faces.push_back({{first + side[0], first + side[2], first + side[3]}});
    part_of_face.insert(part_of_face.end(), 2, 0);
  }
}

Station makeStation() {
  Station station;
  station.addBox({-0.080, -0.065, -0.008}, {0.080, 0.065, 0.000});
  station.addBox({-0.066, -0.047, 0.000}, {-0.036, -0.025, 0.030});
  station.addBox({0.034, -0.054, 0.000}, {0.052, -0.008, 0.018});
  station.addBox({-0.040, 0.028, 0.000}, {0.012, 0.046, 0.042});
  station.addBox({0.050, 0.026, 0.000}, {0.070, 0.050, 0.012});
  station.addBox({-0.014, -0.020, 0.000}, {0.010, 0.006, 0.025});
  return station;
}

std::vector<std::uint8_t> photograph(const Station& station, const boresight::Camera& camera,
                                     const boresight::Pose& camera_from_station) {
  const std::vector<Triangle> triangles = litTriangles(station, camera_from_station);
  std::vector<std::uint8_t> pixels;
  for (int y = 0; y < camera.height; ++y) {
    for (int x = 0; x < camera.width; ++x) {
      double sum = 0.0;
      for (int quarter = 0; quarter < 4; ++quarter) {
        const Eigen::Vector2d place(x + ((quarter & 1) != 0 ? 0.25 : -0.25),
                                    y + ((quarter & 2) != 0 ? 0.25 : -0.25));
        Eigen::Vector3d ray;
        if (boresight::unproject(camera, place, ray)) sum += grayAlong(triangles, ray);
      }
      pixels.push_back(static_cast<std::uint8_t>(sum / 4.0 + 0.5));
    }
  }
  return pixels;
}

}  // namespace example
