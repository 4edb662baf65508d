// SPDX-License-Identifier: Apache-2.0
#include "core/edges/gaussian.h"

#include <gtest/gtest.h>

#include <cmath>
#include <numeric>
#include <opencv2/imgproc.hpp>

#include "tests/core/edges/opencv_images.h"

namespace boresight {
namespace {

constexpr double kSigmas_px[] = {0.1, 0.3, 0.5, 0.8, 1.0, 1.5, 2.0, 2.7, 3.3, 4.0, 8.0};

TestImage blurred(const TestImage& image, double sigma_px) {
  TestImage out = blankImage(image.width, image.height);
  TestArena arena;
  EXPECT_EQ(gaussianBlur(image.view(), sigma_px, *arena, out.pixels.data(), out.width),
            Status::kOk);
  EXPECT_EQ((*arena).used(), 0U);
  return out;
}

TEST(GaussianKernel, SumsTo256AndFallsOff) {
  for (double sigma_px = 0.0; sigma_px <= 8.0; sigma_px += 0.01) {
    const GaussianKernel kernel = gaussianKernel(sigma_px);
    ASSERT_LE(kernel.radius, kMaxGaussianRadius);
    EXPECT_EQ(kernel.radius, sigma_px > 0.0 ? (cvRound(6.0 * sigma_px + 1.0) | 1) / 2 : 0);
    int sum = kernel.weight[0];
    for (std::size_t i = 1; i < kernel.weight.size(); ++i) {
      sum += 2 * kernel.weight[i];
      // Carrying the rounding error may lift a weight by one above its inner neighbour.
      EXPECT_LE(kernel.weight[i], kernel.weight[i - 1] + 1) << sigma_px;
      if (static_cast<int>(i) > kernel.radius) {
        EXPECT_EQ(kernel.weight[i], 0);
      }
    }
    EXPECT_EQ(sum, 256);
  }
}

TEST(GaussianKernel, IsWithinOne256thOfTheExactOne) {
  for (double sigma_px = 0.5; sigma_px <= 8.0; sigma_px += 0.1) {
    const GaussianKernel kernel = gaussianKernel(sigma_px);
    const cv::Mat exact = cv::getGaussianKernel(2 * kernel.radius + 1, sigma_px, CV_64F);
    for (int i = 0; i <= kernel.radius; ++i)
      EXPECT_NEAR(kernel.weight[static_cast<std::size_t>(i)],
                  256.0 * exact.at<double>(kernel.radius + i), 1.0)
          << sigma_px;
  }
}

TEST(GaussianBlur, EqualsOpenCv) {
  Random random(11);
  for (const double sigma_px : kSigmas_px) {
    for (const Size size : kSizes) {
      for (const Pattern pattern : {Pattern::kNoise, Pattern::kDisks, Pattern::kCheckers}) {
        TestImage image = makeImage(pattern, size, random);
        cv::Mat expected;
        cv::GaussianBlur(asMat(image), expected, cv::Size(), sigma_px, sigma_px,
                         cv::BORDER_REFLECT_101);
        TestImage actual = blurred(image, sigma_px);
        // One gray level is what other versions of OpenCV (and its vendors' variants) may differ.
        EXPECT_LE(cv::norm(asMat(actual), expected, cv::NORM_INF), 1.0)
            << sigma_px << " " << testing::PrintToString(size);
        if (cv::getVersionMajor() == 4 && cv::getVersionMinor() == 6) {
          EXPECT_EQ(countDifferent(asMat(actual), expected), 0)
              << sigma_px << " " << testing::PrintToString(size);
        }
      }
    }
  }
}

/// Against floating point: rounding of the weights is all that may differ.
TEST(GaussianBlur, IsWithinOneGrayLevelOfTheExactGaussianOnStructure) {
  Random random(12);
  for (const double sigma_px : {0.5, 1.0, 1.5, 2.0, 3.0, 4.0}) {
    for (const Pattern pattern : {Pattern::kDisks, Pattern::kRamp, Pattern::kBlocks}) {
      TestImage image = makeImage(pattern, {200, 150}, random);
      const int side = 2 * gaussianKernel(sigma_px).radius + 1;
      cv::Mat exact;
      asMat(image).convertTo(exact, CV_64F);
      cv::GaussianBlur(exact, exact, cv::Size(side, side), sigma_px, sigma_px,
                       cv::BORDER_REFLECT_101);
      TestImage actual = blurred(image, sigma_px);
      cv::Mat difference;
      asMat(actual).convertTo(difference, CV_64F);
      difference -= exact;
      EXPECT_LE(cv::norm(difference, cv::NORM_INF), 1.5) << sigma_px;
      EXPECT_LE(std::abs(cv::mean(difference)[0]), 0.1) << sigma_px;
    }
  }
}

TEST(GaussianBlur, SigmaZeroCopies) {
  Random random(13);
  const TestImage image = makeImage(Pattern::kNoise, {77, 31}, random);
  EXPECT_EQ(blurred(image, 0.0), image);
}

TEST(GaussianBlur, KeepsAConstantImage) {
  Random random(14);
  for (const double sigma_px : kSigmas_px) {
    const TestImage image = makeImage(Pattern::kConstant, {40, 9}, random);
    EXPECT_EQ(blurred(image, sigma_px), image) << sigma_px;
  }
  TestImage white = blankImage(70, 70);
  for (std::uint8_t& pixel : white.pixels) pixel = 255;
  EXPECT_EQ(blurred(white, 8.0), white);
}

TEST(GaussianBlur, RefusesWhatIsOutOfRange) {
  TestArena arena;
  TestImage image = blankImage(4, 4);
  for (const double sigma_px : {-0.1, 8.1, std::nan("")})
    EXPECT_EQ(gaussianBlur(image.view(), sigma_px, *arena, image.pixels.data(), 4),
              Status::kInvalidOption);
  EXPECT_EQ(gaussianBlur(ImageView{}, 1.0, *arena, image.pixels.data(), 4), Status::kInvalidImage);
  TestArena small(200);
  EXPECT_EQ(gaussianBlur(image.view(), 1.0, *small, image.pixels.data(), 4),
            Status::kArenaTooSmall);
}

}  // namespace
}  // namespace boresight
