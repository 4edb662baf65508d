// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <cmath>
#include <cstdint>
#include <vector>

#include <gtest/gtest.h>

#include "sessions/io/meshes/scene_mesh.h"
#include "tests/sessions/annotation/annotated_scene.h"
#include "tests/support/box_mesh.h"

namespace boresight::test {

/// A box of 20 x 20 x 4 cm with its top at z = 0, and on it a cylinder of 24 sides, 3 cm in radius
/// and 2 cm high, about (0.03, 0.02). The camera looks down on them.
class BoxScene {
 public:
  BoxScene() {
    for (Eigen::Vector3f& corner : scene_.vertices_in_station_m)
      corner.z() = corner.z() > 0.0F ? 0.0F : -0.04F;
    addCylinder();
    camera_from_station_.rotation = rotationExp({kPi * 0.97, 0.05, 0.1});
    camera_from_station_.translation_m = {0.0, 0.0, 0.6};
  }

  Eigen::Vector2d pixelOf(const Eigen::Vector3d& point_m) const {
    Eigen::Vector2d pixel = Eigen::Vector2d::Zero();
    EXPECT_TRUE(project(camera_, camera_from_station_ * point_m, pixel));
    return pixel;
  }

 protected:
  std::int32_t addVertex(double x, double y, double z) {
    scene_.vertices_in_station_m.emplace_back(static_cast<float>(x), static_cast<float>(y),
                                              static_cast<float>(z));
    return static_cast<std::int32_t>(scene_.vertices_in_station_m.size()) - 1;
  }

  void addCylinder() {
    constexpr int kSides = 24;
    std::vector<std::int32_t> low, high;
    for (int i = 0; i < kSides; ++i) {
      const double angle = 2.0 * kPi * i / kSides;
      const double x = 0.03 + 0.03 * std::cos(angle);
      const double y = 0.02 + 0.03 * std::sin(angle);
      low.push_back(addVertex(x, y, 0.001));
      high.push_back(addVertex(x, y, 0.02));
    }
    const std::int32_t middle = addVertex(0.03, 0.02, 0.02);
    for (std::size_t i = 0; i < kSides; ++i) {
      const std::size_t next = (i + 1) % kSides;
      addQuad(scene_, low[i], low[next], high[next], high[i]);
      scene_.faces.push_back({{high[i], high[next], middle}});
      scene_.part_of_face.push_back(0);
    }
  }

  sessions::SceneMesh scene_ = boxMesh({0.1, 0.1, 0.02});
  Camera camera_ = annotatedCamera(CameraModel::kBrownConrady);
  Pose camera_from_station_;
};

}  // namespace boresight::test
