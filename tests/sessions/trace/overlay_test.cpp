// SPDX-License-Identifier: Apache-2.0
#include "sessions/trace/overlay.h"

#include <gtest/gtest.h>

#include <cmath>
#include <vector>

#include "sessions/io/images/image_file.h"
#include "tests/support/random_pose.h"
#include "tests/support/temporary_folder.h"

namespace boresight::sessions {
namespace {

constexpr int kWidth = 600;
constexpr int kHeight = 400;
constexpr std::uint8_t kGray = 90;

/// A square of side 0.2 m in front of a camera that sees it 200 px wide in the image's middle.
class Overlay : public testing::Test {
 protected:
  ColorImage draw(const std::vector<OverlayLayer>& layers) const {
    return drawOverlay({pixels_.data(), kWidth, kHeight, kWidth}, camera_,
                       {vertices_, faces_, part_of_face_, parts_}, layers);
  }
  static ColorBgr at(const ColorImage& image, int x, int y) {
    const auto first = 3 * static_cast<std::size_t>(y * image.width + x);
    return {image.bgr[first], image.bgr[first + 1], image.bgr[first + 2]};
  }
  /// Columns of row 250, below the legend, that have the colour.
  static std::vector<int> columnsOf(const ColorImage& image, const ColorBgr& color) {
    std::vector<int> columns;
    for (int x = 0; x < image.width; ++x)
      if (at(image, x, 250) == color) columns.push_back(x);
    return columns;
  }
  static Pose shifted(double x_m, double z_m = 1.0) {
    return {Eigen::Quaterniond::Identity(), {x_m, 0.0, z_m}};
  }

  const Camera camera_ = test::makePinhole(kWidth, kHeight, 1000.0);
  const std::vector<std::uint8_t> pixels_ = std::vector<std::uint8_t>(kWidth * kHeight, kGray);
  const std::vector<Eigen::Vector3f> vertices_ = {
      {-0.1F, -0.1F, 0.0F}, {0.1F, -0.1F, 0.0F}, {0.1F, 0.1F, 0.0F}, {-0.1F, 0.1F, 0.0F}};
  const std::vector<Face> faces_ = {{{0, 2, 1}}, {{0, 3, 2}}};
  const std::vector<std::uint16_t> part_of_face_ = {0, 0};
  const std::vector<ScenePart> parts_ = std::vector<ScenePart>(1);
};

TEST_F(Overlay, DrawsEachPoseInItsColour) {
  const ColorImage image =
      draw({{"seed", shifted(0.05), kSeedColor}, {"result", shifted(0.0), kResultColor}});
  ASSERT_EQ(image.width, kWidth);
  ASSERT_EQ(image.height, kHeight);
  // Row 250 crosses the upright sides: of the result at 299.5 +- 100, of the seed 50 px further.
  const std::vector<int> result = columnsOf(image, kResultColor);
  const std::vector<int> seed = columnsOf(image, kSeedColor);
  ASSERT_FALSE(result.empty());
  ASSERT_FALSE(seed.empty());
  EXPECT_NEAR(result.front(), 199.5, 2.0);
  EXPECT_NEAR(result.back(), 399.5, 2.0);
  EXPECT_NEAR(seed.front(), 249.5, 2.0);
  EXPECT_NEAR(seed.back(), 449.5, 2.0);
  EXPECT_EQ(at(image, 300, 250), (ColorBgr{kGray, kGray, kGray}));
}

TEST_F(Overlay, ThinLayer_LeavesTheLayerBelowVisible) {
  const ColorImage image =
      draw({{"result", shifted(0.0), kResultColor}, {"truth", shifted(0.0), kTruthColor, true}});
  const std::vector<int> truth = columnsOf(image, kTruthColor);
  const std::vector<int> result = columnsOf(image, kResultColor);
  ASSERT_FALSE(truth.empty());
  ASSERT_FALSE(result.empty());
  EXPECT_EQ(result.front(), truth.front() - 1);
  EXPECT_EQ(result.back(), truth.back() + 1);
}

TEST_F(Overlay, HasALegendOnlyWithLayersAndIsWrittenAsItIs) {
  const ColorImage plain = draw({});
  for (const std::uint8_t value : plain.bgr) ASSERT_EQ(value, kGray);
  const ColorImage image = draw({{"seed", shifted(0.0), kSeedColor}});
  int bright = 0;
  for (int y = 0; y < 60; ++y)
    for (int x = 0; x < 150; ++x) bright += at(image, x, y)[0] > kGray + 60 ? 1 : 0;
  EXPECT_GT(bright, 20);
  const test::TemporaryFolder folder;
  writeColorPng(folder / "overlay.png", image);
  const GrayImage read = readImage(folder / "overlay.png");
  EXPECT_EQ(read.width, kWidth);
  EXPECT_EQ(read.height, kHeight);
  EXPECT_EQ(read.channels, 3);
  EXPECT_EQ(read.color, image.bgr);
}

TEST_F(Overlay, LeavesOutWhatCannotBeRendered) {
  const ColorImage image = draw({{"behind", shifted(0.0, -1.0), kSeedColor}});
  EXPECT_TRUE(columnsOf(image, kSeedColor).empty());
}

}  // namespace
}  // namespace boresight::sessions
