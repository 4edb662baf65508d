// SPDX-License-Identifier: Apache-2.0
#include "ui/views/display_image.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

#include "core/base/random.h"

namespace boresight::ui {
namespace {

using sessions::GrayLevels;
using sessions::ImageSamples;

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
  for (const int value : {0, 1, 77, 65534, 65535}) {
    const auto v = static_cast<std::uint16_t>(value);
    const GrayLevels levels = automaticLevels(samplesOf(std::vector<std::uint16_t>(64, v), 8, 16));
    EXPECT_GE(levels.black, 0) << value;
    EXPECT_LT(levels.black, levels.white) << value;
    EXPECT_LE(levels.white, 65535) << value;
  }
}

TEST(DisplayStretch, DrawsBlackAndWhiteAtTheLevelsAndTheRestBetween) {
  const ImageSamples samples = samplesOf({0, 100, 200, 300, 400, 65535}, 3, 16);
  const QImage image = stretched(samples, {100, 300});
  const int expected[] = {0, 0, 128, 255, 255, 255};
  for (int i = 0; i < 6; ++i) EXPECT_EQ(image.constScanLine(i / 3)[i % 3], expected[i]) << i;
}

TEST(DisplayStretch, EightBitsInFullAreAsTheyAre) {
  std::vector<std::uint16_t> values(256);
  for (int i = 0; i < 256; ++i) values[static_cast<std::size_t>(i)] = static_cast<std::uint16_t>(i);
  const ImageSamples samples = samplesOf(values, 16, 8);
  const QImage image = stretched(samples, fullLevels(samples));
  for (int i = 0; i < 256; ++i) EXPECT_EQ(image.constScanLine(i / 16)[i % 16], i);
}

}  // namespace
}  // namespace boresight::ui
