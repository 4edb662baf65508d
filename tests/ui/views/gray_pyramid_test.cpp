// SPDX-License-Identifier: Apache-2.0
#include "ui/views/image_pyramids.h"

#include <gtest/gtest.h>

#include <vector>

namespace boresight::ui {
namespace {

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
}

TEST(GrayPyramid, MeansFourPixels) {
  QImage gray(2, 2, QImage::Format_Grayscale8);
  gray.scanLine(0)[0] = 10;
  gray.scanLine(0)[1] = 20;
  gray.scanLine(1)[0] = 30;
  gray.scanLine(1)[1] = 41;
  int step = 0;
  EXPECT_EQ(GrayPyramid(gray).at(2.0, step).constScanLine(0)[0], 25);
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
    for (int y = 0; y < picture.height(); ++y) {
      int set = 0;
      for (int x = 0; x < picture.width(); ++x) {
        if (qAlpha(picture.pixel(x, y)) == 0) continue;
        ++set;
        EXPECT_EQ(x, 37 >> step);
        EXPECT_EQ(QColor(picture.pixel(x, y)), QColor(10, 200, 30));
      }
      EXPECT_EQ(set, 1);
    }
  }
}

}  // namespace
}  // namespace boresight::ui
