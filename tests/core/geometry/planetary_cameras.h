// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <string>
#include <vector>

#include "core/geometry/cahv_model.h"
#include "tests/core/geometry/example_cameras.h"

namespace boresight::test {

/// Results of cahv_reference.py, in the reference frame.
struct PlanetaryCamera {
  struct Sight {
    Eigen::Vector2d pixel;
    Eigen::Vector3d origin_m, direction, point_m;
  };
  std::string name;
  CahvModel cahv;
  int width, height;
  std::vector<Sight> sights;

  /// In the camera frame.
  Camera camera() const {
    Camera camera;
    Pose camera_from_reference;
    if (cameraFromCahv(cahv, width, height, camera, camera_from_reference) != Status::kOk)
      camera.valid_radius = 0.0;
    return camera;
  }
};

inline void PrintTo(const PlanetaryCamera& camera, std::ostream* out) { *out << camera.name; }

/// Invented cameras of the CAHV family, like those of masts and hazard cameras.
inline std::vector<PlanetaryCamera> planetaryCameras() {
  return {
#include "tests/core/geometry/cahv_reference.inc"
  };
}

inline std::vector<NamedCamera> exampleAndPlanetaryCameras() {
  std::vector<NamedCamera> cameras = exampleCameras();
  for (const PlanetaryCamera& planetary : planetaryCameras())
    cameras.push_back({planetary.name + "Planetary", planetary.camera()});
  return cameras;
}

inline Camera planetaryCamera(const std::string& name) {
  for (const PlanetaryCamera& known : planetaryCameras())
    if (known.name == name) return known.camera();
  return {};
}

}  // namespace boresight::test
