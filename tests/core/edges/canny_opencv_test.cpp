// SPDX-License-Identifier: Apache-2.0
#include "core/edges/canny.h"

#include <gtest/gtest.h>

#include <opencv2/imgproc.hpp>

#include "tests/core/edges/opencv_images.h"

namespace boresight {
namespace {

struct Thresholds {
  double low;
  double high;
};

/// Thresholds that cut through the gradients, and odd ones: equal, in the wrong
/// order, zero, fractions, beyond every gradient.
constexpr Thresholds kThresholds[] = {{50, 150},   {20.7, 61.3},     {120, 40},
                                      {0, 0},      {100, 100},       {0, 900.5},
                                      {800, 2500}, {3000.2, 9000.9}, {9000, 40000}};

int edgesDifferent(TestImage& image, const Thresholds& thresholds) {
  TestArena arena(std::size_t{1} << 20);
  TestImage edges = blankImage(image.width, image.height);
  if (canny(image.view(), thresholds.low, thresholds.high, *arena, edges.pixels.data(),
            edges.width) != Status::kOk ||
      (*arena).used() != 0)
    return -1;
  cv::Mat expected;
  cv::Canny(asMat(image), expected, thresholds.low, thresholds.high, 3, true);
  return countDifferent(asMat(edges), expected);
}

TEST(Canny, EqualsOpenCv) {
  Random random(21);
  for (const Size size : kSizes) {
    for (const Pattern pattern : kPatterns) {
      TestImage image = makeImage(pattern, size, random);
      for (const Thresholds& thresholds : kThresholds)
        EXPECT_EQ(edgesDifferent(image, thresholds), 0)
            << testing::PrintToString(size) << " pattern " << static_cast<int>(pattern) << " low "
            << thresholds.low << " high " << thresholds.high;
    }
  }
}

/// Smoothed noise has long edges of every direction, and equal neighbours in numbers.
TEST(Canny, EqualsOpenCvOnSmoothedImages) {
  Random random(22);
  for (const double sigma_px : {0.8, 1.5, 3.0}) {
    for (const Pattern pattern : {Pattern::kNoise, Pattern::kDisks, Pattern::kSpecks}) {
      TestImage image = makeImage(pattern, {410, 305}, random);
      cv::Mat mat = asMat(image);
      cv::GaussianBlur(mat, mat, cv::Size(), sigma_px);
      cv::normalize(mat, mat, 0, 255, cv::NORM_MINMAX);
      for (const double high : {30.0, 90.0, 200.0})
        EXPECT_EQ(edgesDifferent(image, {0.4 * high, high}), 0)
            << sigma_px << " pattern " << static_cast<int>(pattern) << " high " << high;
    }
  }
}

TEST(CannyLimits, FollowTheUnitsOfTheGradient) {
  EXPECT_EQ(cannyLimits(1.5, 3.0).low, 2);
  EXPECT_EQ(cannyLimits(1.5, 3.0).high, 9);
  EXPECT_EQ(cannyLimits(0.0, 100000.0).high, 32767 * 32767);
  EXPECT_EQ(cannyLimits(90000.0, 100000.0).low, 32767 * 32767);
}

TEST(GradientRows, EqualsSobel) {
  Random random(23);
  for (const Size size : kSizes) {
    TestImage image = makeImage(Pattern::kNoise, size, random);
    cv::Mat dx;
    cv::Mat dy;
    cv::Sobel(asMat(image), dx, CV_16S, 1, 0, 3, 1.0, 0, cv::BORDER_REPLICATE);
    cv::Sobel(asMat(image), dy, CV_16S, 0, 1, 3, 1.0, 0, cv::BORDER_REPLICATE);
    TestArena arena;
    EdgeOptions options;
    options.equalization = Equalization::kOff;
    Equalizer source;
    source.begin(image.view(), nullptr, options, *arena);
    SmoothedRows smoothed;
    smoothed.begin(size.width, size.height, 0.0, *arena);
    GradientRows gradient;
    gradient.begin(size.width, size.height, *arena);
    int different = 0;
    for (int y = 0; y < size.height; ++y) {
      gradient.advance(source, smoothed);
      for (int x = 0; x < size.width; ++x) {
        const int gx = dx.at<short>(y, x);
        const int gy = dy.at<short>(y, x);
        if (gradient.dx(y)[x] != gx || gradient.dy(y)[x] != gy ||
            gradient.magnitude(y)[x] != gx * gx + gy * gy)
          ++different;
      }
    }
    EXPECT_EQ(different, 0) << testing::PrintToString(size);
  }
}

}  // namespace
}  // namespace boresight
