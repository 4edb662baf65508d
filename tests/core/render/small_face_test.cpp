// SPDX-License-Identifier: Apache-2.0
// Faces of the size of a pixel are drawn from few bits; every bit of the result must equal that of
// the plain method.
#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <vector>

#include <gtest/gtest.h>

#include "core/render/face_bins.h"
#include "tests/core/render/scenes.h"

namespace boresight::testing {
namespace {

void expectLikePlain(const SceneMesh& mesh, const Camera& camera, const Pose& pose,
                     int least_edges) {
  RenderOptions options;
  options.max_edge_pixels = 300000;
  for (const int rows : {3, 16}) {
    const Rendered plain = render(mesh, camera, pose, options, rows, true);
    const Rendered fast = render(mesh, camera, pose, options, rows, false);
    EXPECT_GE(plain.edges.pixel_count, least_edges);
    EXPECT_EQ(plain.face, fast.face);
    EXPECT_EQ(plain.depth_m, fast.depth_m);
    expectEqual(plain.edges, fast.edges);
  }
}

std::vector<Camera> cameras() {
  return {pinholeCamera(201, 149, 220.0), brownCamera(201, 149, 200.0, -0.25),
          fisheyeCamera(160, 120, 90.0), pinholeCamera(1400, 30, 220.0)};
}

TEST(SmallFaces, BallsOfAnyTessellation_EqualThePlainRender) {
  for (const int n : {12, 40, 90, 200}) {
    SceneMesh mesh;
    mesh.addBall({0, 0, 0}, 0.08, n, n, n < 100 ? 0.02 : 0.002);
    for (const Camera& camera : cameras()) expectLikePlain(mesh, camera, kAhead, 10);
  }
  SceneMesh small;
  small.addBall({0, 0, 0}, 0.04, 150, 150, 0.002, 5);
  for (const Camera& camera :
       {skewMirroredCamera(301, 149, 1600.0), pupilCamera(301, 149, 1600.0, 0.01)})
    expectLikePlain(small, camera, kAhead, 10);
}

/// Which side of a face is seen, from its few bits as from its plane, in images turned over, too.
TEST(SmallFaces, KnowWhichSideIsSeen) {
  for (const Camera& camera :
       {pinholeCamera(1024, 900, 1100.0), brownCamera(1024, 900, 1100.0, -0.2),
        skewMirroredCamera(1024, 900, 1600.0), pupilCamera(1024, 900, 1600.0, 0.01)}) {
    SceneMesh mesh;
    mesh.addBall({0, 0, 0}, 0.08, 120, 120, 0.002, 4);
    Rendered rendered(mesh, camera);
    Arena& arena = rendered.arena;
    const RayGrid& rays = rendered.rays;
    CameraScene scene;
    ASSERT_EQ(CameraScene::create(mesh.view(), rendered.adjacency, arena, arena, scene),
              Status::kOk);
    FaceBins bins = FaceBins::create(mesh.faces.size(), camera.height, 1, arena);
    ASSERT_FALSE(arena.exhausted());
    scene.begin(kAhead, rays);
    scene.transform(rays, 0, mesh.vertices.size());
    for (std::size_t face = 0; face < mesh.faces.size(); ++face)
      scene.orient(static_cast<std::int32_t>(face));
    const std::vector<std::uint8_t> expected(scene.face_flags.begin(), scene.face_flags.end());
    bins.begin(scene, rays, 16, false, 1);
    EXPECT_TRUE(bins.smallFaces().possible());
    bins.add(scene, rays, 0, mesh.faces.size(), 0);
    EXPECT_TRUE(std::ranges::equal(scene.face_flags, expected));
  }
}

/// Surfaces that pass through each other everywhere, some turned inside out, some twice the same.
TEST(SmallFaces, TangledSurfaces_EqualThePlainRender) {
  Random random(2);
  SceneMesh mesh;
  mesh.parts.resize(3);
  mesh.parts[1].normal_threshold_rad = 0.05;
  mesh.parts[1].depth_threshold_m = 1e-4;
  mesh.parts[2].match = false;
  for (int i = 0; i < 6; ++i)
    mesh.addBall(
        {random.uniform(-0.05, 0.05), random.uniform(-0.05, 0.05), random.uniform(-0.05, 0.05)},
        0.06, 60, 60, 0.01, static_cast<std::uint64_t>(i), i % 3);
  const std::size_t once = mesh.faces.size();
  for (std::size_t i = 0; i < once; ++i)
    if (i % 5 == 0)
      mesh.addFace(mesh.faces[i].vertex[0], mesh.faces[i].vertex[2], mesh.faces[i].vertex[1],
                   static_cast<int>(i % 3));
  mesh.addBox({0, 0, 0.05}, {0.1, 0.001, 0.1}, Pose());
  for (const Camera& camera : cameras())
    expectLikePlain(mesh, camera, poseOf({0.3, -0.2, 0.1}, {0.0, 0.01, 0.4}), 100);
}

/// Faces outside the image, behind the camera, across the near plane, and very far away.
TEST(SmallFaces, PartlySeenSurfaces_EqualThePlainRender) {
  SceneMesh mesh;
  mesh.addBall({0, 0, 0}, 0.3, 120, 120, 0.003);
  for (const Camera& camera : cameras())
    for (const Eigen::Vector3d& t :
         {Eigen::Vector3d(0.2, 0.1, 0.35), Eigen::Vector3d(0, 0, 0), Eigen::Vector3d(0, 0.05, 0.3),
          Eigen::Vector3d(-0.4, 0, 0.3), Eigen::Vector3d(0, 0, 1e3), Eigen::Vector3d(0, 0, 1e200)})
      expectLikePlain(mesh, camera, poseOf({0.1, 0.2, 0.0}, t), 0);
}

/// A flat sheet seen nearly edge-on, and exactly so: depths and coverage are decided by rounding.
TEST(SmallFaces, GrazingSheets_EqualThePlainRender) {
  SceneMesh mesh;
  constexpr int kSide = 60;
  for (int layer = 0; layer < 3; ++layer) {
    for (int j = 0; j <= kSide; ++j)
      for (int i = 0; i <= kSide; ++i)
        mesh.addVertex({0.002 * (i - kSide / 2), 0.0001 * layer, 0.002 * (j - kSide / 2)});
    mesh.addGridFaces(layer * (kSide + 1) * (kSide + 1), kSide, kSide);
  }
  for (const Camera& camera : cameras())
    for (const double tilt : {0.0, 1e-9, 1e-4, 0.01, 0.1})
      expectLikePlain(mesh, camera, poseOf({tilt, 0.3, 0.0}, {0.0, 0.001, 0.3}), 0);
}

}  // namespace
}  // namespace boresight::testing
