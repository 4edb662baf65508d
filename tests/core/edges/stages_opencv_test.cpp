// SPDX-License-Identifier: Apache-2.0
#include "core/edges/gaussian.h"

#include <gtest/gtest.h>

#include <cmath>
#include <opencv2/imgproc.hpp>

#include "core/edges/edge_map.h"
#include "tests/core/edges/opencv_images.h"

namespace boresight {
namespace {

constexpr double kSigmas_px[] = {0.1, 0.3, 0.5, 0.8, 1.0, 1.5, 2.0, 2.7, 3.3, 4.0, 8.0};

TEST(GaussianKernel, SumsTo256FallsOffAndIsWithinOne256thOfTheExactOne) {
  int step = 0;
  for (double sigma_px = 0.0; sigma_px <= 8.0; sigma_px += 0.01) {
    SCOPED_TRACE(sigma_px);
    const GaussianKernel kernel = gaussianKernel(sigma_px);
    ASSERT_LE(kernel.radius, kMaxGaussianRadius);
    EXPECT_EQ(kernel.radius, sigma_px > 0.0 ? (cvRound(6.0 * sigma_px + 1.0) | 1) / 2 : 0);
    int sum = kernel.weight[0];
    for (std::size_t i = 1; i < kernel.weight.size(); ++i) {
      sum += 2 * kernel.weight[i];
      // Carrying the rounding error may lift a weight by one above its inner neighbour.
      EXPECT_LE(kernel.weight[i], kernel.weight[i - 1] + 1);
      EXPECT_TRUE(kernel.weight[i] == 0 || static_cast<int>(i) <= kernel.radius);
    }
    EXPECT_EQ(sum, 256);
    if (++step <= 50 || step % 10 != 1) continue;
    const cv::Mat exact = cv::getGaussianKernel(2 * kernel.radius + 1, sigma_px, CV_64F);
    for (int i = 0; i <= kernel.radius; ++i)
      EXPECT_NEAR(kernel.weight[static_cast<std::size_t>(i)],
                  256.0 * exact.at<double>(kernel.radius + i), 1.0);
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
        // One gray level is what other versions of OpenCV (and its vendors' variants) may differ.
        const bool same_version = cv::getVersionMajor() == 4 && cv::getVersionMinor() == 6;
        EXPECT_LE(cv::norm(smoothedByCore(image.view(), sigma_px), expected, cv::NORM_INF),
                  same_version ? 0.0 : 1.0)
            << sigma_px << " " << testing::PrintToString(size);
      }
    }
  }
}

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
  EdgeOptions options;
  options.equalization = Equalization::kOff;
  options.gaussian_sigma_px = 0.0;
  options.thresholds = CannyThresholds::kAbsolute;
  options.low_threshold = thresholds.low;
  options.high_threshold = thresholds.high;
  EdgeMap map;
  if (detectEdges(image.view(), nullptr, options, *arena, map) != Status::kOk) return -1;
  cv::Mat expected;
  cv::Canny(asMat(image), expected, thresholds.low, thresholds.high, 3, true);
  return countDifferent(unpack(map.level[0]), expected);
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
    const auto [dx, dy] = sobelByOpenCv(asMat(image));
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

TEST(EqualizeImage, EqualsOpenCv) {
  Random random(1);
  for (const Equalization equalization : {Equalization::kHistogram, Equalization::kClahe}) {
    for (const Size size : kSizes) {
      for (const Pattern pattern : kPatterns) {
        TestImage image = makeImage(pattern, size, random);
        EXPECT_EQ(countDifferent(equalizedByCore(image.view(), nullptr, equalization),
                                 equalizedByOpenCv(asMat(image), equalization)),
                  0)
            << testing::PrintToString(size) << " pattern " << static_cast<int>(pattern);
      }
    }
  }
}

TEST(EqualizeImage, OnlyUnignoredPixelsShapeTheTable) {
  Random random(3);
  for (int round = 0; round < 10; ++round) {
    TestImage image = makeImage(Pattern::kDisks, {150, 90}, random);
    TestBits ignore(image.width, image.height);
    ignoreRectangles(*ignore, random);
    scramble(image, *ignore, random);
    std::vector<std::uint8_t> kept;
    for (int y = 0; y < image.height; ++y)
      for (int x = 0; x < image.width; ++x)
        if (!ignore->get(x, y)) kept.push_back(image.at(x, y));
    cv::Mat expected;
    cv::equalizeHist(cv::Mat(1, static_cast<int>(kept.size()), CV_8UC1, kept.data()), expected);
    const cv::Mat actual = equalizedByCore(image.view(), &*ignore, Equalization::kHistogram);
    int next = 0;
    int different = 0;
    for (int y = 0; y < image.height; ++y)
      for (int x = 0; x < image.width; ++x)
        if (!ignore->get(x, y) &&
            actual.at<std::uint8_t>(y, x) != expected.at<std::uint8_t>(0, next++))
          ++different;
    EXPECT_EQ(different, 0);
  }
}

TEST(EqualizeImage, IgnoredPixels_DoNotAffectTheTiles) {
  Random random(5);
  TestImage image = makeImage(Pattern::kDisks, {131, 119}, random);
  TestBits ignore(image.width, image.height);
  ignoreRectangles(*ignore, random);
  TestImage other = image;
  scramble(other, *ignore, random);
  ASSERT_NE(image, other);
  cv::Mat first = equalizedByCore(image.view(), &*ignore, Equalization::kClahe);
  cv::Mat second = equalizedByCore(other.view(), &*ignore, Equalization::kClahe);
  first.setTo(0, unpack(*ignore));
  second.setTo(0, unpack(*ignore));
  EXPECT_EQ(countDifferent(first, second), 0);
}

TEST(EqualizeImage, EverythingIgnored_LeavesTheImageUnchanged) {
  Random random(6);
  TestImage image = makeImage(Pattern::kNoise, {70, 20}, random);
  TestBits ignore(image.width, image.height);
  fillAtRandom(*ignore, 1, random);
  for (const Equalization equalization :
       {Equalization::kOff, Equalization::kHistogram, Equalization::kClahe})
    EXPECT_EQ(countDifferent(equalizedByCore(image.view(), &*ignore, equalization), asMat(image)),
              0);
}

TEST(EqualizeImage, RowsMayBeFartherApartThanTheirWidth) {
  Random random(7);
  TestImage wide = makeImage(Pattern::kNoise, {90, 33}, random);
  const cv::Mat window = asMat(wide).colRange(5, 76);
  EXPECT_EQ(
      countDifferent(equalizedByCore(asView(window), nullptr, Equalization::kHistogram),
                     equalizedByCore(asView(window.clone()), nullptr, Equalization::kHistogram)),
      0);
}

}  // namespace
}  // namespace boresight
