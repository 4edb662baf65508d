// SPDX-License-Identifier: Apache-2.0
#include "ui/panels/pixel_picture.h"

#include <vector>

#include <gtest/gtest.h>

#include "ui/plots/plot_colors.h"

namespace boresight::ui {
namespace {

/// A binary image from rows of text: '#' is set.
struct Bits {
  explicit Bits(const std::vector<const char*>& rows)
      : words(rows.size()), width(static_cast<int>(std::string(rows.front()).size())) {
    for (std::size_t y = 0; y < rows.size(); ++y)
      for (int x = 0; x < width; ++x)
        if (rows[y][x] == '#') words[y] |= std::uint64_t{1} << x;
  }
  BitImage view() { return {words, width, static_cast<int>(words.size()), 1}; }

  std::vector<std::uint64_t> words;
  int width;
};

Bits edges({"......", "..#...", "..#...", "......"});
Bits mask({".####.", ".####.", ".####.", "......"});
Bits seen({"......", "......", "...#..", "..##..", "......"});

TEST(PatchPictures, ShowEdgesOverMask) {
  const QImage picture = templatePicture(edges.view(), mask.view(), {2, 2, 4});
  ASSERT_EQ(picture.size(), QSize(4, 4));
  EXPECT_EQ(picture.pixel(2, 1), patch_colors::kEdge);
  EXPECT_EQ(picture.pixel(2, 2), patch_colors::kEdge);
  EXPECT_EQ(picture.pixel(1, 1), patch_colors::kMask);
  EXPECT_EQ(picture.pixel(0, 0), patch_colors::kGround);
  EXPECT_EQ(picture.pixel(1, 3), patch_colors::kGround);
}

TEST(PatchPictures, TellApartWhoSawWhat) {
  // The template's centre (2, 2) lies at (3, 3) of what was seen.
  const QImage picture =
      agreementPicture(edges.view(), mask.view(), {2, 2, 4}, seen.view(), {3, 3, 4});
  EXPECT_EQ(picture.pixel(2, 1), patch_colors::kEdge);
  EXPECT_EQ(picture.pixel(2, 2), patch_colors::kEdge);
  EXPECT_EQ(picture.pixel(1, 2), patch_colors::kOnlySeen);
  const QImage moved =
      agreementPicture(edges.view(), mask.view(), {2, 2, 4}, seen.view(), {3, 4, 4});
  EXPECT_EQ(moved.pixel(2, 2), patch_colors::kOnlyRendered);
}

TEST(PatchPictures, GroundLiesOutsideTheImage) {
  const QImage picture = seenPicture(seen.view(), {0, 0, 4});
  EXPECT_EQ(picture.pixel(0, 0), patch_colors::kGround);
  EXPECT_EQ(seenPicture(seen.view(), {3, 3, 4}).pixel(2, 1), patch_colors::kEdge);
}

TEST(PixelPlace, EnlargesByWholeDevicePixelsWhereItCan) {
  const QRectF place = pixelPlace({10, 10}, {0, 0, 47, 99}, 1.0);
  EXPECT_EQ(place.size(), QSizeF(40, 40));
  EXPECT_EQ(pixelPlace({10, 10}, {0, 0, 47, 99}, 2.0).size(), QSizeF(45, 45));
  EXPECT_EQ(pixelPlace({100, 10}, {0, 0, 50, 50}, 1.0), QRectF(0, 23, 50, 5));
}

TEST(HeatColors, GetLighterAllTheWay) {
  double before = -1.0;
  for (int i = 0; i <= 100; ++i) {
    const QRgb color = heatColor(0.01 * i).rgb();
    const double light = 0.2126 * qRed(color) + 0.7152 * qGreen(color) + 0.0722 * qBlue(color);
    EXPECT_GT(light, before) << i;
    before = light;
  }
  EXPECT_EQ(heatColor(-1.0), heatColor(0.0));
  EXPECT_EQ(heatColor(2.0), heatColor(1.0));
}

}  // namespace
}  // namespace boresight::ui
