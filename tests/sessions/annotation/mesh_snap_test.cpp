// SPDX-License-Identifier: Apache-2.0
#include "sessions/annotation/mesh_snap.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

#include "sessions/io/errors.h"
#include "sessions/io/scene_mesh.h"
#include "tests/sessions/annotation/marked_scene.h"

namespace boresight::sessions {
namespace {

/// A box of 20 x 20 x 4 cm with its top at z = 0, and on it a cylinder of 24 sides, 3 cm in radius
/// and 2 cm high, about (0.03, 0.02). The camera looks down on them.
class MeshSnapTest : public testing::Test {
 protected:
  MeshSnapTest() {
    scene_.parts.resize(1);
    addBox();
    addCylinder();
    camera_from_station_.rotation = rotationExp({kPi * 0.97, 0.05, 0.1});
    camera_from_station_.translation_m = {0.0, 0.0, 0.6};
  }

  std::int32_t addVertex(double x, double y, double z) {
    scene_.vertices_in_station_m.emplace_back(static_cast<float>(x), static_cast<float>(y),
                                              static_cast<float>(z));
    return static_cast<std::int32_t>(scene_.vertices_in_station_m.size()) - 1;
  }

  void addFace(std::int32_t a, std::int32_t b, std::int32_t c) {
    scene_.faces.push_back({{a, b, c}});
    scene_.part_of_face.push_back(0);
  }

  void addQuad(std::int32_t a, std::int32_t b, std::int32_t c, std::int32_t d) {
    addFace(a, b, c);
    addFace(a, c, d);
  }

  void addBox() {
    std::array<std::int32_t, 8> v{};
    for (int i = 0; i < 8; ++i)
      v[static_cast<std::size_t>(i)] = addVertex(
          (i & 1) != 0 ? 0.1 : -0.1, (i & 2) != 0 ? 0.1 : -0.1, (i & 4) != 0 ? 0.0 : -0.04);
    addQuad(v[0], v[2], v[3], v[1]);
    addQuad(v[4], v[5], v[7], v[6]);
    addQuad(v[0], v[1], v[5], v[4]);
    addQuad(v[2], v[6], v[7], v[3]);
    addQuad(v[0], v[4], v[6], v[2]);
    addQuad(v[1], v[3], v[7], v[5]);
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
      addQuad(low[i], low[next], high[next], high[i]);
      addFace(high[i], high[next], middle);
    }
  }

  Eigen::Vector2d pixelOf(const Eigen::Vector3d& point_m) const {
    Eigen::Vector2d pixel = Eigen::Vector2d::Zero();
    EXPECT_TRUE(project(camera_, camera_from_station_ * point_m, pixel));
    return pixel;
  }

  std::optional<MeshSnap> snap(MeshSnapKind kind, const Eigen::Vector2d& pixel,
                               double radius_px = 12.0) const {
    const MeshSnapper snapper(scene_.view());
    for (const MeshSnap& one : snapper.near(camera_, camera_from_station_, pixel, radius_px))
      if (one.kind == kind) return one;
    return {};
  }

  SceneMesh scene_;
  Camera camera_ = test::annotatedCamera(CameraModel::kBrownConrady);
  Pose camera_from_station_;
};

TEST_F(MeshSnapTest, KnowsEdgesAndCirclesButNoDiagonals) {
  const MeshSnapper snapper(scene_.view());
  EXPECT_EQ(snapper.edges().size(), 12u + 2u * 24u);
  ASSERT_EQ(snapper.circles().size(), 2u);
  for (const MeshCircle& circle : snapper.circles()) {
    EXPECT_NEAR(circle.radius_m, 0.03, 1e-6);
    EXPECT_NEAR(circle.centre_in_station_m.x(), 0.03, 1e-6);
    EXPECT_NEAR(circle.centre_in_station_m.y(), 0.02, 1e-6);
    EXPECT_NEAR(std::abs(circle.normal_in_station.z()), 1.0, 1e-6);
  }
}

TEST_F(MeshSnapTest, SnapsToACorner) {
  const Eigen::Vector3d corner(-0.1, 0.1, 0.0);
  const auto vertex = snap(MeshSnapKind::kVertex, pixelOf(corner) + Eigen::Vector2d(5.0, -3.0));
  ASSERT_TRUE(vertex);
  EXPECT_LT((vertex->point_in_station_m - corner).norm(), 1e-6);
  EXPECT_NEAR(vertex->distance_px, std::hypot(5.0, 3.0), 1e-3);
  EXPECT_FALSE(snap(MeshSnapKind::kVertex, pixelOf(corner) + Eigen::Vector2d(20.0, 0.0)));
}

TEST_F(MeshSnapTest, SnapsToTheNearestPlaceOfAnEdge) {
  const Eigen::Vector3d place(-0.1, 0.0123, 0.0);
  const Eigen::Vector2d about = pixelOf(place);
  const Eigen::Vector2d along = (pixelOf(place + Eigen::Vector3d(0, 1e-4, 0)) - about).normalized();
  const Eigen::Vector2d across(-along.y(), along.x());
  const auto edge = snap(MeshSnapKind::kEdge, about + 6.0 * across);
  ASSERT_TRUE(edge);
  // Distortion bends the edge by next to nothing over six pixels.
  EXPECT_LT((edge->point_in_station_m - place).norm(), 2e-5);
  ASSERT_TRUE(edge->edge);
  EXPECT_NEAR((edge->edge->end_in_station_m - edge->edge->start_in_station_m).norm(), 0.2, 1e-6);
}

TEST_F(MeshSnapTest, SnapsToTheCentreOfACircle) {
  const Eigen::Vector3d centre(0.03, 0.02, 0.02);
  const auto circle = snap(MeshSnapKind::kCircle, pixelOf(centre) + Eigen::Vector2d(2.0, 2.0), 4.0);
  ASSERT_TRUE(circle);
  EXPECT_LT((circle->point_in_station_m - centre).norm(), 1e-6);
  EXPECT_NEAR(circle->radius_m, 0.03, 1e-6);
}

TEST_F(MeshSnapTest, LeavesOutWhatIsHidden) {
  // A corner of the box's underside, which no camera above sees.
  const Eigen::Vector3d hidden(-0.1, -0.1, -0.04);
  camera_from_station_.rotation = rotationExp({kPi * 0.75, 0.0, 0.0});
  const auto vertex = snap(MeshSnapKind::kVertex, pixelOf(hidden), 3.0);
  const auto other = snap(MeshSnapKind::kVertex, pixelOf({-0.1, 0.1, -0.04}), 3.0);
  EXPECT_NE(vertex.has_value(), other.has_value());
}

TEST_F(MeshSnapTest, RefusesABrokenMesh) {
  scene_.faces.clear();
  EXPECT_THROW(MeshSnapper(scene_.view()), InputError);
}

}  // namespace
}  // namespace boresight::sessions
