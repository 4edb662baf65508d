// SPDX-License-Identifier: Apache-2.0
#include "tests/benchmarks/degraded/occluders.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <vector>

#include <opencv2/imgproc.hpp>

namespace boresight::test {
namespace {

double sharedBy(const cv::Mat& cover, const cv::Mat& silhouette) {
  return cv::countNonZero(cover & silhouette) /
         std::max(1.0, static_cast<double>(cv::countNonZero(silhouette)));
}

/// The size, within (0, largest), at which `draw(size)` covers this share.
template <class Draw>
cv::Mat coverOfShare(double share, const cv::Mat& silhouette, double largest, Draw&& draw) {
  double low = 0.0;
  double high = largest;
  for (int i = 0; i < 14; ++i) {
    const double middle = 0.5 * (low + high);
    (sharedBy(draw(middle), silhouette) < share ? low : high) = middle;
  }
  return draw(high);
}

cv::Mat ellipseOver(double share, const cv::Mat& silhouette, Random& random) {
  const cv::Point place = placeWithin(silhouette, random);
  const double angle = random.uniform(0.0, 180.0);
  const double flat = random.uniform(0.5, 1.0);
  const double largest = 2.0 * (silhouette.cols + silhouette.rows);
  return coverOfShare(share, silhouette, largest, [&](double size) {
    cv::Mat cover = cv::Mat::zeros(silhouette.size(), CV_8U);
    cv::ellipse(cover, place, {static_cast<int>(size) + 1, static_cast<int>(flat * size) + 1},
                angle, 0.0, 360.0, cv::Scalar(255), -1);
    return cover;
  });
}

}  // namespace

cv::Point placeWithin(const cv::Mat& silhouette, Random& random) {
  std::vector<cv::Point> places;
  cv::findNonZero(silhouette, places);
  if (places.empty()) return {silhouette.cols / 2, silhouette.rows / 2};
  return places[random.below(static_cast<std::uint32_t>(places.size()))];
}

void coverGray(double share, const cv::Mat& silhouette, Random& random, cv::Mat& picture) {
  const cv::Mat cover = ellipseOver(share, silhouette, random);
  const double gray = random.uniform(50.0, 180.0);
  for (int y = 0; y < picture.rows; ++y)
    for (int x = 0; x < picture.cols; ++x)
      if (cover.at<std::uint8_t>(y, x) != 0)
        picture.at<std::uint8_t>(y, x) =
            cv::saturate_cast<std::uint8_t>(gray + 1.5 * random.normal());
}

void coverTexture(double share, const cv::Mat& silhouette, Random& random, cv::Mat& picture) {
  const cv::Mat cover = ellipseOver(share, silhouette, random);
  const int right = static_cast<int>(picture.cols * random.uniform(0.25, 0.75));
  const int down = static_cast<int>(picture.rows * random.uniform(0.25, 0.75));
  const cv::Mat before = picture.clone();
  for (int y = 0; y < picture.rows; ++y)
    for (int x = 0; x < picture.cols; ++x)
      if (cover.at<std::uint8_t>(y, x) != 0)
        picture.at<std::uint8_t>(y, x) =
            before.at<std::uint8_t>((y + down) % picture.rows, (x + right) % picture.cols);
}

void coverCables(double share, const cv::Mat& silhouette, Random& random, cv::Mat& picture) {
  const cv::Rect box = cv::boundingRect(silhouette);
  const double size = std::hypot(box.width, box.height);
  std::vector<std::array<cv::Point2d, 2>> lines(4);
  for (auto& line : lines) {
    const cv::Point2d through(placeWithin(silhouette, random));
    const double angle = random.uniform(0.0, CV_PI);
    const cv::Point2d reach = 2.0 * size * cv::Point2d(std::cos(angle), std::sin(angle));
    line = {through - reach, through + reach};
  }
  const cv::Mat cover = coverOfShare(share, silhouette, 0.5 * size, [&](double width) {
    cv::Mat drawn = cv::Mat::zeros(silhouette.size(), CV_8U);
    for (const auto& line : lines) {
      const cv::Point2d along = (line[1] - line[0]) / cv::norm(line[1] - line[0]);
      const cv::Point2d aside = 0.5 * width * cv::Point2d(-along.y, along.x);
      const std::array<cv::Point, 4> corners = {
          cv::Point(line[0] - aside), cv::Point(line[1] - aside), cv::Point(line[1] + aside),
          cv::Point(line[0] + aside)};
      cv::fillConvexPoly(drawn, corners, cv::Scalar(255));
    }
    return drawn;
  });
  for (int y = 0; y < picture.rows; ++y)
    for (int x = 0; x < picture.cols; ++x)
      if (cover.at<std::uint8_t>(y, x) != 0)
        picture.at<std::uint8_t>(y, x) =
            cv::saturate_cast<std::uint8_t>(30.0 + 1.5 * random.normal());
}

}  // namespace boresight::test
