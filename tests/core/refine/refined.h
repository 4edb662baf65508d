// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <span>
#include <vector>

#include <gtest/gtest.h>

#include "core/refine/edge_refinement.h"
#include "tests/core/localizer/scene.h"

namespace boresight::test {

/// A refinement with all its memory.
struct Refined {
  std::vector<std::byte> memory;
  EdgeRefinement refinement;
  RefinementResult result;
  Status status = Status::kOk;
  int rounds = 0;
  int searches = 0;  ///< rounds that searched the image

  explicit Refined(const RefinementOptions& options = {}) : memory(std::size_t{4} << 20) {
    Arena arena(memory);
    EXPECT_EQ(refinement.create(options, arena), Status::kOk);
    result.samples = arena.allocate<EdgeSample>(static_cast<std::size_t>(options.max_samples));
    EXPECT_FALSE(arena.exhausted());
  }
  /// After a pass that succeeds.
  Refined(const Case& scene, const Pose& from, double radius_px, const PosePrior* anchor = nullptr,
          const PoseEstimate* matched = nullptr)
      : Refined() {
    pass(scene, from, radius_px, anchor, matched);
    EXPECT_EQ(status, Status::kOk);
  }

  /// One pass from a pose.
  void pass(const Case& scene, const Pose& from, double radius_px,
            const PosePrior* anchor = nullptr, const PoseEstimate* matched = nullptr) {
    const Rendering rendering = renderEdges(scene.solid, scene.camera, from);
    status = refinement.begin(scene.picture->view(), scene.ignore, scene.camera, scene.solid.view(),
                              rendering.edges, radius_px, anchor, matched, result);
    rounds = searches = 0;
    bool done = false;
    while (status == Status::kOk && !done && rounds < 1000) {
      searches += refinement.chunks() > 0 ? 1 : 0;
      status = refinement.step(done);
      ++rounds;
    }
    EXPECT_TRUE(done || rounds == 0);
  }
  const Pose& pose() const { return result.camera_from_station; }
  std::span<const EdgeSample> samples() const {
    return result.samples.first(static_cast<std::size_t>(result.sample_count));
  }
};

}  // namespace boresight::test
