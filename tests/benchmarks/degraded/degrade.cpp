// SPDX-License-Identifier: Apache-2.0
#include "tests/benchmarks/degraded/degrade.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <utility>
#include <vector>

#include <opencv2/core.hpp>
#include <opencv2/imgcodecs.hpp>
#include <opencv2/imgproc.hpp>

#include "core/base/random.h"

namespace boresight::test {
namespace {

/// A pixel of the silhouette, or the picture's middle where there is none.
cv::Point placeWithin(const cv::Mat& silhouette, Random& random) {
  std::vector<cv::Point> places;
  cv::findNonZero(silhouette, places);
  if (places.empty()) return {silhouette.cols / 2, silhouette.rows / 2};
  return places[random.below(static_cast<std::uint32_t>(places.size()))];
}

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

/// Gives the covered pixels the gray of `grayAt(x, y)`, row by row.
template <class GrayAt>
void paint(const cv::Mat& cover, cv::Mat& picture, GrayAt&& grayAt) {
  for (int y = 0; y < picture.rows; ++y)
    for (int x = 0; x < picture.cols; ++x)
      if (cover.at<std::uint8_t>(y, x) != 0)
        picture.at<std::uint8_t>(y, x) = cv::saturate_cast<std::uint8_t>(grayAt(x, y));
}

/// An ellipse of one gray, with a little noise.
void coverGray(double share, const cv::Mat& silhouette, Random& random, cv::Mat& picture) {
  const cv::Mat cover = ellipseOver(share, silhouette, random);
  const double gray = random.uniform(50.0, 180.0);
  paint(cover, picture, [&](int, int) { return gray + 1.5 * random.normal(); });
}

/// An ellipse that shows another place of the picture.
void coverTexture(double share, const cv::Mat& silhouette, Random& random, cv::Mat& picture) {
  const cv::Mat cover = ellipseOver(share, silhouette, random);
  const int right = static_cast<int>(picture.cols * random.uniform(0.25, 0.75));
  const int down = static_cast<int>(picture.rows * random.uniform(0.25, 0.75));
  const cv::Mat before = picture.clone();
  paint(cover, picture, [&](int x, int y) {
    return before.at<std::uint8_t>((y + down) % picture.rows, (x + right) % picture.cols);
  });
}

/// Fills the band along a line that reaches `far` to either side of a place, between two offsets
/// from the line.
void fillBand(const cv::Point2d& place, double angle, double far, std::array<double, 2> offsets,
              double gray, cv::Mat& picture) {
  const cv::Point2d along = far * cv::Point2d(std::cos(angle), std::sin(angle));
  const cv::Point2d across(-std::sin(angle), std::cos(angle));
  const cv::Point2d first = place + offsets[0] * across;
  const cv::Point2d second = place + offsets[1] * across;
  const std::array<cv::Point, 4> corners = {cv::Point(first - along), cv::Point(first + along),
                                            cv::Point(second + along), cv::Point(second - along)};
  cv::fillConvexPoly(picture, corners, cv::Scalar(gray));
}

/// Dark straight bands across the object.
void coverCables(double share, const cv::Mat& silhouette, Random& random, cv::Mat& picture) {
  const cv::Rect box = cv::boundingRect(silhouette);
  const double size = std::hypot(box.width, box.height);
  std::array<std::pair<cv::Point2d, double>, 4> lines;  // a place and an angle of each
  for (auto& [through, angle] : lines) {
    through = placeWithin(silhouette, random);
    angle = random.uniform(0.0, CV_PI);
  }
  const cv::Mat cover = coverOfShare(share, silhouette, 0.5 * size, [&](double width) {
    cv::Mat drawn = cv::Mat::zeros(silhouette.size(), CV_8U);
    for (const auto& [through, angle] : lines)
      fillBand(through, angle, 2.0 * size, {-0.5 * width, 0.5 * width}, 255.0, drawn);
    return drawn;
  });
  paint(cover, picture, [&](int, int) { return 30.0 + 1.5 * random.normal(); });
}

double scaleOf(const cv::Mat& picture) { return picture.cols / 2048.0; }

/// Multiplies by 1 where `lit` is 255 and by `left` where it is 0, with a penumbra of some px.
void shade(const cv::Mat& lit, double left, cv::Mat& picture) {
  cv::Mat soft;
  cv::GaussianBlur(lit, soft, {}, std::max(0.5, 1.5 * scaleOf(picture)));
  cv::Mat factor;
  soft.convertTo(factor, CV_32F, (1.0 - left) / 255.0, left);
  cv::Mat light;
  picture.convertTo(light, CV_32F);
  light = light.mul(factor);
  light.convertTo(picture, CV_8U);
}

/// Half of the picture, beyond a line through the object.
void shadeStraight(double left, const cv::Mat& silhouette, Random& random, cv::Mat& picture) {
  const cv::Point place = placeWithin(silhouette, random);
  const double angle = random.uniform(0.0, 2.0 * CV_PI);
  const double far = 2.0 * (picture.cols + picture.rows);
  cv::Mat lit(picture.size(), CV_8U, cv::Scalar(255));
  fillBand(place, angle, far, {0.0, far}, 0.0, lit);
  shade(lit, left, picture);
}

void shadeCurved(double left, const cv::Mat& silhouette, Random& random, cv::Mat& picture) {
  const cv::Rect box = cv::boundingRect(silhouette);
  cv::Mat lit(picture.size(), CV_8U, cv::Scalar(255));
  for (int i = 0; i < 3; ++i) {
    const double radius = std::max(box.width, box.height) * random.uniform(0.15, 0.35);
    cv::circle(lit, placeWithin(silhouette, random), static_cast<int>(radius), cv::Scalar(0), -1);
  }
  shade(lit, left, picture);
}

/// The gain that takes this share of the silhouette to saturation, and a twentieth of the light
/// beyond saturation spread about.
void overexpose(double share, const cv::Mat& silhouette, Random&, cv::Mat& picture) {
  std::vector<std::uint8_t> values;
  for (int y = 0; y < picture.rows; ++y)
    for (int x = 0; x < picture.cols; ++x)
      if (silhouette.at<std::uint8_t>(y, x) != 0) values.push_back(picture.at<std::uint8_t>(y, x));
  if (values.empty()) return;
  const auto at = values.begin() + static_cast<std::ptrdiff_t>(
                                       (1.0 - share) * static_cast<double>(values.size() - 1));
  std::nth_element(values.begin(), at, values.end());
  cv::Mat light;
  picture.convertTo(light, CV_32F, 255.0 / std::max<int>(*at, 1));
  cv::Mat bloom;
  cv::GaussianBlur(cv::max(light - 255.0, 0.0), bloom, {}, 12.0 * scaleOf(picture));
  cv::Mat near;
  cv::GaussianBlur(cv::min(light, 255.0), near, {}, std::max(0.5, 1.5 * scaleOf(picture)));
  cv::Mat(near + 0.5 * bloom).convertTo(picture, CV_8U);
}

/// About the mean of the silhouette; gray levels are whole numbers, so that small steps are lost.
void flatten(double share, const cv::Mat& silhouette, Random&, cv::Mat& picture) {
  const double mean = cv::mean(picture, silhouette)[0];
  picture.convertTo(picture, CV_8U, share, (1.0 - share) * mean);
}

void dust(double grade, const cv::Mat&, Random& random, cv::Mat& picture) {
  const double scale = scaleOf(picture);
  picture.convertTo(picture, CV_8U, 1.0 - 0.8 * grade, 0.8 * grade * 110.0);
  const int specks = static_cast<int>(6000.0 * grade * scale * scale);
  for (int i = 0; i < specks; ++i) {
    const double size = scale * 1.0 / std::max(0.05, random.uniform());  // few are large
    const cv::Point place(static_cast<int>(random.uniform(0.0, picture.cols)),
                          static_cast<int>(random.uniform(0.0, picture.rows)));
    const double gray =
        random.uniform() < 0.5 ? random.uniform(20.0, 70.0) : random.uniform(150.0, 230.0);
    cv::ellipse(picture, place,
                {std::max(1, static_cast<int>(size)),
                 std::max(1, static_cast<int>(size * random.uniform(0.5, 1.0)))},
                random.uniform(0.0, 180.0), 0.0, 360.0, cv::Scalar(gray), -1, cv::LINE_AA);
  }
}

void blurAlong(double length_px, const cv::Mat&, Random& random, cv::Mat& picture) {
  const double angle = random.uniform(0.0, CV_PI);
  const double half = 0.5 * length_px * scaleOf(picture);
  const int reach = static_cast<int>(std::ceil(half)) + 1;
  constexpr int kSteps = 400;
  cv::Mat kernel = cv::Mat::zeros(2 * reach + 1, 2 * reach + 1, CV_32F);
  for (int i = 0; i <= kSteps; ++i) {
    const double s = half * (2.0 * i / kSteps - 1.0);
    const double x = reach + s * std::cos(angle);
    const double y = reach + s * std::sin(angle);
    const int left = static_cast<int>(x);
    const int top = static_cast<int>(y);
    for (int dy = 0; dy < 2; ++dy)
      for (int dx = 0; dx < 2; ++dx)
        kernel.at<float>(top + dy, left + dx) += static_cast<float>(
            (1.0 - std::abs(x - left - dx)) * (1.0 - std::abs(y - top - dy)) / (kSteps + 1.0));
  }
  cv::filter2D(picture, picture, CV_8U, kernel);
}

void blurDisc(double radius_px, const cv::Mat&, Random&, cv::Mat& picture) {
  const double radius = radius_px * scaleOf(picture);
  const int reach = static_cast<int>(std::ceil(radius)) + 1;
  cv::Mat kernel = cv::Mat::zeros(2 * reach + 1, 2 * reach + 1, CV_32F);
  for (int y = -reach; y <= reach; ++y)
    for (int x = -reach; x <= reach; ++x)
      kernel.at<float>(y + reach, x + reach) =
          static_cast<float>(std::clamp(radius + 0.5 - std::hypot(x, y), 0.0, 1.0));
  cv::filter2D(picture, picture, CV_8U, kernel / cv::sum(kernel)[0]);
}

void killColumns(double columns, const cv::Mat&, Random& random, cv::Mat& picture) {
  const int count = static_cast<int>(columns * scaleOf(picture) + 0.5);
  for (int i = 0; i < count; ++i) {
    const int x = static_cast<int>(random.below(static_cast<std::uint32_t>(picture.cols)));
    picture.col(x).setTo(random.uniform() < 0.5 ? 0 : 255);
  }
}

void killPixels(double share, const cv::Mat&, Random& random, cv::Mat& picture) {
  const int count = static_cast<int>(share * picture.cols * picture.rows);
  for (int i = 0; i < count; ++i) {
    const auto x = static_cast<int>(random.below(static_cast<std::uint32_t>(picture.cols)));
    const auto y = static_cast<int>(random.below(static_cast<std::uint32_t>(picture.rows)));
    picture.at<std::uint8_t>(y, x) = random.uniform() < 0.3 ? 0 : 255;
  }
}

template <bool per_row>
void addNoise(double sigma, const cv::Mat&, Random& random, cv::Mat& picture) {
  for (int y = 0; y < picture.rows; ++y) {
    const double row = sigma * random.normal();
    for (int x = 0; x < picture.cols; ++x) {
      auto& pixel = picture.at<std::uint8_t>(y, x);
      pixel = cv::saturate_cast<std::uint8_t>(pixel + (per_row ? row : sigma * random.normal()));
    }
  }
}

void compress(double loss, const cv::Mat&, Random&, cv::Mat& picture) {
  std::vector<std::uint8_t> bytes;
  cv::imencode(".jpg", picture, bytes, {cv::IMWRITE_JPEG_QUALITY, static_cast<int>(100.0 - loss)});
  picture = cv::imdecode(bytes, cv::IMREAD_GRAYSCALE);
}

}  // namespace

const std::vector<DegradationKind>& degradationKinds() {
  static const std::vector<DegradationKind> kinds = {
      {"plain", "", {0}, [](double, const cv::Mat&, Random&, cv::Mat&) {}},
      {"gray_patch", "of the silhouette", {0.1, 0.2, 0.3, 0.4, 0.5}, coverGray},
      {"texture_patch", "of the silhouette", {0.1, 0.2, 0.3, 0.4, 0.5}, coverTexture},
      {"cables", "of the silhouette", {0.1, 0.2, 0.3, 0.4, 0.5}, coverCables},
      {"straight_shadow", "light left", {0.5, 0.25, 0.1}, shadeStraight},
      {"curved_shadow", "light left", {0.5, 0.25, 0.1}, shadeCurved},
      {"overexposed", "of the silhouette", {0.1, 0.25, 0.5, 0.75, 0.9}, overexpose},
      {"contrast", "left", {0.5, 0.25, 0.1, 0.05}, flatten},
      {"dust", "grade", {0.3, 0.6, 0.9}, dust},
      {"motion", "px", {4, 8, 16, 32}, blurAlong},
      {"defocus", "px", {2, 4, 8, 16}, blurDisc},
      {"dead_columns", "columns", {4, 16, 64}, killColumns},
      {"hot_pixels", "of all", {0.001, 0.01, 0.05}, killPixels},
      {"row_noise", "gray", {3, 10}, addNoise<true>},
      {"noise", "gray", {10, 25, 50}, addNoise<false>},
      {"jpeg", "100 - quality", {80, 90, 95}, compress},
  };
  return kinds;
}

cv::Mat silhouette(const Camera& camera, const MeshView& mesh, const Pose& camera_from_station) {
  cv::Mat drawn = cv::Mat::zeros(camera.height, camera.width, CV_8U);
  for (const Face& face : mesh.faces) {
    std::array<cv::Point, 3> corners;
    bool seen = true;
    for (std::size_t i = 0; i < 3; ++i) {
      const auto vertex = static_cast<std::size_t>(face.vertex[i]);
      Eigen::Vector2d pixel;
      seen =
          seen &&
          project(camera, camera_from_station * mesh.vertices_in_station_m[vertex].cast<double>(),
                  pixel);
      if (seen) corners[i] = cv::Point(cvRound(pixel.x()), cvRound(pixel.y()));
    }
    if (seen) cv::fillConvexPoly(drawn, corners, cv::Scalar(255));
  }
  return drawn;
}

}  // namespace boresight::test
