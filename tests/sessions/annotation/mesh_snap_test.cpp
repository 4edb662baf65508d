// SPDX-License-Identifier: Apache-2.0
#include "sessions/annotation/mesh_snap.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

#include "sessions/io/errors.h"
#include "tests/sessions/annotation/box_scene.h"

namespace boresight::sessions {
namespace {

class MeshSnapTest : public testing::Test, protected test::BoxScene {
 protected:
  std::optional<MeshSnap> snap(MeshSnapKind kind, const Eigen::Vector2d& pixel,
                               double radius_px = 12.0) const {
    const MeshSnapper snapper(scene_.view());
    for (const MeshSnap& one : snapper.near(camera_, camera_from_station_, pixel, radius_px))
      if (one.kind == kind) return one;
    return {};
  }
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
