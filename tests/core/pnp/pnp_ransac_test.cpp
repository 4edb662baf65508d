// SPDX-License-Identifier: Apache-2.0
#include "core/pnp/pnp_ransac.h"

#include <cmath>
#include <cstring>

#include <gtest/gtest.h>
#include <Eigen/Cholesky>

#include "tests/core/geometry/example_cameras.h"
#include "tests/core/geometry/planetary_cameras.h"
#include "tests/core/localizer/heap_count.h"
#include "tests/core/pnp/pnp_scene.h"

namespace boresight::test {
namespace {

/// Checks the reported figures against the reported pose, from the definitions.
void expectSelfConsistent(const PnpScene& scene, double threshold_px, const PnpSolution& solution) {
  int count = 0;
  double sum = 0.0;
  ASSERT_TRUE(solution.camera_from_station.isFinite());
  for (std::size_t i = 0; i < scene.correspondences.size(); ++i) {
    const Correspondence& item = scene.correspondences[i];
    Eigen::Vector2d pixel;
    double residual_px = 1e6;
    if (project(scene.camera, solution.camera_from_station * item.point_in_station_m, pixel)) {
      residual_px = (item.pixel - pixel).norm();
    }
    EXPECT_NEAR(solution.residual_px[i], residual_px, 1e-8);
    if (std::abs(residual_px - threshold_px) > 1e-8) {
      EXPECT_EQ(solution.inlier[i] != 0, residual_px < threshold_px) << "correspondence " << i;
    }
    if (solution.inlier[i] == 0) continue;
    ++count;
    sum += residual_px * residual_px;
  }
  EXPECT_EQ(solution.inlier_count, count);
  EXPECT_NEAR(solution.rms_px, std::sqrt(sum / count), 1e-8);
  Matrix6d covariance;
  ASSERT_EQ(poseCovariance(scene.correspondences, solution.inlier, scene.camera,
                           solution.camera_from_station, covariance),
            Status::kOk);
  EXPECT_EQ(solution.covariance, covariance);
}

/// Squared error of the pose in units of its own covariance: 6 on average, and beyond 50 once in
/// 10^8 poses if the inliers are the right ones.
double normalizedSquaredError(const PnpScene& scene, const PnpSolution& solution) {
  const Vector6d xi = perturbationBetween(solution.camera_from_station, scene.camera_from_station);
  return xi.dot(Eigen::LLT<Matrix6d>(solution.covariance).solve(xi));
}

/// Number of outliers classified as inliers and of inliers classified as outliers.
int misjudged(const PnpScene& scene, const PnpSolution& solution) {
  int count = 0;
  for (std::size_t i = 0; i < scene.correspondences.size(); ++i) {
    count += (solution.inlier[i] != 0) == scene.is_outlier[i] ? 1 : 0;
  }
  return count;
}

void expectTruthOfExactData(const PnpScene& scene, double threshold_px,
                            const PnpOptions& options = {}) {
  const Solved solver(scene, threshold_px, options);
  EXPECT_THAT(solver.solution.camera_from_station, poseNear(scene.camera_from_station, 1e-9, 1e-9));
  expectSelfConsistent(scene, threshold_px, solver.solution);
}

TEST(PnpRansac, RecoversExactData) {
  Random random = randomFor("PnpRansacSamplers.RecoverExactData");
  for (int trial = 0; trial < 100; ++trial) {
    SCOPED_TRACE(trial);
    expectTruthOfExactData(makeScene(random, {.points = 6 + trial, .outlier_share = 0.3}), 2.0,
                           {.min_inliers = 4});
  }
}

TEST(PnpRansac, WithstandsWrongMatches) {
  for (const auto& [outlier_share, name] :
       {std::pair{0.5, "PnpRansacSamplers.WithstandHalfTheMatchesBeingWrong"},
        {0.7, "PnpRansac.ThreeGuidedPointsWithstandSeventyPercentInFewSamples"}}) {
    Random random = randomFor(name);
    for (int trial = 0; trial < 100; ++trial) {
      SCOPED_TRACE(testing::Message() << outlier_share << ", trial " << trial);
      const PnpScene scene =
          makeScene(random, {.points = 100, .outlier_share = outlier_share, .noise_px = 1.0});
      const Solved solver(scene, 8.0);
      EXPECT_LT(normalizedSquaredError(scene, solver.solution), 50.0);
      expectSelfConsistent(scene, 8.0, solver.solution);
      if (outlier_share > 0.5) continue;
      EXPECT_LE(misjudged(scene, solver.solution), 2);
      EXPECT_NEAR(solver.solution.rms_px, std::sqrt(2.0), 0.5);
    }
  }
}

TEST(PnpRansac, SolvesPlanesAndNearPlanes) {
  Random random = randomFor("PnpRansacSamplers.SolvePlanesAndNearPlanes");
  for (const double half_depth_m : {0.0, 1e-6, 1e-3}) {
    for (int trial = 0; trial < 30; ++trial) {
      PnpSceneOptions options{.points = 80, .outlier_share = 0.4, .half_depth_m = half_depth_m};
      options.tilt_rad = trial % 2 == 0 ? 0.0 : 0.2;  // wholly frontal, too
      expectTruthOfExactData(makeScene(random, options), 4.0);
      options.noise_px = 1.0;
      const PnpScene noisy = makeScene(random, options);
      const Solved solver(noisy, 8.0);
      EXPECT_LT(normalizedSquaredError(noisy, solver.solution), 50.0);
      expectSelfConsistent(noisy, 8.0, solver.solution);
    }
  }
}

TEST(PnpRansac, WorksWithEveryCameraModel) {
  Random random = randomFor("PnpRansacSamplers.WorkWithEveryCameraModel");
  for (const NamedCamera& named : exampleCameras()) {
    SCOPED_TRACE(named.name);
    // So near that points are seen out to where the lenses bend.
    const PnpSceneOptions options{.points = 60, .outlier_share = 0.4, .distance_m = 0.3};
    expectTruthOfExactData(makeScene(random, options, named.camera), 3.0);
  }
}

TEST(PnpRansac, ReturnsTheLeastSquaresOverItsInliers) {
  Random random = randomFor("PnpRansacSamplers.ReturnTheLeastSquaresOverTheirInliers");
  for (int trial = 0; trial < 30; ++trial) {
    PnpScene scene = makeScene(random, {.points = 80, .outlier_share = 0.4, .noise_px = 1.5});
    for (Correspondence& item : scene.correspondences) item.sigma_px = random.uniform(0.5, 2.0);
    const Solved solver(scene, 3.0);
    const auto cost = [&](const Pose& at) {
      return reprojectionCost(scene.correspondences, solver.inlier, scene.camera, at);
    };
    EXPECT_LT(newtonStepLeft(cost, solver.solution.camera_from_station), 1e-7);
    expectSelfConsistent(scene, 3.0, solver.solution);
  }
}

TEST(PnpRansac, StopsSoonerWithMoreInliers) {
  Random random = randomFor("PnpRansacSamplers.StopSoonerWithMoreInliers");
  for (const double share : {0.2, 0.4, 0.5}) {
    const PnpScene scene = makeScene(random, {.points = 100, .outlier_share = share});
    const Solved solver(scene, 2.0);
    const double wanted = std::log(1.0 - 0.999) / std::log(1.0 - std::pow(1.0 - share, 3));
    EXPECT_NEAR(solver.solution.samples, std::ceil(wanted), 1.0 + 0.1 * wanted) << share;
  }
}

TEST(PnpRansac, TrustsPreciseMatchesMore) {
  Random random = randomFor("PnpRansac.TrustsPreciseMatchesMore");
  for (int trial = 0; trial < 20; ++trial) {
    PnpScene scene = makeScene(random, {.points = 90});
    // The larger half agrees on another pose, but is declared imprecise. It is hardly larger, so
    // that the search does not stop before it draws a sample of the other half.
    const Pose wrong = displacedAboutPivot(
        scene.camera_from_station, randomOffset(random, scene.hypothesis.sigma), {0.0, 0.0, 0.0});
    for (std::size_t i = 0; i < 46; ++i) {
      Correspondence& item = scene.correspondences[i];
      ASSERT_TRUE(project(scene.camera, wrong * item.point_in_station_m, item.pixel));
      item.sigma_px = 3.0;
    }
    const Solved solver(scene, 4.0, {.seed = trial});
    EXPECT_THAT(solver.solution.camera_from_station,
                poseNear(scene.camera_from_station, 0.01, 1e-3));
  }
}

TEST(PnpRansac, TriesTheHypothesisItself) {
  Random random = randomFor("PnpRansac.TriesTheHypothesisItself");
  for (int trial = 0; trial < 20; ++trial) {
    PnpScene scene = makeScene(random, {.points = 100, .outlier_share = 0.8});
    scene.hypothesis.camera_from_station = perturbed(
        (Vector6d() << 3e-4, -3e-4, 3e-4, 1e-4, 1e-4, -1e-4).finished(), scene.camera_from_station);
    const Solved solver(scene, 4.0, {.max_samples = 1});
    EXPECT_GE(solver.solution.inlier_count, 20);
  }
}

TEST(PnpRansac, WorksFarAwayWithAPivotAtTheStation) {
  Random random = randomFor("PnpRansac.WorksFarAwayWithAPivotAtTheStation");
  for (int trial = 0; trial < 50; ++trial) {
    PnpScene scene =
        makeScene(random, {.points = 80, .outlier_share = 0.5, .noise_px = 0.5, .distance_m = 1.2});
    scene.hypothesis.sigma.pivot_in_camera_m = scene.camera_from_station.translation_m;
    scene.hypothesis.camera_from_station =
        displacedAboutPivot(scene.camera_from_station, randomOffset(random, scene.hypothesis.sigma),
                            scene.hypothesis.sigma.pivot_in_camera_m);
    EXPECT_LT(normalizedSquaredError(scene, Solved(scene, 4.0).solution), 50.0) << trial;
  }
}

bool sameBits(const PnpSolution& a, const PnpSolution& b) {
  const auto equal = [](const void* x, const void* y, std::size_t bytes) {
    return std::memcmp(x, y, bytes) == 0;
  };
  return a.inlier_count == b.inlier_count && a.samples == b.samples &&
         equal(&a.rms_px, &b.rms_px, sizeof(double)) &&
         equal(a.camera_from_station.rotation.coeffs().data(),
               b.camera_from_station.rotation.coeffs().data(), 4 * sizeof(double)) &&
         equal(a.camera_from_station.translation_m.data(),
               b.camera_from_station.translation_m.data(), 3 * sizeof(double)) &&
         equal(a.covariance.data(), b.covariance.data(), 36 * sizeof(double)) &&
         equal(a.inlier.data(), b.inlier.data(), a.inlier.size()) &&
         equal(a.residual_px.data(), b.residual_px.data(), a.residual_px.size() * sizeof(double));
}

TEST(PnpRansac, SteppedOrRepeatedRuns_GiveTheSameBitsAndAllocateNothing) {
  Random random = randomFor("PnpRansac.GivesTheSameBitsHoweverItIsRun");
  const PnpScene scene = makeScene(random, {.points = 90, .outlier_share = 0.5, .noise_px = 1.0});
  const PnpScene other = makeScene(random, {.points = 50, .outlier_share = 0.6, .noise_px = 2.0});
  for (const PnpSampler sampler : {PnpSampler::kGuided, PnpSampler::kEpnp}) {
    const PnpOptions options{.sampler = sampler};
    Solver whole(90);
    const int before = heapAllocations();
    const Status status = whole.solve(scene, 8.0, options);
    EXPECT_EQ(heapAllocations(), before);
    ASSERT_EQ(status, Status::kOk);
    // Two solvers whose steps alternate, the first having solved another problem before.
    Solver stepped(120);
    ASSERT_EQ(stepped.solve(other, 5.0, PnpOptions()), Status::kOk);
    Solver between(50);
    ASSERT_EQ(stepped.begin(scene, 8.0, options), Status::kOk);
    ASSERT_EQ(between.begin(other, 8.0, options), Status::kOk);
    bool done = false;
    bool between_done = false;
    int steps = 0;
    for (; !done; ++steps) {
      ASSERT_EQ(stepped.ransac.step(done), Status::kOk);
      ASSERT_EQ(between.ransac.step(between_done), Status::kOk);
    }
    EXPECT_GT(steps, 1);
    EXPECT_TRUE(sameBits(whole.solution, stepped.solution));
    // Stepping on changes nothing.
    ASSERT_EQ(stepped.ransac.step(done), Status::kOk);
    EXPECT_TRUE(done);
    EXPECT_TRUE(sameBits(whole.solution, stepped.solution));
  }
}

TEST(PnpRansac, TheSeedChoosesTheSamples) {
  Random random = randomFor("PnpRansac.TheSeedChoosesTheSamples");
  const PnpScene scene = makeScene(random, {.points = 100, .outlier_share = 0.6, .noise_px = 1.0});
  Solver first(100), second(100);
  // With so few samples any outcome will do.
  (void)first.solve(scene, 2.0, {.max_samples = 20, .min_inliers = 4});
  (void)second.solve(scene, 2.0, {.max_samples = 20, .min_inliers = 4, .seed = 2});
  EXPECT_FALSE(sameBits(first.solution, second.solution));
}

TEST(PnpRansac, UsesExactlyTheCountedBytes) {
  Arena counting;
  PnpRansac ransac;
  ASSERT_EQ(ransac.create(300, counting), Status::kOk);
  std::vector<std::byte> memory(counting.used());
  Arena enough(memory);
  EXPECT_EQ(ransac.create(300, enough), Status::kOk);
  Arena short_of_one(std::span<std::byte>(memory).first(memory.size() - 1));
  EXPECT_EQ(ransac.create(300, short_of_one), Status::kArenaTooSmall);
}

constexpr PnpSceneOptions kPointsAllOverTheImage{
    .points = 60, .half_width_m = 0.3, .half_depth_m = 0.05};

/// A camera whose pupil moves by 4 mm; a third of the points are wrong.
TEST(PnpWithAMovingPupil, OutliersAreRejected) {
  const Camera camera = planetaryCamera("HazardDeepPupil");
  ASSERT_TRUE(pupilMoves(camera));
  PnpSceneOptions scene_options = kPointsAllOverTheImage;
  scene_options.outlier_share = 0.33;
  for (const PnpSampler sampler : {PnpSampler::kGuided, PnpSampler::kEpnp}) {
    Random random = randomFor("PnpWithAMovingPupil");
    for (int run = 0; run < 20; ++run) {
      SCOPED_TRACE(run);
      const PnpScene scene = makeScene(random, scene_options, camera);
      const Solved solver(scene, 1.0, {.sampler = sampler});
      EXPECT_THAT(solver.solution.camera_from_station,
                  poseNear(scene.camera_from_station, 1e-9, 1e-9));
      for (std::size_t i = 0; i < scene.correspondences.size(); ++i)
        EXPECT_TRUE(scene.is_outlier[i] || solver.solution.inlier[i] != 0);
    }
  }
}

/// A minimal sample is exact when the hypothesis has the exact depths of its points.
TEST(PnpWithAMovingPupil, OneMinimalSampleIsExact) {
  const Camera camera = planetaryCamera("HazardDeepPupil");
  Random random = randomFor("OneMinimalSampleIsExact");
  for (int run = 0; run < 20; ++run) {
    SCOPED_TRACE(run);
    PnpScene scene = makeScene(random, kPointsAllOverTheImage, camera);
    scene.hypothesis.camera_from_station = scene.camera_from_station;
    const Solved solver(scene, 0.01,
                        {.sampler = PnpSampler::kEpnp, .max_samples = 1, .min_inliers = 60});
    EXPECT_EQ(solver.solution.inlier_count, 60);
  }
}

}  // namespace
}  // namespace boresight::test
