// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <opencv2/imgproc.hpp>

namespace boresight::test {

/// Number of pixels whose colour is within `tolerance` of this one.
inline int pixelsLike(const cv::Mat& image, const cv::Scalar& bgr, double tolerance = 3.0) {
  cv::Mat found;
  cv::inRange(image, bgr - cv::Scalar::all(tolerance), bgr + cv::Scalar::all(tolerance), found);
  return cv::countNonZero(found);
}

}  // namespace boresight::test
