// SPDX-License-Identifier: Apache-2.0
#include "sessions/run/image_quality.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <vector>

#include "core/base/random.h"
#include "tests/support/example_case.h"
#include "tests/support/random_pose.h"

namespace boresight::sessions {
namespace {

constexpr int kSize = 200;
const PixelRegion kAll{Eigen::Vector2i(0, 0), Eigen::Vector2i(kSize - 1, kSize - 1)};

/// Stripes 40 px wide of two gray levels, with ramps `ramp_px` long between them, and noise.
struct Chart {
  std::vector<std::uint8_t> pixels;

  Chart(double dark, double bright, double ramp_px, double noise_gray) : pixels(kSize * kSize) {
    Random random = test::randomFor("image quality");
    for (int y = 0; y < kSize; ++y)
      for (int x = 0; x < kSize; ++x) {
        const double within = std::abs(std::fmod(x, 80.0) - 40.0) - 20.0;  // 0 on a border
        const double share = std::clamp(0.5 + within / ramp_px, 0.0, 1.0);
        const double gray = dark + (bright - dark) * share + noise_gray * random.normal();
        pixels[static_cast<std::size_t>(y * kSize + x)] =
            static_cast<std::uint8_t>(std::clamp(std::round(gray), 0.0, 255.0));
      }
  }
  ImageView view() const { return {pixels.data(), kSize, kSize, kSize}; }
  ImageQuality quality(const PixelRegion& region = kAll) const {
    return measureImageQuality(view(), nullptr, region).value();
  }
};

TEST(ImageQuality, NoiseOfKnownSigma_IsMeasuredDespiteEdges) {
  for (const double sigma : {2.0, 5.0, 15.0})
    EXPECT_NEAR(Chart(80, 160, 3.0, sigma).quality().noise_gray, sigma, 0.1 * sigma);
  EXPECT_LT(Chart(80, 160, 3.0, 0.0).quality().noise_gray, 0.1);
}

TEST(ImageQuality, ContrastOfTwoLevels_IsHalfTheirDifferenceAndClippedPixelsCountAsShares) {
  Chart chart(60, 180, 1.0, 0.0);
  EXPECT_NEAR(chart.quality().contrast_gray, 60.0, 1.5);
  EXPECT_EQ(chart.quality().range_gray, 120.0);
  EXPECT_FALSE(measureImageQuality(chart.view(), nullptr,
                                   {Eigen::Vector2i(300, 300), Eigen::Vector2i(400, 400)}));
  EXPECT_FALSE(measureImageQuality(chart.view(), nullptr, {}));
  std::fill_n(chart.pixels.begin(), 10 * kSize, 0);
  std::fill_n(chart.pixels.begin() + 10 * kSize, 10 * kSize, 255);
  EXPECT_DOUBLE_EQ(chart.quality().black_share, 0.05);
  EXPECT_DOUBLE_EQ(chart.quality().saturated_share, 0.05);
  EXPECT_EQ(chart.quality({Eigen::Vector2i(0, 20), kAll.max()}).saturated_share, 0.0);
}

TEST(ImageQuality, EdgeWidth_GrowsWithTheRamp) {
  EXPECT_NEAR(Chart(40, 200, 4.0, 0.0).quality().edge_width_px, 4.0, 1.0);
  EXPECT_NEAR(Chart(40, 200, 12.0, 0.0).quality().edge_width_px, 12.0, 2.0);
}

TEST(StationRegion, HoldsTheProjectionOfEveryVertexInTheImage) {
  const LocalizationProblem problem = test::osExample().problem();
  const PixelRegion region =
      stationRegion(problem.camera, problem.mesh, problem.camera_from_station_seed);
  EXPECT_LT(region.min().x(), region.max().x());
  for (const Eigen::Vector3f& vertex : problem.mesh.vertices_in_station_m) {
    Eigen::Vector2d pixel;
    ASSERT_TRUE(
        project(problem.camera, problem.camera_from_station_seed * vertex.cast<double>(), pixel));
    const Eigen::Vector2d seen = pixel.cwiseMax(0.0).cwiseMin(
        Eigen::Vector2d(problem.camera.width - 1, problem.camera.height - 1));
    EXPECT_GE(seen.x(), region.min().x());
    EXPECT_LE(seen.x(), region.max().x());
    EXPECT_GE(seen.y(), region.min().y());
    EXPECT_LE(seen.y(), region.max().y());
  }
}

}  // namespace
}  // namespace boresight::sessions
