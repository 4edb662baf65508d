// SPDX-License-Identifier: Apache-2.0
#include "ui/views/view_transform.h"

#include <algorithm>
#include <cmath>
#include <numeric>
#include <vector>

#include <gtest/gtest.h>

#include "core/base/random.h"
#include "ui/views/display_image.h"

namespace boresight::ui {
namespace {

using sessions::GrayLevels;
using sessions::ImageSamples;

double distance(const QPointF& a, const QPointF& b) {
  return std::hypot(a.x() - b.x(), a.y() - b.y());
}

TEST(ViewTransform, PixelsComeBack) {
  Random random(7);
  const auto place = [&random] { return random.uniform(-3000.0, 3000.0); };
  for (int i = 0; i < 1000; ++i) {
    ViewTransform transform;
    transform.zoomAt({place(), place()}, std::exp(place() / 1000.0));
    transform.pan({place(), place()});
    const QPointF pixel(place(), place());
    EXPECT_LT(distance(transform.toPixel(transform.toWidget(pixel)), pixel), 1e-6);
  }
}

TEST(ViewTransform, FitsTheWholeImageIntoTheMiddle) {
  ViewTransform transform;
  transform.fit({2048.0, 1024.0}, {512.0, 512.0});
  EXPECT_DOUBLE_EQ(transform.scale(), 0.25);
  const QRectF all = transform.toWidget(QRectF(-0.5, -0.5, 2048.0, 1024.0));
  EXPECT_LT(distance(all.topLeft(), {0.0, 128.0}), 1e-9);
  EXPECT_LT(distance(all.bottomRight(), {512.0, 384.0}), 1e-9);
  const ViewTransform before = transform;
  transform.fit({0.0, 0.0}, {100.0, 100.0});
  transform.fit({100.0, 100.0}, {0.0, 10.0});
  EXPECT_EQ(transform, before) << "an empty image or widget changes nothing";
}

TEST(ViewTransform, ZoomingKeepsThePixelUnderTheCursor) {
  ViewTransform transform;
  transform.fit({2048.0, 2048.0}, {700.0, 500.0});
  const QPointF cursor(123.0, 456.0);
  const QPointF pixel = transform.toPixel(cursor);
  for (const double scale : {0.5, 3.0, 64.0, 1e9, 1e-9}) {
    transform.zoomAt(cursor, scale);
    EXPECT_LT(distance(transform.toPixel(cursor), pixel), 1e-6);
    EXPECT_LE(transform.scale(), ViewTransform::kMaxScale);
    EXPECT_GE(transform.scale(), ViewTransform::kMinScale);
  }
}

TEST(GrayPyramid, TakesTheCoarsestPictureThatStillHasEveryScreenPixel) {
  QImage gray(33, 17, QImage::Format_Grayscale8);
  gray.fill(100);
  const GrayPyramid pyramid(gray);
  int step = -1;
  EXPECT_EQ(pyramid.at(0.5, step).size(), QSize(33, 17));
  EXPECT_EQ(step, 0);
  EXPECT_EQ(pyramid.at(1.99, step).width(), 33);
  EXPECT_EQ(pyramid.at(2.0, step).size(), QSize(17, 9));
  EXPECT_EQ(step, 1);
  EXPECT_EQ(pyramid.at(7.9, step).size(), QSize(9, 5));
  EXPECT_EQ(step, 2);
  EXPECT_EQ(pyramid.at(7.9, step).constScanLine(4)[8], 100);
  const uchar grays[] = {10, 20, 30, 41};
  const GrayPyramid of_four(QImage(grays, 2, 2, 2, QImage::Format_Grayscale8));
  EXPECT_EQ(of_four.at(2.0, step).constScanLine(0)[0], 25) << "it means four pixels";
}

TEST(BitPixmaps, ALineStaysALineAtEveryStep) {
  std::vector<std::uint64_t> words(100 * 2, 0);
  BitImage bits;
  bits.words = words;
  bits.width = 100;
  bits.height = 100;
  bits.words_per_row = BitImage::wordsPerRow(100);
  for (int y = 0; y < 100; ++y) bits.set(37, y);
  BitPixmaps pixmaps(bits, QColor(10, 200, 30));
  for (const double factor : {1.0, 2.0, 4.0, 8.0, 16.0}) {
    int step = 0;
    const QImage& picture = pixmaps.at(factor, step);
    EXPECT_EQ(1 << step, static_cast<int>(factor));
    for (int y = 0; y < picture.height(); ++y)
      for (int x = 0; x < picture.width(); ++x) {
        const QRgb color = picture.pixel(x, y);
        EXPECT_EQ(qAlpha(color) != 0, x == 37 >> step);
        EXPECT_TRUE(qAlpha(color) == 0 || QColor(color) == QColor(10, 200, 30));
      }
  }
}

ImageSamples samplesOf(std::vector<std::uint16_t> values, int width, int bits) {
  ImageSamples samples;
  samples.width = width;
  samples.height = static_cast<int>(values.size()) / width;
  samples.sample_bits = bits;
  samples.values = std::move(values);
  return samples;
}

TEST(DisplayStretch, AutomaticLevelsClipAtMostTheirShareAtBothEnds) {
  Random random(7);
  std::vector<std::uint16_t> values(100 * 100);
  for (std::uint16_t& value : values)
    value = static_cast<std::uint16_t>(1000 + random.below(700) + random.below(700));
  values[17] = 0;
  values[18] = 65535;
  const ImageSamples samples = samplesOf(values, 100, 16);
  const GrayLevels levels = automaticLevels(samples);
  std::sort(values.begin(), values.end());
  EXPECT_EQ(levels.black, values[50]) << "as many as 50 of 10000 are darker";
  EXPECT_EQ(levels.white, values[values.size() - 51]);
}

TEST(DisplayStretch, AValueIsReadAsTheFileHasIt) {
  ImageSamples samples = samplesOf({0, 7, 4095, 65535, 1, 2}, 3, 16);
  EXPECT_EQ(sampleText(samples, 1, 0), QStringLiteral("7"));
  EXPECT_EQ(sampleText(samples, 0, 1), QStringLiteral("65535"));
  samples.offset = -0.5;
  samples.scale = 1.0 / 65535.0;
  EXPECT_EQ(sampleText(samples, 0, 0), QStringLiteral("-0.5"));
  EXPECT_EQ(sampleText(samples, 0, 1), QStringLiteral("0.5"));
}

TEST(DisplayStretch, AnEvenImageHasLevelsToo) {
  for (const auto value : std::vector<std::uint16_t>{0, 1, 77, 65534, 65535}) {
    const GrayLevels levels =
        automaticLevels(samplesOf(std::vector<std::uint16_t>(64, value), 8, 16));
    EXPECT_GE(levels.black, 0) << value;
    EXPECT_LT(levels.black, levels.white) << value;
    EXPECT_LE(levels.white, 65535) << value;
  }
}

TEST(DisplayStretch, DrawsBlackAndWhiteAtTheLevels_AllOfEightBitsUnchanged) {
  const ImageSamples samples = samplesOf({0, 100, 200, 300, 400, 65535}, 3, 16);
  const QImage image = stretched(samples, {100, 300});
  const int expected[] = {0, 0, 128, 255, 255, 255};
  for (int i = 0; i < 6; ++i) EXPECT_EQ(image.constScanLine(i / 3)[i % 3], expected[i]) << i;
  std::vector<std::uint16_t> values(256);
  std::iota(values.begin(), values.end(), std::uint16_t{0});
  const ImageSamples all = samplesOf(values, 16, 8);
  const QImage same = stretched(all, fullLevels(all));
  for (int i = 0; i < 256; ++i) EXPECT_EQ(same.constScanLine(i / 16)[i % 16], i);
}

}  // namespace
}  // namespace boresight::ui
