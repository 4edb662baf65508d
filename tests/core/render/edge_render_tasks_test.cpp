// SPDX-License-Identifier: Apache-2.0
// Renders by several workers have the same bits as by one, for any assignment of tasks.
#include <algorithm>
#include <numeric>
#include <thread>
#include <vector>

#include <gtest/gtest.h>

#include "tests/core/render/scenes.h"

namespace boresight::testing {
namespace {

/// Boxes, some of them not matched, and a fine cylinder; `facets` makes the mesh large.
SceneMesh scattered(std::uint64_t seed, int facets) {
  Random random(seed);
  SceneMesh mesh;
  for (int i = 0; i < 9; ++i)
    mesh.addBox({0, 0, 0}, {random.uniform(0.01, 0.1), random.uniform(0.01, 0.1), 0.05},
                poseOf(Eigen::Vector3d(random.normal(), random.normal(), random.normal()),
                       Eigen::Vector3d(random.uniform(-0.25, 0.25), random.uniform(-0.2, 0.2),
                                       random.uniform(0.0, 0.4))),
                i % 3);
  mesh.addCylinder({0.05, 0, 0}, 0.06, 0.1, facets, true, 1);
  mesh.parts.resize(3);
  mesh.parts[2].match = false;
  return mesh;
}

/// A renderer for some workers with all that it needs.
struct Shared {
  const SceneMesh& mesh;
  Camera camera;
  std::vector<std::byte> memory = std::vector<std::byte>(std::size_t{32} << 20);
  Arena arena{memory};
  MeshAdjacency adjacency;
  RayGrid rays;
  EdgeRender output;
  EdgeRenderer renderer;
  std::vector<float> depth_m;
  std::vector<std::int32_t> face;

  Shared(const SceneMesh& drawn, const Camera& seen_by, const RenderOptions& options, int workers,
         int band_rows = EdgeRenderer::kBandRows)
      : mesh(drawn), camera(seen_by) {
    EXPECT_EQ(buildAdjacency(mesh.view(), arena, adjacency), Status::kOk);
    EXPECT_EQ(RayGrid::create(camera, arena, rays), Status::kOk);
    output = createEdgeRender(camera.width, camera.height, options, arena);
    EXPECT_EQ(renderer.create(mesh.view(), adjacency, camera.width, camera.height, options, arena,
                              band_rows, workers),
              Status::kOk);
    const auto pixels =
        static_cast<std::size_t>(camera.width) * static_cast<std::size_t>(camera.height);
    depth_m.assign(pixels, -1.0F);
    face.assign(pixels, -7);
  }
  Status begin(const Pose& camera_from_station, bool surfaces = true) {
    if (surfaces) return renderer.begin(rays, camera_from_station, output, {depth_m, face, {}, {}});
    return renderer.begin(rays, camera_from_station, output);
  }
};

/// Tasks in any order, each by any worker; `most` is the largest number of tasks seen.
Status finishShuffled(Shared& shared, int workers, Random& random, int& most) {
  Status status = Status::kOk;
  bool done = false;
  while (!done && status == Status::kOk) {
    std::vector<int> order(static_cast<std::size_t>(shared.renderer.tasks()));
    std::iota(order.begin(), order.end(), 0);
    most = std::max(most, static_cast<int>(order.size()));
    for (std::size_t i = order.size(); i > 1; --i)
      std::swap(order[i - 1], order[random.below(static_cast<std::uint32_t>(i))]);
    for (const int task : order)
      shared.renderer.runTask(task,
                              static_cast<int>(random.below(static_cast<std::uint32_t>(workers))));
    status = shared.renderer.step(done);
  }
  EXPECT_TRUE(done);
  return status;
}

void expectSameWords(const EdgeRender& a, const EdgeRender& b) {
  EXPECT_TRUE(std::ranges::equal(a.edges.words, b.edges.words));
  EXPECT_TRUE(std::ranges::equal(a.mask.words, b.mask.words));
  const auto rows = static_cast<std::size_t>(a.camera.height) + 1;
  EXPECT_TRUE(std::ranges::equal(a.row_begin.first(rows), b.row_begin.first(rows)));
}

TEST(EdgeRendererTasks, SharedTasks_GiveTheBitsOfOneWorker) {
  Random random(7);
  const Pose ahead = poseOf({0.1, 0.2, 0.3}, {0.01, 0.0, 0.5});
  const Pose inside = poseOf({0.4, -0.2, 1.3}, {0.0, 0.03, 0.05});
  for (const int facets : {32, 1200}) {
    const SceneMesh mesh = scattered(static_cast<std::uint64_t>(facets), facets);
    for (const Camera& camera : {pinholeCamera(201, 149, 200.0), brownCamera(150, 161, 160.0, -0.2),
                                 fisheyeCamera(130, 99, 70.0)}) {
      for (const Pose& pose : {ahead, inside}) {
        const Rendered alone = render(mesh, camera, pose);
        for (const int workers : {2, 8}) {
          Shared shared(mesh, camera, {}, workers);
          for (const bool surfaces : {true, false}) {
            int most = 0;
            ASSERT_EQ(shared.begin(pose, surfaces), Status::kOk);
            ASSERT_EQ(finishShuffled(shared, workers, random, most), Status::kOk);
            EXPECT_GT(most, 1);
            expectEqual(alone.edges, shared.output);
            expectSameWords(alone.edges, shared.output);
          }
          EXPECT_EQ(alone.face, shared.face);
          EXPECT_EQ(alone.depth_m, shared.depth_m);
        }
      }
    }
  }
}

TEST(EdgeRendererTasks, AnyDivision_GivesTheSameBits) {
  Random random(9);
  const SceneMesh mesh = scattered(5, 64);
  const Camera camera = brownCamera(201, 149, 200.0, -0.25);
  const Pose pose = poseOf({0.1, 0.2, 0.3}, {0.01, 0.0, 0.5});
  const Rendered alone = render(mesh, camera, pose);
  ASSERT_GT(alone.edges.pixel_count, 300);
  for (const int band_rows : {1, 2, 3, 5, 37, 148, 149}) {
    Shared shared(mesh, camera, {}, 16, band_rows);
    int most = 0;
    ASSERT_EQ(shared.begin(pose), Status::kOk);
    ASSERT_EQ(finishShuffled(shared, 16, random, most), Status::kOk);
    EXPECT_EQ(most > 2, band_rows > 1 && band_rows < 37) << band_rows;
    expectEqual(alone.edges, shared.output);
    expectSameWords(alone.edges, shared.output);
  }
}

TEST(EdgeRendererTasks, ParallelThreads_GiveTheSameBits) {
  constexpr int kWorkers = 4;
  const SceneMesh mesh = scattered(8, 1500);
  const Camera camera = pinholeCamera(240, 200, 240.0);
  const Pose pose = poseOf({0.1, 0.2, 0.3}, {0.01, 0.0, 0.5});
  const Rendered alone = render(mesh, camera, pose);
  Shared shared(mesh, camera, {}, kWorkers);
  ASSERT_EQ(shared.begin(pose, false), Status::kOk);
  bool done = false;
  while (!done) {
    {
      std::vector<std::jthread> threads;
      for (int worker = 0; worker < kWorkers; ++worker)
        threads.emplace_back([&shared, worker, tasks = shared.renderer.tasks()] {
          for (int task = worker; task < tasks; task += kWorkers)
            shared.renderer.runTask(task, worker);
        });
    }
    ASSERT_EQ(shared.renderer.step(done), Status::kOk);
  }
  expectEqual(alone.edges, shared.output);
  expectSameWords(alone.edges, shared.output);
}

/// An exceeded capacity ends as with one worker, for any division into tasks.
TEST(EdgeRendererTasks, CapacityExceeded_LeavesTheOutputOfOneWorker) {
  Random random(11);
  RenderOptions options;
  options.max_edge_pixels = 1000;
  const SceneMesh mesh = scattered(6, 64);
  const Camera camera = brownCamera(800, 600, 800.0, -0.2);
  const Pose pose = poseOf({0.1, 0.2, 0.3}, {0.01, 0.0, 0.5});
  Shared alone(mesh, camera, options, 1);
  int most = 0;
  ASSERT_EQ(alone.begin(pose, false), Status::kOk);
  ASSERT_EQ(finishShuffled(alone, 1, random, most), Status::kCapacityExceeded);
  EXPECT_EQ(most, 0);
  for (const int workers : {2, 3, 8}) {
    Shared shared(mesh, camera, options, workers);
    ASSERT_EQ(shared.begin(pose, false), Status::kOk);
    EXPECT_EQ(finishShuffled(shared, workers, random, most), Status::kCapacityExceeded);
    EXPECT_EQ(shared.output.pixel_count, 1000);
    expectEqual(alone.output, shared.output);
    EXPECT_TRUE(std::ranges::equal(alone.output.edges.words, shared.output.edges.words));
    EXPECT_TRUE(std::ranges::equal(alone.output.mask.words, shared.output.mask.words));
  }
}

TEST(EdgeRendererTasks, TooManyLayers_AreRefusedAsByOneWorker) {
  Random random(12);
  SceneMesh mesh = scattered(6, 64);
  // The lower half of the image is covered again and again.
  for (int i = 0; i < 2 * BandPainter::kMostLayers; ++i)
    mesh.addFace(mesh.addVertex({-20.0, 0.05, 1.0 + 1e-3 * i}),
                 mesh.addVertex({20.0, 0.05, 1.0 + 1e-3 * i}),
                 mesh.addVertex({0.0, 40.0, 1.0 + 1e-3 * i}));
  const Camera camera = brownCamera(320, 240, 320.0, -0.2);
  const Pose pose = poseOf({0.0, 0.0, 0.0}, {0.01, 0.0, 0.5});
  Shared alone(mesh, camera, {}, 1);
  int most = 0;
  ASSERT_EQ(alone.begin(pose, false), Status::kOk);
  ASSERT_EQ(finishShuffled(alone, 1, random, most), Status::kTooManyLayers);
  EXPECT_GT(alone.output.pixel_count, 0) << "the rows before are there";
  for (const int workers : {2, 3, 8}) {
    Shared shared(mesh, camera, {}, workers);
    ASSERT_EQ(shared.begin(pose, false), Status::kOk);
    EXPECT_EQ(finishShuffled(shared, workers, random, most), Status::kTooManyLayers);
    EXPECT_EQ(shared.output.pixel_count, alone.output.pixel_count);
    EXPECT_TRUE(std::ranges::equal(alone.output.edges.words, shared.output.edges.words));
  }
}

TEST(EdgeRendererTasks, SceneOutsideTheImage_GivesNoEdges) {
  Random random(13);
  const SceneMesh mesh = scattered(6, 64);
  const Camera camera = pinholeCamera(100, 90, 100.0);
  Shared shared(mesh, camera, {}, 3);
  int most = 0;
  ASSERT_EQ(shared.begin(poseOf({0, 0, 0}, {0, 0, -5.0})), Status::kOk);
  EXPECT_EQ(finishShuffled(shared, 3, random, most), Status::kOk);
  EXPECT_EQ(shared.output.pixel_count, 0);
  EXPECT_TRUE(std::ranges::all_of(shared.face, [](std::int32_t face) { return face == -1; }));
}

TEST(EdgeRendererTasks, UseExactlyTheCountedBytes) {
  const SceneMesh mesh = scattered(6, 64);
  const RenderOptions options;
  std::vector<std::byte> memory(std::size_t{16} << 20);
  Arena arena(memory);
  MeshAdjacency adjacency;
  ASSERT_EQ(buildAdjacency(mesh.view(), arena, adjacency), Status::kOk);
  std::size_t before = 0;
  for (const int workers : {1, 2, 5}) {
    Arena counting;
    EdgeRenderer renderer;
    ASSERT_EQ(renderer.create(mesh.view(), MeshAdjacency(), 200, 150, options, counting,
                              EdgeRenderer::kBandRows, workers),
              Status::kOk);
    EXPECT_GT(counting.used(), before);
    before = counting.used();
    std::vector<std::byte> block(counting.used());
    Arena exact(block);
    EXPECT_EQ(renderer.create(mesh.view(), adjacency, 200, 150, options, exact,
                              EdgeRenderer::kBandRows, workers),
              Status::kOk);
    EXPECT_EQ(exact.used(), block.size());
    Arena small(std::span<std::byte>(block).first(block.size() - 16));
    EXPECT_EQ(renderer.create(mesh.view(), adjacency, 200, 150, options, small,
                              EdgeRenderer::kBandRows, workers),
              Status::kArenaTooSmall);
  }
  EdgeRenderer renderer;
  EXPECT_EQ(
      renderer.create(mesh.view(), adjacency, 200, 150, options, arena, EdgeRenderer::kBandRows, 0),
      Status::kInvalidOption);
}

}  // namespace
}  // namespace boresight::testing
