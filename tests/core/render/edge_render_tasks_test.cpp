// SPDX-License-Identifier: Apache-2.0
// Renders by several workers have the same bits as by one, for any assignment of tasks.
#include <algorithm>
#include <numeric>
#include <span>
#include <thread>
#include <vector>

#include <gtest/gtest.h>

#include "tests/core/render/scenes.h"

namespace boresight::testing {
namespace {

/// Tasks in any order, each by any worker; `most` is the largest number of tasks seen.
Status finishShuffled(Rendered& shared, int workers, Random& random, int& most) {
  Status status = Status::kOk;
  bool done = false;
  most = 0;
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

TEST(EdgeRendererTasks, SharedTasks_GiveTheBitsOfOneWorker) {
  Random random(7);
  const Pose inside = poseOf({0.4, -0.2, 1.3}, {0.0, 0.03, 0.05});
  for (const int facets : {32, 1200}) {
    const SceneMesh mesh = scattered(static_cast<std::uint64_t>(facets), facets);
    for (const Camera& camera : {pinholeCamera(201, 149, 200.0), brownCamera(150, 161, 160.0, -0.2),
                                 fisheyeCamera(130, 99, 70.0)}) {
      for (const Pose& pose : {kAhead, inside}) {
        const Rendered alone = render(mesh, camera, pose);
        for (const int workers : {2, 8}) {
          Rendered shared(mesh, camera, {}, EdgeRenderer::kBandRows, workers);
          for (const bool surfaces : {true, false}) {
            int most = 0;
            ASSERT_EQ(surfaces ? shared.begin(pose)
                               : shared.renderer.begin(shared.rays, pose, shared.edges),
                      Status::kOk);
            ASSERT_EQ(finishShuffled(shared, workers, random, most), Status::kOk);
            EXPECT_GT(most, 1);
            expectEqual(alone.edges, shared.edges);
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
  const SceneMesh mesh = scattered(5);
  const Camera camera = brownCamera(201, 149, 200.0, -0.25);
  const Rendered alone = render(mesh, camera, kAhead);
  ASSERT_GT(alone.edges.pixel_count, 300);
  for (const int band_rows : {1, 2, 3, 5, 37, 148, 149}) {
    Rendered shared(mesh, camera, {}, band_rows, 16);
    int most = 0;
    ASSERT_EQ(shared.begin(kAhead), Status::kOk);
    ASSERT_EQ(finishShuffled(shared, 16, random, most), Status::kOk);
    EXPECT_EQ(most > 2, band_rows > 1 && band_rows < 37) << band_rows;
    expectEqual(alone.edges, shared.edges);
  }
}

TEST(EdgeRendererTasks, ParallelThreads_GiveTheSameBits) {
  constexpr int kWorkers = 4;
  const SceneMesh mesh = scattered(8, 1500);
  const Camera camera = pinholeCamera(240, 200, 240.0);
  Rendered shared(mesh, camera, {}, EdgeRenderer::kBandRows, kWorkers);
  ASSERT_EQ(shared.renderer.begin(shared.rays, kAhead, shared.edges), Status::kOk);
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
  expectEqual(render(mesh, camera, kAhead).edges, shared.edges);
}

/// Expects renders by one worker and by several to end with a fault and leave the same output: the
/// number of its edge pixels.
int expectSameFault(const SceneMesh& mesh, const Camera& camera, const Pose& pose,
                    const RenderOptions& options, Status fault) {
  Random random(11);
  Rendered alone(mesh, camera, options);
  EXPECT_EQ(alone.begin(pose), Status::kOk);
  EXPECT_EQ(alone.renderer.tasks(), 0);
  EXPECT_EQ(alone.finish(), fault);
  for (const int workers : {2, 3, 8}) {
    Rendered shared(mesh, camera, options, EdgeRenderer::kBandRows, workers);
    int most = 0;
    EXPECT_EQ(shared.begin(pose), Status::kOk);
    EXPECT_EQ(finishShuffled(shared, workers, random, most), fault);
    expectEqual(alone.edges, shared.edges, false);
  }
  return alone.edges.pixel_count;
}

TEST(EdgeRendererTasks, CapacityExceeded_LeavesTheOutputOfOneWorker) {
  RenderOptions options;
  options.max_edge_pixels = 1000;
  EXPECT_EQ(expectSameFault(scattered(6), brownCamera(800, 600, 800.0, -0.2), kAhead, options,
                            Status::kCapacityExceeded),
            1000);
}

TEST(EdgeRendererTasks, TooManyLayers_AreRefusedAsByOneWorker) {
  SceneMesh mesh = scattered(6);
  // The lower half of the image is covered again and again.
  for (int i = 0; i < 2 * BandPainter::kMostLayers; ++i)
    mesh.addFace(mesh.addVertex({-20.0, 0.05, 1.0 + 1e-3 * i}),
                 mesh.addVertex({20.0, 0.05, 1.0 + 1e-3 * i}),
                 mesh.addVertex({0.0, 40.0, 1.0 + 1e-3 * i}));
  EXPECT_GT(expectSameFault(mesh, brownCamera(320, 240, 320.0, -0.2),
                            poseOf({0.0, 0.0, 0.0}, {0.01, 0.0, 0.5}), {}, Status::kTooManyLayers),
            0)
      << "the rows before are there";
}

TEST(EdgeRendererTasks, SceneOutsideTheImage_GivesNoEdges) {
  Random random(13);
  const SceneMesh mesh = scattered(6);
  Rendered shared(mesh, pinholeCamera(100, 90, 100.0), {}, EdgeRenderer::kBandRows, 3);
  int most = 0;
  ASSERT_EQ(shared.begin(poseOf({0, 0, 0}, {0, 0, -5.0})), Status::kOk);
  EXPECT_EQ(finishShuffled(shared, 3, random, most), Status::kOk);
  EXPECT_EQ(shared.edges.pixel_count, 0);
  EXPECT_EQ(shared.face, std::vector<std::int32_t>(100 * 90, -1));
}

TEST(EdgeRendererTasks, UseExactlyTheCountedBytes) {
  const SceneMesh mesh = scattered(6);
  Rendered rendered(mesh, pinholeCamera(200, 150, 200.0));
  const auto create = [&](Arena& arena, const MeshAdjacency& adjacency, int workers) {
    (void)createEdgeRender(200, 150, RenderOptions(), arena);
    return rendered.renderer.create(mesh.view(), adjacency, 200, 150, {}, arena,
                                    EdgeRenderer::kBandRows, workers);
  };
  std::size_t before = 0;
  for (const int workers : {1, 2, 5}) {
    Arena counting;
    ASSERT_EQ(create(counting, MeshAdjacency(), workers), Status::kOk);
    EXPECT_GT(counting.used(), before);
    before = counting.used();
    std::vector<std::byte> block(counting.used());
    Arena exact(block);
    EXPECT_EQ(create(exact, rendered.adjacency, workers), Status::kOk);
    EXPECT_EQ(exact.used(), block.size());
    Arena small(std::span<std::byte>(block).first(block.size() - 16));
    EXPECT_EQ(create(small, rendered.adjacency, workers), Status::kArenaTooSmall);
  }
  EXPECT_EQ(create(rendered.arena, rendered.adjacency, 0), Status::kInvalidOption);
}

}  // namespace
}  // namespace boresight::testing
