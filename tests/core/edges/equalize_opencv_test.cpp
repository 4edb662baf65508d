// SPDX-License-Identifier: Apache-2.0
#include "core/edges/equalize.h"

#include <gtest/gtest.h>

#include <opencv2/imgproc.hpp>

#include "tests/core/edges/opencv_images.h"

namespace boresight {
namespace {

TestImage equalized(const TestImage& image, const BitImage* ignore, const EdgeOptions& options) {
  TestImage out = blankImage(image.width, image.height);
  TestArena arena(std::size_t{1} << 18);
  EXPECT_EQ(equalizeImage(image.view(), ignore, options, *arena, out.pixels.data(), out.width),
            Status::kOk);
  EXPECT_EQ((*arena).used(), 0U);
  return out;
}

TEST(EqualizeImage, EqualsEqualizeHist) {
  Random random(1);
  EdgeOptions options;
  options.equalization = Equalization::kHistogram;
  for (const Size size : kSizes) {
    for (const Pattern pattern : kPatterns) {
      TestImage image = makeImage(pattern, size, random);
      cv::Mat expected;
      cv::equalizeHist(asMat(image), expected);
      TestImage actual = equalized(image, nullptr, options);
      EXPECT_EQ(countDifferent(asMat(actual), expected), 0)
          << testing::PrintToString(size) << " pattern " << static_cast<int>(pattern);
    }
  }
}

TEST(EqualizeImage, EqualsClahe) {
  Random random(2);
  EdgeOptions options;
  options.equalization = Equalization::kClahe;
  for (const Size size : kSizes) {
    for (const Pattern pattern : kPatterns) {
      TestImage image = makeImage(pattern, size, random);
      cv::Mat expected;
      cv::createCLAHE(Equalizer::kClipLimit, cv::Size(Equalizer::kTiles, Equalizer::kTiles))
          ->apply(asMat(image), expected);
      TestImage actual = equalized(image, nullptr, options);
      EXPECT_EQ(countDifferent(asMat(actual), expected), 0)
          << testing::PrintToString(size) << " pattern " << static_cast<int>(pattern);
    }
  }
}

TEST(EqualizeImage, OnlyUnignoredPixelsShapeTheTable) {
  Random random(3);
  EdgeOptions options;
  for (int round = 0; round < 10; ++round) {
    TestImage image = makeImage(Pattern::kDisks, {150, 90}, random);
    TestBits ignore(image.width, image.height);
    ignoreRectangles(*ignore, random);
    std::vector<std::uint8_t> kept;
    for (int y = 0; y < image.height; ++y) {
      for (int x = 0; x < image.width; ++x) {
        if (ignore->get(x, y)) {
          image.at(x, y) = static_cast<std::uint8_t>(random.below(256));
        } else {
          kept.push_back(image.at(x, y));
        }
      }
    }
    cv::Mat expected;
    cv::equalizeHist(cv::Mat(1, static_cast<int>(kept.size()), CV_8UC1, kept.data()), expected);
    TestImage actual = equalized(image, &*ignore, options);
    int next = 0;
    int different = 0;
    for (int y = 0; y < image.height; ++y)
      for (int x = 0; x < image.width; ++x)
        if (!ignore->get(x, y) && actual.at(x, y) != expected.at<std::uint8_t>(0, next++))
          ++different;
    EXPECT_EQ(different, 0);
  }
}

TEST(EqualizeImage, AnEmptyIgnoreMaskChangesNothing) {
  Random random(4);
  EdgeOptions options;
  for (const Equalization equalization : {Equalization::kHistogram, Equalization::kClahe}) {
    options.equalization = equalization;
    for (const Size size : kSizes) {
      const TestImage image = makeImage(Pattern::kDisks, size, random);
      TestBits ignore(size.width, size.height);
      EXPECT_EQ(equalized(image, &*ignore, options), equalized(image, nullptr, options));
    }
  }
}

TEST(EqualizeImage, TilesDoNotSeeIgnoredPixels) {
  Random random(5);
  EdgeOptions options;
  options.equalization = Equalization::kClahe;
  TestImage image = makeImage(Pattern::kDisks, {131, 119}, random);
  TestBits ignore(image.width, image.height);
  ignoreRectangles(*ignore, random);
  TestImage other = image;
  for (int y = 0; y < image.height; ++y)
    for (int x = 0; x < image.width; ++x)
      if (ignore->get(x, y)) other.at(x, y) = static_cast<std::uint8_t>(random.below(256));
  TestImage first = equalized(image, &*ignore, options);
  TestImage second = equalized(other, &*ignore, options);
  ASSERT_NE(image, other);
  int different = 0;
  for (int y = 0; y < image.height; ++y)
    for (int x = 0; x < image.width; ++x)
      if (!ignore->get(x, y) && first.at(x, y) != second.at(x, y)) ++different;
  EXPECT_EQ(different, 0);
}

TEST(EqualizeImage, EverythingIgnoredLeavesTheImageAsItIs) {
  Random random(6);
  EdgeOptions options;
  const TestImage image = makeImage(Pattern::kNoise, {70, 20}, random);
  TestBits ignore(image.width, image.height);
  fillAtRandom(*ignore, 1, random);
  for (const Equalization equalization :
       {Equalization::kOff, Equalization::kHistogram, Equalization::kClahe}) {
    options.equalization = equalization;
    EXPECT_EQ(equalized(image, &*ignore, options), image);
  }
}

TEST(EqualizeImage, RowsMayBeFartherApartThanTheirWidth) {
  Random random(7);
  const TestImage wide = makeImage(Pattern::kNoise, {90, 33}, random);
  TestImage narrow = blankImage(71, 33);
  for (int y = 0; y < narrow.height; ++y)
    for (int x = 0; x < narrow.width; ++x) narrow.at(x, y) = wide.view().at(x + 5, y);
  ImageView window = wide.view();
  window.data += 5;
  window.width = narrow.width;
  EdgeOptions options;
  TestArena arena;
  TestImage out = blankImage(80, 33);
  ASSERT_EQ(equalizeImage(window, nullptr, options, *arena, out.pixels.data(), out.width),
            Status::kOk);
  TestImage expected = equalized(narrow, nullptr, options);
  for (int y = 0; y < narrow.height; ++y)
    for (int x = 0; x < narrow.width; ++x) ASSERT_EQ(out.at(x, y), expected.at(x, y));
}

}  // namespace
}  // namespace boresight
