// SPDX-License-Identifier: Apache-2.0
#include "core/search/pose_search.h"

#include <algorithm>
#include <vector>

#include <gtest/gtest.h>

#include "core/base/math.h"
#include "core/search/pose_evidence.h"
#include "tests/core/localizer/scene.h"

namespace boresight {
namespace {

/// A search with all its memory.
class SearchRun {
 public:
  explicit SearchRun(const test::Case& scene) : scene_(scene), block_(16 << 20), arena_(block_) {
    const LocalizationProblem from = scene.problem();
    problem_ = {from.image,
                from.color,
                from.ignore,
                from.camera,
                from.mesh,
                matchedBounds(from.mesh),
                from.camera_from_station_seed,
                from.uncertainty};
    EXPECT_EQ(buildAdjacency(from.mesh, arena_, adjacency_), Status::kOk);
    EXPECT_EQ(renderer_.create(from.mesh, adjacency_, PoseSearch::kLongestView_px,
                               PoseSearch::kLongestView_px, RenderOptions(), arena_),
              Status::kOk);
    EXPECT_EQ(search_.create(arena_), Status::kOk);
  }
  std::span<const PoseCandidate> run() {
    int steps = 0;
    if (search_.begin(problem_, renderer_))
      while (!search_.step() && steps < 1000000) ++steps;
    EXPECT_LT(steps, 1000000);
    return search_.candidates();
  }
  double error_px(const Pose& pose) const {
    return test::meanDisplacement_px(scene_.solid, scene_.camera, scene_.truth, pose);
  }
  PoseSearch& search() { return search_; }
  const SearchProblem& problem() const { return problem_; }

 private:
  const test::Case& scene_;
  std::vector<std::byte> block_;
  Arena arena_;
  SearchProblem problem_;
  MeshAdjacency adjacency_;
  EdgeRenderer renderer_;
  PoseSearch search_;
};

TEST(PoseSearch, AnywhereInTheUncertainty_FindsTheTruth) {
  for (const bool distorted : {false, true})
    for (std::uint64_t seed = 1; seed <= 4; ++seed) {
      SCOPED_TRACE(seed);
      const test::Case scene = test::stationCase(seed, distorted);
      SearchRun run(scene);
      const auto candidates = run.run();
      ASSERT_FALSE(candidates.empty());
      EXPECT_LT(run.error_px(candidates[0].camera_from_station), 2.0);
      EXPECT_GT(candidates[0].evidence.strongest_nats(), 0.5);
      EXPECT_LE(candidates.size(), static_cast<std::size_t>(PoseSearch::kMaxCandidates));
    }
}

TEST(PoseSearch, LargerUncertainty_IsTheSameSearchWithMorePoses) {
  test::Case scene = test::stationCase(2);
  SearchRun narrow(scene);
  (void)narrow.run();
  const std::int64_t poses = narrow.search().search().poses();
  scene.uncertainty.rotation_rad.z() = kPi;
  SearchRun wide(scene);
  const auto candidates = wide.run();
  ASSERT_FALSE(candidates.empty());
  EXPECT_GT(wide.search().search().poses(), 5 * poses);
  EXPECT_LT(wide.error_px(candidates[0].camera_from_station), 2.0);
}

TEST(PoseSearch, CandidatesOfTheSearch_LieWithinTheUncertaintyAndAGridStep) {
  const test::Case scene = test::stationCase(3);
  SearchRun run(scene);
  (void)run.run();
  const SeedUncertainty& box = scene.uncertainty;
  for (const SearchCandidate& candidate : run.search().search().candidates()) {
    const Vector6d offset =
        offsetAboutPivot(scene.seed, candidate.camera_from_station, box.pivot_in_camera_m);
    for (int i = 0; i < 3; ++i) {
      EXPECT_LT(std::abs(offset[i]), 1.2 * box.rotation_rad[i] + 5.0 * kDegree_rad);
      EXPECT_LT(std::abs(offset[i + 3]), 1.2 * box.translation_m[i] + 0.03);
    }
  }
}

TEST(PoseSearch, FlatImage_EndsWithoutEvidence) {
  const test::Picture flat = test::flatPicture(512, 512, 80);
  test::Case scene = test::stationCase(1);
  scene.picture = &flat;
  SearchRun run(scene);
  for (const PoseCandidate& candidate : run.run())
    EXPECT_LT(candidate.evidence.strongest_nats(), 0.0);
}

TEST(PoseSearch, StationBehindTheCamera_HasNoCandidates) {
  test::Case scene = test::stationCase(1);
  scene.seed.translation_m.z() = -0.5;
  SearchRun run(scene);
  EXPECT_TRUE(run.run().empty());
}

TEST(PoseEvidence, OfARenderOfTheRealCamera_IsThatOfTheTruth) {
  const test::Case scene = test::stationCase(1, true);
  const SearchRun run(scene);
  const auto evidenceOf = [&](const Pose& pose) {
    const test::Rendering render = test::renderEdges(scene.solid, scene.camera, pose);
    std::vector<std::byte> block(4 << 20);
    Arena arena(block);
    PoseEvidence evidence;
    EXPECT_EQ(evidence.create(arena), Status::kOk);
    EXPECT_TRUE(evidence.begin(run.problem(), render.edges));
    while (!evidence.step()) {
    }
    return evidence.evidence();
  };
  EXPECT_GT(evidenceOf(scene.truth).strongest_nats(), 0.6);
  Pose moved = scene.truth;
  moved.translation_m.x() += 0.008;
  EXPECT_LT(evidenceOf(moved).strongest_nats(), 0.2);
}

}  // namespace
}  // namespace boresight
