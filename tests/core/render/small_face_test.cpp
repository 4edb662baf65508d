// SPDX-License-Identifier: Apache-2.0
// Faces of the size of a pixel are drawn from few bits; every bit of the result must equal that of
// the plain method.
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <vector>

#include <gtest/gtest.h>

#include "core/render/face_bins.h"
#include "tests/core/render/scenes.h"

namespace boresight::testing {
namespace {

/// A bumpy ball of about 2 n^2 faces, all with outer sides outwards.
void addBall(SceneMesh& mesh, Random& random, const Eigen::Vector3d& centre, double radius, int n,
             double bumps, int part = 0) {
  const auto first = static_cast<std::int32_t>(mesh.vertices.size());
  for (int j = 0; j <= n; ++j)
    for (int i = 0; i < n; ++i) {
      const double polar = M_PI * j / n;
      const double around = 2.0 * M_PI * (i + 0.5 * (j % 2)) / n;
      const double r = radius * (1.0 + bumps * random.normal());
      mesh.addVertex(centre + r * Eigen::Vector3d(std::sin(polar) * std::cos(around),
                                                  std::cos(polar),
                                                  std::sin(polar) * std::sin(around)));
    }
  for (int j = 0; j < n; ++j)
    for (int i = 0; i < n; ++i) {
      const std::int32_t a = first + j * n + i;
      const std::int32_t b = first + j * n + (i + 1) % n;
      mesh.addFace(a, b, a + n, part);
      mesh.addFace(b, b + n, a + n, part);
    }
}

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
  Random random(1);
  for (const int n : {12, 40, 90, 200}) {
    SceneMesh mesh;
    addBall(mesh, random, {0, 0, 0}, 0.08, n, n < 100 ? 0.02 : 0.002);
    for (const Camera& camera : cameras())
      expectLikePlain(mesh, camera, poseOf({0.1, 0.2, 0.3}, {0.01, 0.0, 0.5}), 10);
  }
}

/// Which side of a face is seen, from its few bits as from its plane, in images turned over, too.
TEST(SmallFaces, KnowWhichSideIsSeen) {
  for (const Camera& camera :
       {pinholeCamera(1024, 900, 1100.0), brownCamera(1024, 900, 1100.0, -0.2),
        skewMirroredCamera(1024, 900, 1600.0), pupilCamera(1024, 900, 1600.0, 0.01)}) {
    Random random(4);
    SceneMesh mesh;
    addBall(mesh, random, {0, 0, 0}, 0.08, 120, 0.002);
    std::vector<std::byte> memory(std::size_t{16} << 20);
    Arena arena(memory);
    MeshAdjacency adjacency;
    RayGrid rays;
    CameraScene scene;
    ASSERT_EQ(buildAdjacency(mesh.view(), arena, adjacency), Status::kOk);
    ASSERT_EQ(RayGrid::create(camera, arena, rays), Status::kOk);
    ASSERT_EQ(CameraScene::create(mesh.view(), adjacency, arena, arena, scene), Status::kOk);
    FaceBins bins = FaceBins::create(mesh.faces.size(), camera.height, 1, arena);
    ASSERT_FALSE(arena.exhausted());
    const Pose pose = poseOf({0.1, 0.2, 0.3}, {0.01, 0.0, 0.5});
    scene.begin(pose, rays);
    scene.transform(rays, 0, mesh.vertices.size());
    for (std::size_t face = 0; face < mesh.faces.size(); ++face)
      scene.orient(static_cast<std::int32_t>(face));
    const std::vector<std::uint8_t> expected(scene.face_flags.begin(), scene.face_flags.end());
    bins.begin(scene, rays, 16, false, 1);
    EXPECT_TRUE(bins.smallFaces().possible());
    bins.add(scene, rays, 0, mesh.faces.size(), 0);
    const std::vector<std::uint8_t> found(scene.face_flags.begin(), scene.face_flags.end());
    EXPECT_EQ(found, expected);
  }
}

TEST(SmallFaces, PlanetaryCameras_EqualThePlainRender) {
  for (const Camera& camera :
       {skewMirroredCamera(301, 149, 1600.0), pupilCamera(301, 149, 1600.0, 0.01)}) {
    Random random(5);
    SceneMesh mesh;
    addBall(mesh, random, {0, 0, 0}, 0.04, 150, 0.002);
    expectLikePlain(mesh, camera, poseOf({0.1, 0.2, 0.3}, {0.01, 0.0, 0.5}), 10);
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
    addBall(mesh, random,
            {random.uniform(-0.05, 0.05), random.uniform(-0.05, 0.05), random.uniform(-0.05, 0.05)},
            0.06, 60, 0.01, i % 3);
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
  Random random(3);
  SceneMesh mesh;
  addBall(mesh, random, {0, 0, 0}, 0.3, 120, 0.003);
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
  for (int layer = 0; layer < 3; ++layer)
    for (int j = 0; j <= kSide; ++j)
      for (int i = 0; i <= kSide; ++i)
        mesh.addVertex({0.002 * (i - kSide / 2), 0.0001 * layer, 0.002 * (j - kSide / 2)});
  for (int layer = 0; layer < 3; ++layer)
    for (int j = 0; j < kSide; ++j)
      for (int i = 0; i < kSide; ++i) {
        const int a = (layer * (kSide + 1) + j) * (kSide + 1) + i;
        mesh.addFace(a, a + 1, a + kSide + 1);
        mesh.addFace(a + 1, a + kSide + 2, a + kSide + 1);
      }
  for (const Camera& camera : cameras())
    for (const double tilt : {0.0, 1e-9, 1e-4, 0.01, 0.1})
      expectLikePlain(mesh, camera, poseOf({tilt, 0.3, 0.0}, {0.0, 0.001, 0.3}), 0);
}

}  // namespace
}  // namespace boresight::testing
