// SPDX-License-Identifier: Apache-2.0
#include "sessions/baselines/gray_images.h"

#include <opencv2/imgproc.hpp>

namespace boresight::sessions {

cv::Mat maskOf(const MatchQuery& query) {
  cv::Mat mask;
  cv::compare(matOf(query.intensity), 0, mask, cv::CMP_GT);
  // Parts that are not matched may occlude, no more.
  for (int y = 0; y < mask.rows; ++y)
    for (int x = 0; x < mask.cols; ++x)
      if (!query.iteration.render.mask.get(x, y)) mask.at<std::uint8_t>(y, x) = 0;
  return mask;
}

cv::Mat equalizedWithin(const cv::Mat& gray, const cv::Mat& mask) {
  std::array<int, 256> below{};  // pixels of the mask at most this bright
  for (int y = 0; y < gray.rows; ++y)
    for (int x = 0; x < gray.cols; ++x)
      if (mask.at<std::uint8_t>(y, x) != 0) ++below[gray.at<std::uint8_t>(y, x)];
  for (std::size_t value = 1; value < below.size(); ++value) below[value] += below[value - 1];
  cv::Mat table(1, 256, CV_8U);
  const double scale = 255.0 / std::max(1, below[255]);
  for (int value = 0; value < 256; ++value)
    table.at<std::uint8_t>(value) =
        cv::saturate_cast<std::uint8_t>(scale * below[static_cast<std::size_t>(value)]);
  cv::Mat equalized;
  cv::LUT(gray, table, equalized);
  equalized.setTo(0, mask == 0);
  return equalized;
}

const cv::Mat& EqualizedImages::get(const MatchQuery& query) {
  cv::Mat& level = levels_[static_cast<std::size_t>(query.iteration.level)];
  if (level.empty()) cv::equalizeHist(matOf(query.image), level);
  return level;
}

}  // namespace boresight::sessions
