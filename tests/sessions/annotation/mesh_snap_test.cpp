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

std::optional<MeshSnap> snapOf(MeshSnapKind kind, const std::vector<MeshSnap>& snaps) {
  const auto snap = std::find_if(snaps.begin(), snaps.end(),
                                 [&](const MeshSnap& mesh_snap) { return mesh_snap.kind == kind; });
  return snap == snaps.end() ? std::nullopt : std::optional(*snap);
}

class MeshSnapTest : public testing::Test, protected test::BoxScene {
 protected:
  std::optional<MeshSnap> snap(MeshSnapKind kind, const Eigen::Vector2d& pixel) const {
    return snapOf(kind, snapper_.near(camera_, camera_from_station_, pixel, 12.0));
  }
  const MeshSnapper snapper_{scene_.view()};
};

TEST_F(MeshSnapTest, KnowsEdgesAndCirclesButNoDiagonalsAndRefusesABrokenMesh) {
  EXPECT_EQ(snapper_.edges().size(), 12u + 2u * 24u);
  ASSERT_EQ(snapper_.circles().size(), 2u);
  for (const MeshCircle& circle : snapper_.circles()) {
    EXPECT_NEAR(circle.radius_m, 0.03, 1e-6);
    EXPECT_NEAR(circle.centre_in_station_m.x(), 0.03, 1e-6);
    EXPECT_NEAR(circle.centre_in_station_m.y(), 0.02, 1e-6);
    EXPECT_NEAR(std::abs(circle.normal_in_station.z()), 1.0, 1e-6);
  }
  EXPECT_EQ(snapper_.kindAt({-0.1, 0.1, 0.0}), MeshSnapKind::kVertex);
  EXPECT_EQ(snapper_.kindAt({-0.1, 0.0123, 0.0}), MeshSnapKind::kEdge);
  EXPECT_EQ(snapper_.kindAt(snapper_.circles()[0].centre_in_station_m), MeshSnapKind::kCircle);
  EXPECT_EQ(snapper_.kindAt({-0.05, -0.05, 0.0}), std::nullopt) << "the bare face";
  EXPECT_EQ(snapper_.kindAt({-0.1, 0.1, 0.001}), std::nullopt) << "next to the corner";
  scene_.faces.clear();
  EXPECT_THROW(MeshSnapper(scene_.view()), InputError);
}

TEST_F(MeshSnapTest, SnapsToACornerAndToTheNearestPlaceOfAnEdge) {
  const Eigen::Vector3d corner(-0.1, 0.1, 0.0);
  const auto vertex = snap(MeshSnapKind::kVertex, pixelOf(corner) + Eigen::Vector2d(5.0, -3.0));
  ASSERT_TRUE(vertex);
  EXPECT_LT((vertex->point_in_station_m - corner).norm(), 1e-6);
  EXPECT_NEAR(vertex->distance_px, std::hypot(5.0, 3.0), 1e-3);
  EXPECT_FALSE(snap(MeshSnapKind::kVertex, pixelOf(corner) + Eigen::Vector2d(20.0, 0.0)));
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
    Eigen::Matrix3d rows;
    rows.row(0) = backward.unitOrthogonal();
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
  int found = 0;
  int none = 0;
  for (int i = 0; i < 300; ++i) {
    const FreeLook look(random);
    const Eigen::Vector2d pixel(random.uniform(100.0, 500.0), random.uniform(100.0, 400.0));
    double least_px = 40.0;
    Eigen::Vector3d best = Eigen::Vector3d::Zero();
    for (const ModelEdge& edge : snapper_.edges())
      for (const Eigen::Vector3d& end : {edge.start_in_station_m, edge.end_in_station_m}) {
        const double distance_px = (look.pixelOf(end) - pixel).norm();
        if (distance_px >= least_px || !look.sees(scene_.view(), end)) continue;
        least_px = distance_px;
        best = end;
      }
    const auto vertex = snapOf(MeshSnapKind::kVertex,
                               snapper_.near(look.camera, look.view_from_station, pixel, 40.0));
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

TEST_F(MeshSnapTest, TakesFromAnywhereTheNearestPlaceOfAnEdge) {
  Random random = test::randomFor("MeshSnap.TakesTheNearestPlace");
  int found = 0;
  for (int i = 0; i < 40; ++i) {
    const FreeLook look(random);
    const Eigen::Vector2d pixel(random.uniform(150.0, 450.0), random.uniform(150.0, 350.0));
    const auto snapped = snapOf(MeshSnapKind::kEdge,
                                snapper_.near(look.camera, look.view_from_station, pixel, 25.0));
    if (!snapped) continue;
    ++found;
    EXPECT_TRUE(look.sees(scene_.view(), snapped->point_in_station_m));
    const auto distance_px = [&](const Eigen::Vector3d& place_m) {
      return (look.pixelOf(place_m) - pixel).norm();
    };
    EXPECT_NEAR(distance_px(snapped->point_in_station_m), snapped->distance_px, 1e-9);
    double least_px = 1e9;  // over its own edge
    for (int k = 0; k <= 4000; ++k) {
      const double t = k / 4000.0;
      least_px = std::min(least_px, distance_px((1.0 - t) * snapped->edge->start_in_station_m +
                                                t * snapped->edge->end_in_station_m));
    }
    EXPECT_GE(least_px, snapped->distance_px - 1e-6) << "a place of the same edge is nearer";
  }
  EXPECT_GT(found, 10);
}

TEST_F(MeshSnapTest, TellsTheSurfaceThatTryingAllFacesFinds) {
  Random random = test::randomFor("MeshSnap.TellsTheSurface");
  int found = 0;
  for (int i = 0; i < 300; ++i) {
    const FreeLook look(random);
    const Eigen::Vector2d pixel(random.uniform(0.0, 600.0), random.uniform(0.0, 500.0));
    const auto expected = surfacePointAt(look.camera, scene_.view(), look.view_from_station, pixel);
    const auto surface = snapper_.surfaceAt(look.camera, look.view_from_station, pixel);
    ASSERT_EQ(surface.has_value(), expected.has_value());
    if (!surface) continue;
    ++found;
    EXPECT_LT((*surface - expected->in_station_m).norm(), 1e-9);
    EXPECT_TRUE(snapper_.seenFrom(look.eye_m(), *surface));
    EXPECT_FALSE(snapper_.seenFrom(look.eye_m(), *surface + 0.001 * (*surface - look.eye_m())));
  }
  EXPECT_GT(found, 50);
}

TEST_F(MeshSnapTest, TakesACircleOnlyWhereHalfOfItsRimIsSeen) {
  // From below the box hides both rims of the cylinder on its top, from above it carries them.
  for (const double side : {-1.0, 1.0}) {
    const Pose view_from_station{rotationExp({side > 0.0 ? kPi : 0.0, 0.0, 0.0}), {0.0, 0.0, 0.5}};
    const Camera camera = test::makePinhole(600, 500, 800.0);
    const Eigen::Vector3d centre(0.03, 0.02, 0.02);
    Eigen::Vector2d pixel;
    ASSERT_TRUE(project(camera, view_from_station * centre, pixel));
    const auto circle =
        snapOf(MeshSnapKind::kCircle, snapper_.near(camera, view_from_station, pixel, 4.0));
    ASSERT_EQ(circle.has_value(), side > 0.0);
    if (!circle) continue;
    EXPECT_LT((circle->point_in_station_m - centre).norm(), 1e-6);
    EXPECT_NEAR(circle->radius_m, 0.03, 1e-6);
  }
}

}  // namespace
}  // namespace boresight::sessions
