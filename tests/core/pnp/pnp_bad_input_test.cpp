// SPDX-License-Identifier: Apache-2.0
#include <functional>

#include <gtest/gtest.h>

#include "tests/core/pnp/pnp_scene.h"
#include "tests/support/not_finite.h"

namespace boresight::test {
namespace {

/// For any status: a finite pose with consistent inliers and residuals.
void expectSound(const PnpSolution& solution, Status status) {
  EXPECT_TRUE(solution.camera_from_station.isFinite());
  EXPECT_NEAR(solution.camera_from_station.rotation.norm(), 1.0, 1e-6);
  EXPECT_TRUE(solution.covariance.allFinite());
  EXPECT_TRUE(isFinite(solution.rms_px));
  int inliers = 0;
  for (std::size_t i = 0; i < solution.inlier.size(); ++i) {
    inliers += solution.inlier[i];
    EXPECT_GE(solution.residual_px[i], 0.0);
    EXPECT_LE(solution.residual_px[i], 1e6);
  }
  EXPECT_EQ(solution.inlier_count, inliers);
  EXPECT_TRUE(status == Status::kOk || inliers == 0);
}

Status solveSoundly(const PnpScene& scene, double threshold_px, const PnpOptions& options) {
  Solver solver(std::max<std::size_t>(scene.correspondences.size(), 1));
  const Status status = solver.solve(scene, threshold_px, options);
  expectSound(solver.solution, status);
  return status;
}

class PnpRansacBadInput : public ::testing::TestWithParam<PnpSampler> {
 protected:
  PnpOptions options() const { return {.sampler = GetParam()}; }
};

INSTANTIATE_TEST_SUITE_P(EverySampler, PnpRansacBadInput,
                         ::testing::Values(PnpSampler::kGuided, PnpSampler::kEpnp),
                         [](const auto& tested) {
                           return std::string(kPnpSamplerNames[static_cast<int>(tested.param)]);
                         });

TEST_P(PnpRansacBadInput, FewPointsAreTooFew) {
  Random random = randomFor("PnpRansacBadInput.FewPointsAreTooFew");
  const PnpOptions four{.sampler = GetParam(), .min_inliers = 4};
  const int fewest = GetParam() == PnpSampler::kEpnp ? 5 : 4;  // EPnP draws samples of five
  for (int points = 0; points <= 6; ++points) {
    const PnpScene scene = makeScene(random, {.points = points});
    EXPECT_EQ(solveSoundly(scene, 2.0, options()), points < 6 ? Status::kTooFewPoints : Status::kOk)
        << points;
    EXPECT_EQ(solveSoundly(scene, 2.0, four), points < fewest ? Status::kTooFewPoints : Status::kOk)
        << points;
  }
}

TEST_P(PnpRansacBadInput, CollinearOrRepeatedPointsAreDegenerate) {
  Random random = randomFor("PnpRansacBadInput.CollinearPointsAreDegenerate");
  for (int trial = 0; trial < 20; ++trial) {
    PnpScene scene = makeScene(random, {.points = 30});
    makeCollinear(random, randomDirection(random), scene);
    EXPECT_EQ(solveSoundly(scene, 2.0, options()), Status::kDegenerate);
  }
  PnpScene one_point = makeScene(random, {.points = 1});
  one_point.correspondences.resize(20, one_point.correspondences[0]);
  EXPECT_EQ(solveSoundly(one_point, 2.0, options()), Status::kDegenerate);
}

TEST_P(PnpRansacBadInput, RepeatedPoints_GiveTheTruePose) {
  Random random = randomFor("PnpRansacBadInput.RepeatedPointsDoNoHarm");
  PnpScene scene = makeScene(random, {.points = 10});
  for (int copy = 0; copy < 5; ++copy) {
    for (std::size_t i = 0; i < 10; ++i) scene.correspondences.push_back(scene.correspondences[i]);
  }
  const Solved solver(scene, 2.0, options());
  EXPECT_THAT(solver.solution.camera_from_station, poseNear(scene.camera_from_station, 1e-9, 1e-9));
}

TEST_P(PnpRansacBadInput, RandomMatchesFindNoConsensus) {
  Random random = randomFor("PnpRansacBadInput.RandomMatchesFindNoConsensus");
  const PnpOptions strict{.sampler = GetParam(), .min_inliers = 20};
  for (int trial = 0; trial < 20; ++trial) {
    const PnpScene scene = makeScene(random, {.points = 60, .outlier_share = 1.0});
    EXPECT_EQ(solveSoundly(scene, 2.0, strict), Status::kNoConsensus);
  }
}

TEST_P(PnpRansacBadInput, UnusableCorrespondencesAreNeverInliers) {
  Random random = randomFor("PnpRansacBadInput.UnusableCorrespondencesAreNeverInliers");
  PnpScene scene = makeScene(random, {.points = 40});
  const std::vector<std::function<void(Correspondence&)>> breakers = {
      [](Correspondence& c) { c.pixel.x() = kNan; },
      [](Correspondence& c) { c.pixel.y() = kInfinity; },
      [](Correspondence& c) { c.pixel.y() = -1e200; },
      [](Correspondence& c) { c.point_in_station_m.x() = kNan; },
      [](Correspondence& c) { c.point_in_station_m.y() = -kInfinity; },
      [](Correspondence& c) { c.point_in_station_m.z() = 1e308; },
      [](Correspondence& c) { c.sigma_px = kNan; },
      [](Correspondence& c) { c.sigma_px = 0.0; },
      [](Correspondence& c) { c.sigma_px = -1.0; },
      [](Correspondence& c) { c.sigma_px = kInfinity; },
      [](Correspondence& c) { c.sigma_px = 1e-300; },
  };
  for (std::size_t i = 0; i < breakers.size(); ++i) breakers[i](scene.correspondences[3 * i]);
  const Solved solver(scene, 2.0, options());
  expectSound(solver.solution, Status::kOk);
  EXPECT_THAT(solver.solution.camera_from_station, poseNear(scene.camera_from_station, 1e-9, 1e-9));
  for (std::size_t i = 0; i < breakers.size(); ++i) EXPECT_EQ(solver.inlier[3 * i], 0) << i;
  EXPECT_EQ(solver.solution.inlier_count, 40 - static_cast<int>(breakers.size()));
  for (Correspondence& item : scene.correspondences) item.pixel.x() = kNan;
  EXPECT_EQ(solveSoundly(scene, 2.0, options()), Status::kTooFewPoints);
}

TEST_P(PnpRansacBadInput, BadHypothesesAreInvalid) {
  Random random = randomFor("PnpRansacBadInput.BadHypothesesAreInvalid");
  const PnpScene good = makeScene(random, {.points = 20});
  const std::vector<std::function<void(PosePrior&)>> breakers = {
      [](PosePrior& p) { p.camera_from_station.translation_m.x() = kNan; },
      [](PosePrior& p) { p.camera_from_station.translation_m.z() = kInfinity; },
      [](PosePrior& p) { p.camera_from_station.rotation.coeffs().setZero(); },
      [](PosePrior& p) { p.camera_from_station.rotation.coeffs() *= 3.0; },
      [](PosePrior& p) { p.camera_from_station.rotation.w() = kNan; },
      [](PosePrior& p) { p.sigma.rotation_rad.x() = kNan; },
      [](PosePrior& p) { p.sigma.translation_m.y() = -0.1; },
      [](PosePrior& p) { p.sigma.translation_m.y() = kInfinity; },
      [](PosePrior& p) { p.sigma.pivot_in_camera_m.y() = kInfinity; },
  };
  for (const auto& breaker : breakers) {
    PnpScene scene = good;
    breaker(scene.hypothesis);
    EXPECT_EQ(solveSoundly(scene, 2.0, options()), Status::kInvalidPose);
  }
}

TEST_P(PnpRansacBadInput, HypothesisFacingAway_EndsWithAStatus) {
  Random random = randomFor("PnpRansacBadInput.AHypothesisThatSeesNothingEndsWithAStatus");
  PnpScene scene = makeScene(random, {.points = 20});
  scene.hypothesis.camera_from_station.translation_m.z() = -0.5;
  const bool solved = solveSoundly(scene, 2.0, options()) == Status::kOk;
  EXPECT_EQ(solved, GetParam() == PnpSampler::kEpnp) << "EPnP does not need the hypothesis";
}

TEST_P(PnpRansacBadInput, BadThresholdsOptionsAndCamerasAreInvalid) {
  Random random = randomFor("PnpRansacBadInput.BadThresholdsAndOptionsAreInvalid");
  PnpScene scene = makeScene(random, {.points = 20});
  for (const double threshold_px : {0.0, -1.0, kNan, kInfinity, 1e7}) {
    EXPECT_EQ(solveSoundly(scene, threshold_px, options()), Status::kInvalidOption);
  }
  for (const PnpOptions& bad : {PnpOptions{.sampler = GetParam(), .max_samples = 0},
                                PnpOptions{.sampler = GetParam(), .min_inliers = 3}})
    EXPECT_EQ(solveSoundly(scene, 2.0, bad), Status::kInvalidOption);
  scene.camera.fx = kNan;
  EXPECT_EQ(solveSoundly(scene, 2.0, options()), Status::kInvalidCamera);
  scene.camera = armCamera();
  scene.camera.valid_radius = 0.0;  // never prepared
  EXPECT_EQ(solveSoundly(scene, 2.0, options()), Status::kInvalidCamera);
}

TEST_P(PnpRansacBadInput, MoreCorrespondencesThanAllocated_ExceedTheCapacity) {
  Random random = randomFor("PnpRansacBadInput.MoreThanItWasCreatedForExceedsTheCapacity");
  const PnpScene scene = makeScene(random, {.points = 21});
  Solver solver(20);
  solver.inlier.resize(21, 7);
  solver.residual_px.resize(21, -1.0);
  EXPECT_EQ(solver.solve(scene, 2.0, options()), Status::kCapacityExceeded);
  expectSound(solver.solution, Status::kCapacityExceeded);
  bool done = false;
  EXPECT_EQ(solver.ransac.step(done), Status::kCapacityExceeded);
  EXPECT_TRUE(done);
}

TEST(PnpRansac, StepBeforeBegin_IsDone) {
  PnpRansac ransac;
  bool done = false;
  EXPECT_EQ(ransac.step(done), Status::kTooFewPoints);
  EXPECT_TRUE(done);
}

TEST(PnpRansac, SurvivesArbitraryNumbers) {
  Random random = randomFor("PnpRansac.SurvivesArbitraryNumbers");
  const double values[] = {0.0,  -0.0, 1.0,   -1.0,   1e-310, 1e-30,    1e8,
                           -1e8, 1e30, 1e300, -1e300, kNan,   kInfinity};
  const auto pick = [&random, &values]() { return values[random.below(13)]; };
  for (int trial = 0; trial < 300; ++trial) {
    PnpScene scene = makeScene(random, {.points = 20, .outlier_share = 0.2});
    for (Correspondence& item : scene.correspondences) {
      if (random.below(2) == 0) item.point_in_station_m[static_cast<int>(random.below(3))] = pick();
      if (random.below(4) == 0) item.pixel[static_cast<int>(random.below(2))] = pick();
      if (random.below(8) == 0) item.sigma_px = pick();
    }
    if (random.below(4) == 0) scene.hypothesis.camera_from_station.translation_m.z() = pick();
    const PnpOptions options{
        .sampler = static_cast<PnpSampler>(trial % 2), .max_samples = 50, .min_inliers = 4};
    (void)solveSoundly(scene, 5.0, options);  // any status, as long as the solution is sound
  }
}

}  // namespace
}  // namespace boresight::test
