// SPDX-License-Identifier: Apache-2.0
#include "sessions/annotation/mesh_snap.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

#include "sessions/io/files/errors.h"
#include "sessions/trace/surface_point.h"
#include "tests/sessions/annotation/box_scene.h"
#include "tests/support/random_pose.h"

namespace boresight::sessions {
namespace {

class MeshSnapTest : public testing::Test, protected test::BoxScene {
 protected:
  std::optional<MeshSnap> snap(MeshSnapKind kind, const Eigen::Vector2d& pixel,
                               double radius_px = 12.0) const {
    const MeshSnapper snapper(scene_.view());
    for (const MeshSnap& mesh_snap : snapper.near(camera_, camera_from_station_, pixel, radius_px))
      if (mesh_snap.kind == kind) return mesh_snap;
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

TEST_F(MeshSnapTest, PlacesOfTheStation_AreNamedByWhatIsThere) {
  const MeshSnapper snapper(scene_.view());
  EXPECT_EQ(snapper.kindAt({-0.1, 0.1, 0.0}), MeshSnapKind::kVertex);
  EXPECT_EQ(snapper.kindAt({-0.1, 0.0123, 0.0}), MeshSnapKind::kEdge);
  EXPECT_EQ(snapper.kindAt(snapper.circles()[0].centre_in_station_m), MeshSnapKind::kCircle);
  EXPECT_EQ(snapper.kindAt({-0.05, -0.05, 0.0}), std::nullopt) << "the bare face";
  EXPECT_EQ(snapper.kindAt({-0.1, 0.1, 0.001}), std::nullopt) << "next to the corner";
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

/// A free look at the scene from anywhere around it, pinhole, as an orbiting camera has it.
struct FreeLook {
  Camera camera = test::makePinhole(600, 500, 800.0);
  Pose view_from_station;

  explicit FreeLook(Random& random) {
    const Eigen::Vector3d backward = test::randomDirection(random);
    const Eigen::Vector3d right = backward.unitOrthogonal();
    Eigen::Matrix3d rows;
    rows.row(0) = right;
    rows.row(2) = -backward;
    rows.row(1) = rows.row(2).cross(rows.row(0));
    view_from_station.rotation = Eigen::Quaterniond(rows).normalized();
    view_from_station.translation_m = {0.0, 0.0, random.uniform(0.35, 0.8)};
  }

  Eigen::Vector3d eye_m() const { return view_from_station.inverse().translation_m; }
  Eigen::Vector2d pixelOf(const Eigen::Vector3d& place_m) const {
    const Eigen::Vector3d seen = view_from_station * place_m;
    return {camera.fx * seen.x() / seen.z() + camera.cx,
            camera.fy * seen.y() / seen.z() + camera.cy};
  }
  /// By trying all faces on the way to the place.
  bool sees(const MeshView& mesh, const Eigen::Vector3d& place_m) const {
    const auto surface = surfacePointAt(camera, mesh, view_from_station, pixelOf(place_m));
    return !surface || surface->depth_m > (view_from_station * place_m).z() - 2e-5;
  }
};

TEST_F(MeshSnapTest, TakesFromAnywhereWhatTryingAllCornersFinds) {
  Random random = test::randomFor("MeshSnap.TakesFromAnywhere");
  const SceneMesh scene = scene_;
  const MeshSnapper snapper(scene.view());
  int found = 0;
  int none = 0;
  for (int i = 0; i < 300; ++i) {
    const FreeLook look(random);
    const Eigen::Vector2d pixel(random.uniform(100.0, 500.0), random.uniform(100.0, 400.0));
    double least_px = 40.0;
    Eigen::Vector3d best = Eigen::Vector3d::Zero();
    for (const ModelEdge& edge : snapper.edges())
      for (const Eigen::Vector3d& end : {edge.start_in_station_m, edge.end_in_station_m}) {
        const double distance_px = (look.pixelOf(end) - pixel).norm();
        if (distance_px >= least_px || !look.sees(scene.view(), end)) continue;
        least_px = distance_px;
        best = end;
      }
    std::optional<MeshSnap> vertex;
    for (const MeshSnap& mesh_snap : snapper.near(look.camera, look.view_from_station, pixel, 40.0))
      if (mesh_snap.kind == MeshSnapKind::kVertex) vertex = mesh_snap;
    ASSERT_EQ(vertex.has_value(), least_px < 40.0) << "look " << i;
    ++(vertex ? found : none);
    if (vertex) {
      EXPECT_NEAR(vertex->distance_px, least_px, 1e-9);
      EXPECT_EQ(vertex->point_in_station_m, best);
    }
  }
  EXPECT_GT(found, 50);
  EXPECT_GT(none, 50);
}

TEST_F(MeshSnapTest, TakesFromAnywhereTheNearestPlaceOfAllSeenEdges) {
  Random random = test::randomFor("MeshSnap.TakesTheNearestPlace");
  const SceneMesh scene = scene_;
  const MeshSnapper snapper(scene.view());
  constexpr int kPlaces = 4000;
  int found = 0;
  for (int i = 0; i < 40; ++i) {
    const FreeLook look(random);
    const Eigen::Vector2d pixel(random.uniform(150.0, 450.0), random.uniform(150.0, 350.0));
    std::optional<MeshSnap> snapped;
    for (const MeshSnap& mesh_snap : snapper.near(look.camera, look.view_from_station, pixel, 25.0))
      if (mesh_snap.kind == MeshSnapKind::kEdge) snapped = mesh_snap;
    if (!snapped) continue;
    ++found;
    EXPECT_TRUE(look.sees(scene.view(), snapped->point_in_station_m));
    double least_px = 1e9;  // over its own edge, and over places of others that are seen
    for (const ModelEdge& edge : snapper.edges())
      for (int k = 0; k <= kPlaces; ++k) {
        const double t = static_cast<double>(k) / kPlaces;
        const Eigen::Vector3d place =
            (1.0 - t) * edge.start_in_station_m + t * edge.end_in_station_m;
        const double distance_px = (look.pixelOf(place) - pixel).norm();
        if (distance_px < std::min(least_px, snapped->distance_px - 1e-6) && edge == *snapped->edge)
          least_px = distance_px;
      }
    EXPECT_GT(least_px, 1e8) << "a place of the same edge is nearer";
    EXPECT_NEAR((look.pixelOf(snapped->point_in_station_m) - pixel).norm(), snapped->distance_px,
                1e-9);
  }
  EXPECT_GT(found, 10);
}

TEST_F(MeshSnapTest, TellsTheSurfaceThatTryingAllFacesFinds) {
  Random random = test::randomFor("MeshSnap.TellsTheSurface");
  const SceneMesh scene = scene_;
  const MeshSnapper snapper(scene.view());
  int found = 0;
  for (int i = 0; i < 300; ++i) {
    const FreeLook look(random);
    const Eigen::Vector2d pixel(random.uniform(0.0, 600.0), random.uniform(0.0, 500.0));
    const auto expected = surfacePointAt(look.camera, scene.view(), look.view_from_station, pixel);
    const auto surface = snapper.surfaceAt(look.camera, look.view_from_station, pixel);
    ASSERT_EQ(surface.has_value(), expected.has_value());
    if (!surface) continue;
    ++found;
    EXPECT_LT((*surface - expected->in_station_m).norm(), 1e-9);
    EXPECT_TRUE(snapper.seenFrom(look.eye_m(), *surface));
    EXPECT_FALSE(snapper.seenFrom(look.eye_m(), *surface + 0.001 * (*surface - look.eye_m())));
  }
  EXPECT_GT(found, 50);
}

TEST_F(MeshSnapTest, TakesACircleOnlyWhereHalfOfItsRimIsSeen) {
  const MeshSnapper snapper(scene_.view());
  // From below the box hides both rims of the cylinder on its top, from above it carries them.
  for (const double side : {-1.0, 1.0}) {
    Pose view_from_station;
    view_from_station.rotation = rotationExp({side > 0.0 ? kPi : 0.0, 0.0, 0.0});
    view_from_station.translation_m = {0.0, 0.0, 0.5};
    const Camera camera = test::makePinhole(600, 500, 800.0);
    const Eigen::Vector3d centre(0.03, 0.02, 0.02);
    Eigen::Vector2d pixel;
    ASSERT_TRUE(project(camera, view_from_station * centre, pixel));
    bool circle = false;
    for (const MeshSnap& mesh_snap : snapper.near(camera, view_from_station, pixel, 4.0)) {
      if (mesh_snap.kind != MeshSnapKind::kCircle) continue;
      circle = true;
      EXPECT_LT((mesh_snap.point_in_station_m - centre).norm(), 1e-6);
      EXPECT_NEAR(mesh_snap.radius_m, 0.03, 1e-6);
    }
    EXPECT_EQ(circle, side > 0.0);
  }
}

TEST_F(MeshSnapTest, RefusesABrokenMesh) {
  scene_.faces.clear();
  EXPECT_THROW(MeshSnapper(scene_.view()), InputError);
}

}  // namespace
}  // namespace boresight::sessions
