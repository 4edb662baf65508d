// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <opencv2/imgproc.hpp>

#include "core/edges/border.h"
#include "core/edges/gaussian.h"
#include "tests/core/edges/test_images.h"

namespace boresight {

/// The same pixels, not a copy.
inline cv::Mat asMat(TestImage& image) {
  return cv::Mat(image.height, image.width, CV_8UC1, image.pixels.data());
}

inline ImageView asView(const cv::Mat& image) {
  return {image.ptr<std::uint8_t>(), image.cols, image.rows,
          static_cast<std::ptrdiff_t>(image.step[0])};
}

/// The whole image after core's own stages: equalized by `options`, then smoothed.
inline cv::Mat byCore(const ImageView& image, const BitImage* ignore, const EdgeOptions& options) {
  TestArena arena;
  Equalizer equalizer;
  equalizer.begin(image, ignore, options, *arena);
  while (!equalizer.step(1 << 19)) {
  }
  SmoothedRows smoothed;
  smoothed.begin(image.width, image.height, options.gaussian_sigma_px, *arena);
  cv::Mat out(image.height, roundUpToBlock(image.width), CV_8UC1);
  for (int y = 0; y < image.height; ++y) smoothed.row(y, equalizer, out.ptr(y));
  return out.colRange(0, image.width).clone();
}

inline cv::Mat equalizedByCore(const ImageView& image, const BitImage* ignore,
                               Equalization equalization) {
  EdgeOptions options;
  options.equalization = equalization;
  options.gaussian_sigma_px = 0.0;
  return byCore(image, ignore, options);
}

inline cv::Mat smoothedByCore(const ImageView& image, double sigma_px) {
  EdgeOptions options;
  options.equalization = Equalization::kOff;
  options.gaussian_sigma_px = sigma_px;
  return byCore(image, nullptr, options);
}

inline cv::Mat equalizedByOpenCv(const cv::Mat& image, Equalization equalization) {
  cv::Mat out = image.clone();
  if (equalization == Equalization::kHistogram) cv::equalizeHist(image, out);
  if (equalization == Equalization::kClahe)
    cv::createCLAHE(Equalizer::kClipLimit, cv::Size(Equalizer::kTiles, Equalizer::kTiles))
        ->apply(image, out);
  return out;
}

/// Derivatives by x and y in the units of cv::Canny's thresholds.
inline std::array<cv::Mat, 2> sobelByOpenCv(const cv::Mat& image) {
  std::array<cv::Mat, 2> derivatives;
  for (int axis = 0; axis < 2; ++axis)
    cv::Sobel(image, derivatives[static_cast<std::size_t>(axis)], CV_16S, 1 - axis, axis, 3, 1.0,
              0.0, cv::BORDER_REPLICATE);
  return derivatives;
}

/// 255 where set.
inline cv::Mat unpack(const BitImage& bits) {
  cv::Mat image(bits.height, bits.width, CV_8UC1);
  for (int y = 0; y < bits.height; ++y)
    for (int x = 0; x < bits.width; ++x) image.at<std::uint8_t>(y, x) = bits.get(x, y) ? 255 : 0;
  return image;
}

inline int countDifferent(const cv::Mat& a, const cv::Mat& b) {
  if (a.size() != b.size() || a.type() != b.type()) return -1;
  cv::Mat different;
  cv::compare(a, b, different, cv::CMP_NE);
  return cv::countNonZero(different);
}

}  // namespace boresight
