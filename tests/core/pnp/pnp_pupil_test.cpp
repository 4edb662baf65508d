// SPDX-License-Identifier: Apache-2.0
// Poses from a camera whose rays do not meet in one point.
#include <gtest/gtest.h>

#include "tests/core/geometry/planetary_cameras.h"
#include "tests/core/pnp/pnp_scene.h"

namespace boresight {
namespace {

using test::makeScene;
using test::PnpScene;
using test::PnpSceneOptions;
using test::poseNear;
using test::randomFor;
using test::Solver;

class PnpSamplersWithAMovingPupil : public ::testing::TestWithParam<PnpSampler> {};
INSTANTIATE_TEST_SUITE_P(Samplers, PnpSamplersWithAMovingPupil,
                         ::testing::Values(PnpSampler::kP3p, PnpSampler::kGuided));

/// Points all over the image of a camera whose pupil moves by 4 mm, a third of them wrong.
TEST_P(PnpSamplersWithAMovingPupil, FindsTheTruthDespiteOutliers) {
  const Camera camera = test::planetaryCamera("HazardDeepPupil");
  ASSERT_TRUE(pupilMoves(camera));
  Random random = randomFor("PnpWithAMovingPupil");
  PnpSceneOptions scene_options;
  scene_options.points = 60;
  scene_options.outlier_share = 0.33;
  scene_options.half_width_m = 0.3;
  scene_options.half_depth_m = 0.05;
  PnpOptions options;
  options.sampler = GetParam();
  for (int run = 0; run < 20; ++run) {
    const PnpScene scene = makeScene(random, scene_options, camera);
    Solver solver(scene.correspondences.size());
    ASSERT_EQ(solver.solve(scene, 1.0, options), Status::kOk) << run;
    EXPECT_THAT(solver.solution.camera_from_station,
                poseNear(scene.camera_from_station, 1e-9, 1e-9))
        << run;
    for (std::size_t i = 0; i < scene.correspondences.size(); ++i) {
      if (!scene.is_outlier[i]) {
        EXPECT_TRUE(solver.solution.inlier[i] != 0) << run;
      }
    }
  }
}

/// A minimal sample is exact where the hypothesis knows how far off its points are.
TEST(PnpWithAMovingPupil, OneMinimalSampleIsExact) {
  const Camera camera = test::planetaryCamera("HazardDeepPupil");
  Random random = randomFor("OneMinimalSampleIsExact");
  PnpSceneOptions scene_options;
  scene_options.points = 60;
  scene_options.half_width_m = 0.3;
  scene_options.half_depth_m = 0.05;
  PnpOptions options;
  options.sampler = PnpSampler::kP3p;
  options.max_samples = 1;
  options.min_inliers = 60;
  for (int run = 0; run < 20; ++run) {
    PnpScene scene = makeScene(random, scene_options, camera);
    scene.hypothesis.camera_from_station = scene.camera_from_station;
    Solver solver(scene.correspondences.size());
    ASSERT_EQ(solver.solve(scene, 0.01, options), Status::kOk) << run;
    EXPECT_EQ(solver.solution.inlier_count, 60) << run;
  }
}

}  // namespace
}  // namespace boresight
