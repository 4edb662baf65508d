// SPDX-License-Identifier: Apache-2.0
#include "ui/views/display_stretch.h"

#include <algorithm>
#include <array>
#include <cstddef>

namespace boresight::ui {

using sessions::GrayLevels;
using sessions::ImageSamples;

GrayLevels fullLevels(const ImageSamples& samples) { return {0, (1 << samples.sample_bits) - 1}; }

GrayLevels automaticLevels(const ImageSamples& samples) {
  std::vector<std::size_t> histogram(std::size_t{1} << 16, 0);
  for (const std::uint16_t value : samples.values) ++histogram[value];
  const auto clipped =
      static_cast<std::size_t>(kClippedShare * static_cast<double>(samples.values.size()));
  const int largest = fullLevels(samples).white;
  GrayLevels levels = {0, largest};
  std::size_t below = 0;
  while (levels.black < largest &&
         (below += histogram[static_cast<std::size_t>(levels.black)]) <= clipped)
    ++levels.black;
  std::size_t above = 0;
  while (levels.white > 0 &&
         (above += histogram[static_cast<std::size_t>(levels.white)]) <= clipped)
    --levels.white;
  if (levels.white <= levels.black) {
    levels.black = std::max(0, std::min(levels.black, levels.white) - 1);
    levels.white = std::min(largest, levels.black + 2);
  }
  return levels;
}

QString sampleText(const ImageSamples& samples, int x, int y) {
  const std::uint16_t value =
      samples.values[static_cast<std::size_t>(y) * static_cast<std::size_t>(samples.width) +
                     static_cast<std::size_t>(x)];
  if (samples.offset == 0.0 && samples.scale == 1.0) return QString::number(value);
  return QString::number(samples.offset + samples.scale * value, 'g', 6);
}

QImage stretched(const ImageSamples& samples, const GrayLevels& levels) {
  const std::vector<std::uint8_t> table = sessions::tableOfLevels(levels, samples.sample_bits);
  QImage image(samples.width, samples.height, QImage::Format_Grayscale8);
  const std::uint16_t* sample = samples.values.data();
  for (int y = 0; y < samples.height; ++y) {
    uchar* line = image.scanLine(y);
    for (int x = 0; x < samples.width; ++x) line[x] = table[*sample++];
  }
  return image;
}

}  // namespace boresight::ui
