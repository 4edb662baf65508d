// SPDX-License-Identifier: Apache-2.0
#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <span>
#include <vector>

#include <gtest/gtest.h>

#include "tests/core/render/scenes.h"

namespace boresight::testing {
namespace {

SceneMesh cluttered(std::uint64_t seed) {
  Random random(seed);
  SceneMesh mesh;
  for (int i = 0; i < 8; ++i)
    mesh.addBox({0, 0, 0}, {random.uniform(0.01, 0.1), random.uniform(0.01, 0.1), 0.05},
                poseOf(Eigen::Vector3d(random.normal(), random.normal(), random.normal()),
                       Eigen::Vector3d(random.uniform(-0.2, 0.2), random.uniform(-0.2, 0.2),
                                       random.uniform(0.0, 0.4))),
                i % 3);
  mesh.addCylinder({0.05, 0, 0}, 0.06, 0.1, 64, true, 1);
  mesh.parts.resize(3);
  mesh.parts[2].match = false;
  return mesh;
}

const Pose kAhead = poseOf(Eigen::Vector3d(0.1, 0.2, 0.3), Eigen::Vector3d(0.01, 0.0, 0.5));

TEST(EdgeRenderer, HeightOfBands_DoesNotChangeTheRender) {
  const SceneMesh mesh = cluttered(3);
  for (const Camera& camera :
       {pinholeCamera(201, 149, 220.0), brownCamera(201, 149, 200.0, -0.25)}) {
    const Rendered whole = render(mesh, camera, kAhead, {}, 1000);
    ASSERT_GT(whole.edges.pixel_count, 300);
    for (const int rows : {1, 2, 7, 16, 148, 149}) {
      const Rendered banded = render(mesh, camera, kAhead, {}, rows);
      expectEqual(whole.edges, banded.edges);
      EXPECT_EQ(whole.face, banded.face);
      EXPECT_EQ(whole.depth_m, banded.depth_m);
    }
  }
}

TEST(EdgeRenderer, RecordsAreInRasterOrderAndConsistent) {
  const Rendered rendered = render(cluttered(4), brownCamera(300, 200, 300.0, -0.2), kAhead);
  const EdgeRender& edges = rendered.edges;
  std::int32_t index = 0;
  for (int y = 0; y < edges.camera.height; ++y) {
    EXPECT_EQ(edges.row_begin[static_cast<std::size_t>(y)], index);
    for (int x = 0; x < edges.camera.width; ++x) {
      const std::int32_t found = findEdgePixel(edges, x, y);
      EXPECT_EQ(found, edges.edges.get(x, y) ? index : -1);
      if (found < 0) continue;
      const EdgePixel& pixel = edges.pixel(index++);
      EXPECT_EQ(pixel.x, x);
      EXPECT_EQ(pixel.y, y);
      EXPECT_TRUE(edges.mask.get(x, y));
      EXPECT_TRUE(std::isfinite(pixel.depth_m) && pixel.depth_m > 0.0F);
      EXPECT_NE(pixel.kind, 0);
      EXPECT_NEAR(std::hypot(pixel.normal_x, pixel.normal_y), 127.0, 1.0);
      Eigen::Vector3d point;
      EXPECT_TRUE(edgePointInStation(edges, pixel, point));
      Eigen::Vector2d back;
      EXPECT_TRUE(project(edges.camera, edges.camera_from_station * point, back));
      EXPECT_LT((back - Eigen::Vector2d(x, y)).norm(), 1e-5);
    }
  }
  EXPECT_EQ(index, edges.pixel_count);
  EXPECT_EQ(findEdgePixel(edges, -1, 0), -1);
  EXPECT_EQ(findEdgePixel(edges, 0, edges.camera.height), -1);
}

/// Properties of every render, for any scene.
void expectRulesKept(const Rendered& rendered, const SceneMesh& mesh) {
  const EdgeRender& edges = rendered.edges;
  const int width = edges.camera.width;
  std::int32_t set = 0;
  for (int y = 0; y < edges.camera.height; ++y)
    for (int x = 0; x < width; ++x) {
      set += edges.edges.get(x, y) ? 1 : 0;
      const std::int32_t face = rendered.faceAt(x, y);
      const bool matched =
          face >= 0 && mesh.parts[mesh.part_of_face[static_cast<std::size_t>(face)]].match;
      EXPECT_EQ(edges.mask.get(x, y), matched || edges.edges.get(x, y));
    }
  EXPECT_EQ(set, edges.pixel_count);
  // Bits beyond the image are zero.
  for (int y = 0; y < edges.camera.height && width % 64 != 0; ++y) {
    EXPECT_EQ(edges.edges.row(y)[width / 64] >> (width % 64), 0U);
    EXPECT_EQ(edges.mask.row(y)[width / 64] >> (width % 64), 0U);
  }
  for (const EdgePixel& pixel : pixelsOf(edges)) {
    EXPECT_TRUE(std::isfinite(pixel.depth_m) && pixel.depth_m > 0.0F);
    ASSERT_TRUE(pixel.face >= 0 && pixel.face < static_cast<std::int32_t>(mesh.faces.size()));
    EXPECT_TRUE(mesh.parts[mesh.part_of_face[static_cast<std::size_t>(pixel.face)]].match);
    EXPECT_NEAR(std::hypot(pixel.normal_x, pixel.normal_y), 127.0, 1.0);
    Eigen::Vector2d position;
    Eigen::Vector3d point;
    EXPECT_TRUE(edgePointInStation(edges, pixel, point) && point.allFinite());
    EXPECT_TRUE(edgeLinePoint(edges, mesh.view(), pixel, position, point) && point.allFinite());
  }
}

TEST(EdgeRenderer, RulesAreKeptOnAnySceneAndAnySize) {
  Random random(12);
  const int sizes[][2] = {{1, 1},   {1, 40},  {40, 1},  {2, 2},
                          {16, 16}, {17, 33}, {64, 15}, {129, 65}};
  for (const auto& size : sizes) {
    for (int kind = 0; kind < 3; ++kind) {
      const double focal_px = 0.8 * std::max(size[0], size[1]) + 3.0;
      Camera camera = kind == 0   ? pinholeCamera(size[0], size[1], focal_px)
                      : kind == 1 ? brownCamera(size[0], size[1], focal_px, -0.3)
                                  : fisheyeCamera(size[0], size[1], 0.5 * focal_px);
      SceneMesh mesh = cluttered(static_cast<std::uint64_t>(kind) + 20);
      for (int i = 0; i < 40; ++i) {
        Eigen::Vector3d corner[3];
        for (auto& c : corner)
          c = Eigen::Vector3d(random.normal(), random.normal(), 0.5 * random.normal());
        mesh.addFace(mesh.addVertex(corner[0]), mesh.addVertex(corner[1]),
                     mesh.addVertex(corner[2]), i % 3);
      }
      expectRulesKept(render(mesh, camera, kAhead), mesh);
    }
  }
}

TEST(EdgeRenderer, OrderOfFacesDoesNotMatter) {
  const SceneMesh mesh = cluttered(5);
  SceneMesh reversed = mesh;
  std::reverse(reversed.faces.begin(), reversed.faces.end());
  std::reverse(reversed.part_of_face.begin(), reversed.part_of_face.end());
  const Camera camera = pinholeCamera(200, 150, 220.0);
  const Rendered a = render(mesh, camera, kAhead);
  const Rendered b = render(reversed, camera, kAhead);
  const auto faces = static_cast<std::int32_t>(mesh.faces.size());
  int different = 0;
  for (std::size_t i = 0; i < a.face.size(); ++i)
    different += (a.face[i] < 0 ? -1 : faces - 1 - a.face[i]) == b.face[i] ? 0 : 1;
  EXPECT_EQ(different, 0);
  EXPECT_EQ(a.edges.pixel_count, b.edges.pixel_count);
}

struct Bench {
  SceneMesh mesh = cluttered(6);
  Camera camera = brownCamera(200, 150, 200.0, -0.2);
  std::vector<std::byte> memory = std::vector<std::byte>(std::size_t{24} << 20);
  Arena arena{memory};
  MeshAdjacency adjacency;
  RayGrid rays;
  RenderOptions options;
  Bench() {
    EXPECT_EQ(buildAdjacency(mesh.view(), arena, adjacency), Status::kOk);
    EXPECT_EQ(RayGrid::create(camera, arena, rays), Status::kOk);
  }
};

TEST(EdgeRenderer, CapacityExceeded_IsReported) {
  Bench bench;
  bench.options.max_edge_pixels = 1000;
  bench.camera = brownCamera(800, 600, 800.0, -0.2);
  ASSERT_EQ(RayGrid::create(bench.camera, bench.arena, bench.rays), Status::kOk);
  EdgeRender output = createEdgeRender(800, 600, bench.options, bench.arena);
  EdgeRenderer renderer;
  ASSERT_EQ(
      renderer.create(bench.mesh.view(), bench.adjacency, 800, 600, bench.options, bench.arena),
      Status::kOk);
  ASSERT_EQ(renderer.begin(bench.rays, kAhead, output), Status::kOk);
  bool done = false;
  Status status = Status::kOk;
  for (int i = 0; i < 1000 && !done; ++i) status = renderer.step(done);
  EXPECT_EQ(status, Status::kCapacityExceeded);
  EXPECT_TRUE(done);
  EXPECT_EQ(output.pixel_count, 1000);
}

/// Faces one behind the other that all cover the whole image; a sliver each when `slivers`.
SceneMesh layers(int count, bool slivers = false) {
  SceneMesh mesh;
  for (int i = 0; i < count; ++i) {
    const double z = 1.0 + 1e-3 * i;
    const Eigen::Vector3d corner = slivers ? Eigen::Vector3d(-20.0001, -20.0, z)  // on a diagonal
                                           : Eigen::Vector3d(20.0, -20.0, z);
    mesh.addFace(mesh.addVertex(corner), mesh.addVertex({20.0, 20.0, z}),
                 mesh.addVertex({-20.0, slivers ? -20.0 : 0.0, z}));
  }
  return mesh;
}

/// Steps until the render is done.
Status stepsOf(EdgeRenderer& renderer, int& steps) {
  Status status = Status::kOk;
  bool done = false;
  for (steps = 0; !done; ++steps) status = renderer.step(done);
  return status;
}

TEST(EdgeRenderer, RefusesFacesThatCoverTheImageManyHundredTimesOver) {
  struct Expected {
    int faces;
    bool slivers;
    Status status;
  };
  const int most = static_cast<int>(BandPainter::kMostLayers);
  for (const auto& [faces, slivers, expected] :
       {Expected{most / 2, false, Status::kOk}, Expected{2 * most, false, Status::kTooManyLayers},
        Expected{100 * most, false, Status::kTooManyLayers},
        Expected{8 * most, true, Status::kOk}}) {
    const SceneMesh mesh = layers(faces, slivers);
    const Camera camera = pinholeCamera(128, 64, 100.0);
    std::vector<std::byte> memory(std::size_t{64} << 20);
    Arena arena{memory};
    MeshAdjacency adjacency;
    RayGrid rays;
    ASSERT_EQ(buildAdjacency(mesh.view(), arena, adjacency), Status::kOk);
    ASSERT_EQ(RayGrid::create(camera, arena, rays), Status::kOk);
    EdgeRender output = createEdgeRender(128, 64, RenderOptions(), arena);
    EdgeRenderer renderer;
    ASSERT_EQ(renderer.create(mesh.view(), adjacency, 128, 64, {}, arena), Status::kOk);
    ASSERT_EQ(renderer.begin(rays, Pose(), output), Status::kOk);
    int steps = 0;
    EXPECT_EQ(stepsOf(renderer, steps), expected) << faces << " faces";
    EXPECT_LT(steps, 40) << faces << " faces: the first band is enough to know";
  }
}

TEST(EdgeRenderer, UsesExactlyTheCountedBytes) {
  Bench bench;
  Arena counting;
  EdgeRenderer renderer;
  ASSERT_EQ(renderer.create(bench.mesh.view(), MeshAdjacency(), 200, 150, bench.options, counting),
            Status::kOk);
  (void)createEdgeRender(200, 150, bench.options, counting);
  std::vector<std::byte> memory(counting.used());
  Arena exact(memory);
  EXPECT_EQ(renderer.create(bench.mesh.view(), bench.adjacency, 200, 150, bench.options, exact),
            Status::kOk);
  (void)createEdgeRender(200, 150, bench.options, exact);
  EXPECT_FALSE(exact.exhausted());
  EXPECT_EQ(exact.used(), memory.size());
  Arena small(std::span<std::byte>(memory).first(10000));
  EXPECT_EQ(renderer.create(bench.mesh.view(), bench.adjacency, 200, 150, bench.options, small),
            Status::kArenaTooSmall);
}

TEST(EdgeRenderer, MemoryOfALargeSceneWithinTwoAndAHalfMegabytes) {
  SceneMesh mesh;
  mesh.vertices.assign(30000, Eigen::Vector3f::Zero());
  mesh.faces.assign(60000, Face{{0, 1, 2}});
  mesh.part_of_face.assign(60000, 0);
  Arena counting;
  EdgeRenderer renderer;
  ASSERT_EQ(renderer.create(mesh.view(), MeshAdjacency(), 2048, 2048, RenderOptions(), counting),
            Status::kOk);
  EXPECT_LE(counting.used(), 2500000U);
}

TEST(EdgeRenderer, BadInput_GivesAStatus) {
  Bench bench;
  EdgeRender output = createEdgeRender(200, 150, bench.options, bench.arena);
  EdgeRenderer renderer;
  SceneMesh broken = bench.mesh;
  broken.faces[3].vertex[1] = 1 << 20;
  EXPECT_EQ(renderer.create(broken.view(), bench.adjacency, 200, 150, bench.options, bench.arena),
            Status::kInvalidMesh);
  EXPECT_EQ(
      renderer.create(bench.mesh.view(), MeshAdjacency(), 200, 150, bench.options, bench.arena),
      Status::kInvalidMesh);
  RenderOptions bad;
  bad.max_edge_pixels = 0;
  EXPECT_EQ(renderer.create(bench.mesh.view(), bench.adjacency, 200, 150, bad, bench.arena),
            Status::kInvalidOption);
  EXPECT_EQ(renderer.create(bench.mesh.view(), bench.adjacency, 0, 150, bench.options, bench.arena),
            Status::kInvalidImage);
  ASSERT_EQ(
      renderer.create(bench.mesh.view(), bench.adjacency, 100, 150, bench.options, bench.arena),
      Status::kOk);
  EXPECT_EQ(renderer.begin(bench.rays, kAhead, output), Status::kInvalidImage);
  ASSERT_EQ(
      renderer.create(bench.mesh.view(), bench.adjacency, 200, 150, bench.options, bench.arena),
      Status::kOk);
  EdgeRender narrow = createEdgeRender(100, 150, bench.options, bench.arena);
  EXPECT_EQ(renderer.begin(bench.rays, kAhead, narrow), Status::kInvalidImage);
  Pose pose = kAhead;
  pose.translation_m.x() = std::numeric_limits<double>::quiet_NaN();
  EXPECT_EQ(renderer.begin(bench.rays, pose, output), Status::kInvalidPose);
}

/// Poses from which nothing, or nothing sensible, is seen.
TEST(EdgeRenderer, AbsurdPosesRenderNothingOrSomethingFinite) {
  Bench bench;
  for (const Eigen::Vector3d& translation :
       {Eigen::Vector3d(0, 0, -5), Eigen::Vector3d(100, 0, 1), Eigen::Vector3d(1e200, 1e200, 1e200),
        Eigen::Vector3d(1e300, -1e300, 1), Eigen::Vector3d(0, 0, 1e9), Eigen::Vector3d(0, 0, 0)}) {
    const Rendered rendered = render(bench.mesh, bench.camera, poseOf({0, 0, 0}, translation));
    for (std::int32_t i = 0; i < rendered.edges.pixel_count; ++i) {
      const float depth = rendered.edges.pixel(i).depth_m;
      EXPECT_TRUE(std::isfinite(depth) && depth > 0.0F);
    }
  }
}

TEST(EdgeRenderer, LevelsOfOneCameraShareOneRenderer) {
  Bench bench;
  const Camera camera = brownCamera(640, 480, 640.0, -0.2);
  EdgeRender output = createEdgeRender(640, 480, bench.options, bench.arena);
  EdgeRenderer renderer;
  ASSERT_EQ(
      renderer.create(bench.mesh.view(), bench.adjacency, 640, 480, bench.options, bench.arena),
      Status::kOk);
  for (const int level : {2, 0, 1, 3}) {
    RayGrid rays;
    ASSERT_EQ(RayGrid::create(cameraAtLevel(camera, level), bench.arena, rays), Status::kOk);
    ASSERT_EQ(renderer.begin(rays, kAhead, output), Status::kOk);
    bool done = false;
    while (!done) ASSERT_EQ(renderer.step(done), Status::kOk);
    const Rendered alone = render(bench.mesh, cameraAtLevel(camera, level), kAhead);
    EXPECT_EQ(output.edges.words.size(), alone.edges.edges.words.size());
    EXPECT_EQ(output.mask.words.size(), alone.edges.mask.words.size());
    expectEqual(output, alone.edges);
    ASSERT_EQ(renderer.step(done), Status::kOk);
    EXPECT_TRUE(done);
  }
}

/// A million slivers, and a dense scan on few pixels: slices stay short.
TEST(EdgeRenderer, AMillionSliversAreNormalInput) {
  Random random(8);
  SceneMesh mesh;
  for (int i = 0; i < 20000; ++i) {
    const Eigen::Vector3d centre(random.uniform(-0.3, 0.3), random.uniform(-0.3, 0.3),
                                 random.uniform(0.5, 0.9));
    const Eigen::Vector3d along(random.normal(), random.normal(), random.normal());
    mesh.addVertex(centre - 0.01 * along);
    mesh.addVertex(centre + 0.01 * along);
    mesh.addVertex(centre + 0.01 * along +
                   1e-6 * Eigen::Vector3d(random.normal(), random.normal(), 0));
  }
  for (int k = 0; k < 50; ++k)
    for (int i = 0; i < 20000; ++i) mesh.addFace(3 * i, 3 * i + 1, 3 * i + 2);
  std::vector<std::byte> memory(std::size_t{96} << 20);
  Arena arena(memory);
  const MeshAdjacency adjacency = MeshAdjacency::create(mesh.faces.size(), arena);
  const Camera camera = brownCamera(512, 512, 500.0, -0.1);
  RayGrid rays;
  ASSERT_EQ(RayGrid::create(camera, arena, rays), Status::kOk);
  EdgeRender output = createEdgeRender(512, 512, RenderOptions(), arena);
  EdgeRenderer renderer;
  ASSERT_EQ(renderer.create(mesh.view(), adjacency, 512, 512, RenderOptions(), arena), Status::kOk);
  ASSERT_EQ(renderer.begin(rays, Pose(), output), Status::kOk);
  bool done = false;
  while (!done) ASSERT_EQ(renderer.step(done), Status::kOk);
}

}  // namespace
}  // namespace boresight::testing
