// SPDX-License-Identifier: Apache-2.0
#include "sessions/trace/surface_point.h"

#include <gtest/gtest.h>

#include "sessions/io/meshes/scene_mesh.h"
#include "tests/support/random_pose.h"

namespace boresight::sessions {
namespace {

/// Many small triangles all over a box of 1 x 2 x 0.5 m, and some large ones across it.
SceneMesh randomTriangles(Random& random, int count) {
  SceneMesh mesh;
  mesh.parts.resize(1);
  for (int i = 0; i < count; ++i) {
    const double size_m = i % 50 == 0 ? 0.7 : 0.05;
    const Eigen::Vector3d middle(random.uniform(0.0, 1.0), random.uniform(0.0, 2.0),
                                 random.uniform(0.0, 0.5));
    const auto first = static_cast<std::int32_t>(mesh.vertices_in_station_m.size());
    for (int k = 0; k < 3; ++k)
      mesh.vertices_in_station_m.emplace_back(
          (middle + test::randomVector(random, size_m)).cast<float>());
    mesh.faces.push_back({{first, first + 1, first + 2}});
    mesh.part_of_face.push_back(0);
  }
  return mesh;
}

TEST(FaceTree, MeetsTheFaceThatTryingAllOfThemFinds) {
  Random random = test::randomFor("FaceTree.MeetsTheFace");
  for (const int count : {1, 2, 5, 37, 3000}) {
    const SceneMesh mesh = randomTriangles(random, count);
    const FaceTree tree(mesh.view());
    Camera camera = test::makePinhole(200, 200, 100.0);
    int hits = 0;
    for (int i = 0; i < 1500; ++i) {
      const Pose camera_from_station = test::randomPose(random, 2.0);
      const Eigen::Vector2d pixel(random.uniform(0.0, 200.0), random.uniform(0.0, 200.0));
      const auto expected = surfacePointAt(camera, mesh.view(), camera_from_station, pixel);
      Eigen::Vector3d ray;
      ASSERT_TRUE(unproject(camera, pixel, ray));
      const Pose back = camera_from_station.inverse();
      const Eigen::Vector3d direction = back.rotation * ray;
      const auto hit = tree.firstHit(back.translation_m, direction);
      ASSERT_EQ(hit.has_value(), expected.has_value());
      if (!hit) continue;
      ++hits;
      EXPECT_EQ(hit->face, expected->face);
      EXPECT_NEAR(hit->distance, expected->depth_m, 1e-9);
      EXPECT_FALSE(tree.firstHit(back.translation_m, direction, 0.999 * hit->distance));
    }
    EXPECT_GT(hits, count == 3000 ? 100 : -1);
    EXPECT_FALSE(tree.firstHit({0.5, 1.0, -3.0}, {0.0, 0.0, -1.0})) << "behind the eye";
    EXPECT_FALSE(tree.firstHit({0.5, 1.0, 3.0}, {0.0, 0.0, 1.0})) << "behind the eye";
  }
}

TEST(SurfacePointAt, PartFixedToTheCamera_HidesTheStation) {
  SceneMesh mesh;  // a wall of the station at z = 0, and a plate 0.2 m ahead of the camera
  mesh.parts.resize(2);
  mesh.parts[1].match = false;
  mesh.parts[1].fixed_to_camera = true;
  for (const auto& [x, y] : {std::pair(-3.0F, -3.0F), {3.0F, -3.0F}, {0.0F, 3.0F}})
    mesh.vertices_in_station_m.emplace_back(x, y, 0.0F);
  for (const auto& [x, y] : {std::pair(0.0F, -0.1F), {0.2F, -0.1F}, {0.0F, 0.1F}})
    mesh.vertices_in_station_m.emplace_back(x, y, 0.2F);
  mesh.faces = {{{0, 1, 2}}, {{3, 4, 5}}};
  mesh.part_of_face = {0, 1};
  const Camera camera = test::makePinhole(200, 200, 100.0);
  for (const double distance_m : {0.5, 0.9, 0.1}) {
    const Pose pose{Eigen::Quaterniond::Identity(), {0.1, 0.0, distance_m}};
    const bool hidden = distance_m > 0.2;
    EXPECT_EQ(surfacePointAt(camera, mesh.view(), pose, {110.0, 99.5}).has_value(), !hidden);
    const auto visible = surfacePointAt(camera, mesh.view(), pose, {90.0, 99.5});
    ASSERT_TRUE(visible);
    EXPECT_EQ(visible->face, 0);
    EXPECT_NEAR(visible->depth_m, distance_m, 1e-12);
  }
  // A tree in the station frame has the station's faces only.
  const auto hit = FaceTree(mesh.view()).firstHit({0.05, 0.0, 0.5}, {0.0, 0.0, -1.0});
  ASSERT_TRUE(hit);
  EXPECT_EQ(hit->face, 0);
}

TEST(FaceTree, LetsNoRaySlipBetweenNeighbours) {
  SceneMesh mesh;  // a square of four triangles about its middle, as a wall at z = 0.3
  mesh.parts.resize(1);
  mesh.part_of_face.assign(4, 0);
  for (const auto& [x, y] : {std::pair(-1.0F, -1.1F), {1.3F, -0.9F}, {1.0F, 1.0F}, {-0.7F, 1.2F}})
    mesh.vertices_in_station_m.emplace_back(x, y, 0.3F);
  mesh.vertices_in_station_m.emplace_back(0.1F, 0.07F, 0.3F);
  for (std::int32_t i = 0; i < 4; ++i) mesh.faces.push_back({{i, (i + 1) % 4, 4}});
  const FaceTree tree(mesh.view());
  Random random = test::randomFor("FaceTree.LetsNoRaySlip");
  const Eigen::Vector3d middle = mesh.vertices_in_station_m[4].cast<double>();
  for (int i = 0; i < 2000; ++i) {
    const Eigen::Vector3d corner =
        mesh.vertices_in_station_m[static_cast<std::size_t>(i % 4)].cast<double>();
    const Eigen::Vector3d on_edge = middle + random.uniform(0.0, 0.99) * (corner - middle);
    const Eigen::Vector3d eye =
        test::randomVector(random, 0.5) + Eigen::Vector3d(0.0, 0.0, i % 2 == 0 ? -1.0 : 1.5);
    EXPECT_TRUE(tree.firstHit(eye, 2.0 * (on_edge - eye)));
  }
}

}  // namespace
}  // namespace boresight::sessions
