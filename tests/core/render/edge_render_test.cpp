// SPDX-License-Identifier: Apache-2.0
#include <algorithm>
#include <cmath>
#include <string>

#include <gtest/gtest.h>

#include "tests/core/render/scenes.h"
#include "tests/support/not_finite.h"

namespace boresight::testing {
namespace {

TEST(EdgeRenderer, HeightOfBands_DoesNotChangeTheRender) {
  const SceneMesh mesh = scattered(3);
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

/// Properties of every render, for any scene.
void expectRulesKept(const SceneMesh& mesh, const Camera& camera) {
  SCOPED_TRACE(std::to_string(camera.width) + " x " + std::to_string(camera.height));
  const Rendered rendered = render(mesh, camera, kAhead);
  const EdgeRender& edges = rendered.edges;
  const auto matched = [&mesh](std::int32_t face) {
    return face >= 0 && mesh.parts[mesh.part_of_face[static_cast<std::size_t>(face)]].match;
  };
  std::int32_t index = 0;
  for (int y = 0; y < camera.height; ++y) {
    EXPECT_EQ(edges.row_begin[static_cast<std::size_t>(y)], index);
    for (int x = 0; x < camera.width; ++x) {
      const bool edge = edges.edges.get(x, y);
      EXPECT_EQ(edges.mask.get(x, y), edge || matched(rendered.faceAt(x, y)));
      EXPECT_EQ(findEdgePixel(edges, x, y), edge ? index : -1);
      if (!edge) continue;
      const EdgePixel& pixel = edges.pixel(index++);
      EXPECT_EQ(pixel.x, x);
      EXPECT_EQ(pixel.y, y);
      EXPECT_TRUE(std::isfinite(pixel.depth_m) && pixel.depth_m > 0.0F);
      EXPECT_TRUE(matched(pixel.face));
      EXPECT_NE(pixel.kind, 0);
      EXPECT_NEAR(std::hypot(pixel.normal_x, pixel.normal_y), 127.0, 1.0);
      Eigen::Vector2d position;
      Eigen::Vector3d point;
      EXPECT_TRUE(edgeLinePoint(edges, mesh.view(), pixel, position, point) && point.allFinite());
      EXPECT_TRUE(edgePointInStation(edges, pixel, point) && point.allFinite());
      EXPECT_TRUE(project(camera, kAhead * point, position));
      EXPECT_LT((position - Eigen::Vector2d(x, y)).norm(), 1e-5);
    }
    // Bits beyond the image are zero.
    if (camera.width % 64 == 0) continue;
    EXPECT_EQ(edges.edges.row(y)[camera.width / 64] >> (camera.width % 64), 0U);
    EXPECT_EQ(edges.mask.row(y)[camera.width / 64] >> (camera.width % 64), 0U);
  }
  EXPECT_EQ(index, edges.pixel_count);
  EXPECT_EQ(findEdgePixel(edges, -1, 0), -1);
  EXPECT_EQ(findEdgePixel(edges, 0, camera.height), -1);
}

TEST(EdgeRenderer, RulesAreKeptOnAnySceneAndAnySize) {
  expectRulesKept(scattered(4), brownCamera(300, 200, 300.0, -0.2));
  Random random(12);
  const int sizes[][2] = {{1, 1},   {1, 40},  {40, 1},  {2, 2},
                          {16, 16}, {17, 33}, {64, 15}, {129, 65}};
  for (const auto& [width, height] : sizes) {
    const double focal_px = 0.8 * std::max(width, height) + 3.0;
    std::uint64_t seed = 20;
    for (const Camera& camera :
         {pinholeCamera(width, height, focal_px), brownCamera(width, height, focal_px, -0.3),
          fisheyeCamera(width, height, 0.5 * focal_px)}) {
      SceneMesh mesh = scattered(seed++);
      for (int i = 0; i < 40; ++i) {
        Eigen::Vector3d corner[3];
        for (auto& c : corner)
          c = Eigen::Vector3d(random.normal(), random.normal(), 0.5 * random.normal());
        mesh.addFace(mesh.addVertex(corner[0]), mesh.addVertex(corner[1]),
                     mesh.addVertex(corner[2]), i % 3);
      }
      expectRulesKept(mesh, camera);
    }
  }
}

TEST(EdgeRenderer, OrderOfFacesDoesNotMatter) {
  const SceneMesh mesh = scattered(5);
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
    Rendered rendered(mesh, pinholeCamera(128, 64, 100.0));
    ASSERT_EQ(rendered.begin(Pose()), Status::kOk);
    EXPECT_EQ(rendered.finish(), expected) << faces << " faces";
    EXPECT_LT(rendered.steps, 40) << faces << " faces: the first band is enough to know";
  }
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
  const SceneMesh mesh = scattered(6);
  SceneMesh broken = mesh;
  broken.faces[3].vertex[1] = 1 << 20;
  RenderOptions bad;
  bad.max_edge_pixels = 0;
  Rendered rendered(mesh, brownCamera(200, 150, 200.0, -0.2));
  const MeshAdjacency& adjacency = rendered.adjacency;
  const auto create = [&](const SceneMesh& drawn, const MeshAdjacency& neighbours, int width,
                          const RenderOptions& options) {
    return rendered.renderer.create(drawn.view(), neighbours, width, 150, options, rendered.arena);
  };
  EXPECT_EQ(create(broken, adjacency, 200, {}), Status::kInvalidMesh);
  EXPECT_EQ(create(mesh, MeshAdjacency(), 200, {}), Status::kInvalidMesh);
  EXPECT_EQ(create(mesh, adjacency, 200, bad), Status::kInvalidOption);
  EXPECT_EQ(create(mesh, adjacency, 0, {}), Status::kInvalidImage);
  ASSERT_EQ(create(mesh, adjacency, 100, {}), Status::kOk);
  EXPECT_EQ(rendered.begin(kAhead), Status::kInvalidImage);
  ASSERT_EQ(create(mesh, adjacency, 200, {}), Status::kOk);
  EdgeRender narrow = createEdgeRender(100, 150, RenderOptions(), rendered.arena);
  EXPECT_EQ(rendered.renderer.begin(rendered.rays, kAhead, narrow), Status::kInvalidImage);
  EXPECT_EQ(rendered.begin({kAhead.rotation, {test::kNan, 0.0, 0.5}}), Status::kInvalidPose);
}

/// Poses from which nothing, or nothing sensible, is seen.
TEST(EdgeRenderer, AbsurdPosesRenderNothingOrSomethingFinite) {
  for (const Eigen::Vector3d& translation :
       {Eigen::Vector3d(0, 0, -5), Eigen::Vector3d(100, 0, 1), Eigen::Vector3d(1e200, 1e200, 1e200),
        Eigen::Vector3d(1e300, -1e300, 1), Eigen::Vector3d(0, 0, 1e9), Eigen::Vector3d(0, 0, 0)}) {
    const Rendered rendered =
        render(scattered(6), brownCamera(200, 150, 200.0, -0.2), poseOf({0, 0, 0}, translation));
    for (const EdgePixel& pixel : pixelsOf(rendered.edges))
      EXPECT_TRUE(std::isfinite(pixel.depth_m) && pixel.depth_m > 0.0F);
  }
}

TEST(EdgeRenderer, LevelsOfOneCameraShareOneRenderer) {
  const SceneMesh mesh = scattered(6);
  const Camera camera = brownCamera(640, 480, 640.0, -0.2);
  Rendered shared(mesh, camera);
  for (const int level : {2, 0, 1, 3}) {
    ASSERT_EQ(RayGrid::create(cameraAtLevel(camera, level), shared.arena, shared.rays),
              Status::kOk);
    ASSERT_EQ(shared.begin(kAhead), Status::kOk);
    ASSERT_EQ(shared.finish(), Status::kOk);
    expectEqual(shared.edges, render(mesh, cameraAtLevel(camera, level), kAhead).edges);
    bool done = false;
    ASSERT_EQ(shared.renderer.step(done), Status::kOk);
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
  render(mesh, brownCamera(512, 512, 500.0, -0.1), Pose());
}

}  // namespace
}  // namespace boresight::testing
