// SPDX-License-Identifier: Apache-2.0
#include "core/refine/focal_fit.h"

#include <array>
#include <cmath>
#include <vector>

#include <gtest/gtest.h>

#include "core/base/random.h"
#include "tests/core/refine/refined.h"
#include "tests/support/coverage.h"
#include "tests/support/random_pose.h"

namespace boresight::test {
namespace {

/// The pose refined on the case's edges, and its focal length.
FocalFit fitAfterRefining(const Case& scene) {
  Refined refined;
  refined.result.camera_from_station = scene.truth;
  for (const double radius_px : {6.0, 3.0, 3.0}) {
    refined.pass(scene, refined.pose(), radius_px);
    EXPECT_EQ(refined.status, Status::kOk);
  }
  std::vector<std::byte> memory(std::size_t{1} << 20);
  Arena arena(memory);
  FocalFitter fitter;
  EXPECT_EQ(fitter.create(RefinementOptions().max_samples, arena), Status::kOk);
  fitter.begin(scene.camera, refined.result);
  int steps = 1;
  while (!fitter.step() && steps < 100) ++steps;
  EXPECT_LE(steps, FocalFitter::kRounds);
  return fitter.fit();
}

/// Focal lengths in units of their sigma, of draws of Gaussian residuals at the edges of a right
/// camera: independent ones, and one that the edges of a cell of the image share.
std::vector<double> focalErrors(double independent_px, double shared_px, Random& random) {
  const Case scene = stationCase(1);
  Refined refined(scene, scene.truth, 3.0);
  std::vector<EdgeSample> samples;
  Eigen::AlignedBox2d box_px;
  std::vector<Eigen::Vector2d> pixels;
  for (const EdgeSample& sample : refined.samples()) {
    Eigen::Vector2d pixel;
    if (sample.gradient == 0.0 ||
        !project(scene.camera, refined.pose() * sample.point_in_station_m, pixel))
      continue;
    samples.push_back(sample);
    pixels.push_back(pixel);
    box_px.extend(pixel);
  }
  std::vector<std::byte> memory(std::size_t{1} << 20);
  Arena arena(memory);
  FocalFitter fitter;
  EXPECT_EQ(fitter.create(RefinementOptions().max_samples, arena), Status::kOk);
  RefinementResult drawn = refined.result;
  std::vector<EdgeSample> some;
  std::vector<double> errors;
  for (int draw = 0; draw < 1000; ++draw) {
    std::array<double, 64> of_cell{};
    for (double& error : of_cell) error = shared_px * random.normal();
    some.clear();
    for (std::size_t i = 0; i < samples.size(); i += samples.size() / 600 + 1) {
      some.push_back(samples[i]);
      const Eigen::Vector2d cell =
          (8.0 * (pixels[i] - box_px.min()).cwiseQuotient(box_px.sizes())).cwiseMin(7.0);
      const auto at =
          static_cast<std::size_t>(8 * static_cast<int>(cell.x()) + static_cast<int>(cell.y()));
      some.back().residual_px = independent_px * random.normal() + of_cell[at];
    }
    drawn.samples = some;
    drawn.sample_count = static_cast<std::int32_t>(some.size());
    fitter.begin(scene.camera, drawn);
    while (!fitter.step()) {
    }
    EXPECT_TRUE(fitter.fit().determined);
    errors.push_back(fitter.fit().change / fitter.fit().sigma);
  }
  return errors;
}

/// Independent errors are counted by place, by side and by kind.
TEST(FocalFit, SigmaHoldsErrorsThatAreIndependentOrSharedByNeighbours) {
  Random random = randomFor("FocalFit.Sigma");
  expectGaussianCoverage(focalErrors(0.3, 0.0, random), true);
  expectGaussianCoverage(focalErrors(0.3, 0.15, random), true);
  expectGaussianCoverage(focalErrors(0.05, 0.3, random), true);
}

/// The case with a camera whose focal length is stated wrong by this factor.
Case withFocalFactor(Case scene, double factor) {
  scene.camera.fx *= factor;
  scene.camera.fy *= factor;
  EXPECT_EQ(prepareCamera(scene.camera), Status::kOk);
  return scene;
}

TEST(FocalFit, RightCamera_IsConfirmed) {
  for (const bool distorted : {false, true}) {
    const FocalFit fit = fitAfterRefining(stationCase(1, distorted));
    ASSERT_TRUE(fit.determined);
    EXPECT_LT(fit.magnitude(), FocalFit::kSigmas * fit.sigma);
    EXPECT_FALSE(fit.disagrees());
  }
}

TEST(FocalFit, FocalLengthStatedWrong_IsMeasuredAndDisagrees) {
  for (const double factor : {0.96, 1.04}) {
    const FocalFit fit = fitAfterRefining(withFocalFactor(stationCase(1), factor));
    ASSERT_TRUE(fit.determined);
    EXPECT_NEAR(fit.change, 1.0 / factor - 1.0, 0.02) << fit.sigma;
    EXPECT_TRUE(fit.disagrees()) << fit.change << " " << fit.sigma;
  }
}

TEST(FocalFit, PlateSeenFromTheFront_DoesNotDetermineTheFocalLength) {
  Case scene = stationCase(1);
  scene.solid = Solid();
  scene.solid.addBox(0.0, 0.0, 0.06, 0.05, 0.3, 0.0, 0.001, 0.6);
  scene.truth = {Eigen::Quaterniond(0.0, 1.0, 0.0, 0.0), {0.0, 0.0, 0.45}};
  const Picture picture = takePicture(scene.solid, scene.camera, scene.truth);
  scene.picture = &picture;
  const FocalFit fit = fitAfterRefining(withFocalFactor(scene, 1.04));
  EXPECT_FALSE(fit.disagrees()) << fit.change << " " << fit.sigma;
}

TEST(FocalFit, Disagrees_OnlyBeyondEveryLimit) {
  const auto disagrees = [](bool determined, double change, double sigma) {
    FocalFit fit;
    fit.determined = determined;
    fit.change = change;
    fit.sigma = sigma;
    return fit.disagrees();
  };
  EXPECT_FALSE(disagrees(false, -0.02, 0.002));
  EXPECT_TRUE(disagrees(true, -0.02, 0.002));
  EXPECT_FALSE(disagrees(true, -0.02, 0.006));   // 3.3 sigma
  EXPECT_FALSE(disagrees(true, 0.2, 0.02));      // the image determines it too weakly
  EXPECT_FALSE(disagrees(true, 0.003, 0.0001));  // right cameras have as much
}

}  // namespace
}  // namespace boresight::test
