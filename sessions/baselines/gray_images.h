// SPDX-License-Identifier: Apache-2.0
// The images of a query as OpenCV has them. For .cpp files of this folder.
#pragma once

#include <array>

#include <opencv2/core.hpp>

#include "sessions/run/matching_method.h"

namespace boresight::sessions {

/// The image's own pixels; must not be written through.
inline cv::Mat matOf(const ImageView& image) {
  return {image.height, image.width, CV_8U, const_cast<std::uint8_t*>(image.data),
          static_cast<std::size_t>(image.stride)};
}

/// 255 where a matched part was rendered, else 0.
cv::Mat maskOf(const MatchQuery& query);

/// Histogram equalization over the pixels of a mask alone; those beside it become 0.
cv::Mat equalizedWithin(const cv::Mat& gray, const cv::Mat& mask);

/// Test images of one run, equalized when first asked for.
class EqualizedImages {
 public:
  void clear() { levels_ = {}; }
  const cv::Mat& get(const MatchQuery& query);

 private:
  std::array<cv::Mat, kPyramidLevels> levels_;
};

}  // namespace boresight::sessions
