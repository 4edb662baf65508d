// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <opencv2/core.hpp>

#include "core/base/image.h"
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
