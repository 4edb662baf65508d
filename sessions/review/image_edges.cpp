// SPDX-License-Identifier: Apache-2.0
#include "sessions/review/image_edges.h"

#include <algorithm>
#include <array>
#include <cmath>

#include <opencv2/imgproc.hpp>

namespace boresight::sessions {
namespace {

constexpr double kSigma_px = 1.5;
constexpr int kBlurReach_px = 6;
constexpr double kStep_px = 0.5;
constexpr double kAlongNormal = 0.906;  // cos 25 deg
/// Scharr's kernel sums to 32 for a slope of 1 gray/px.
constexpr double kScharrScale = 1.0 / 32.0;
constexpr int kMostSteps = 128;

ImageRegion cutTo(const ImageRegion& region, const ImageView& image) {
  return {std::max(region.x_min, 0), std::max(region.y_min, 0),
          std::min(region.x_max, image.width - 1), std::min(region.y_max, image.height - 1)};
}

/// The region with what the filters see around it, as float.
cv::Mat cutOut(const ImageView& image, const ImageRegion& region) {
  // OpenCV has no const headers; nothing is written.
  const cv::Mat whole(image.height, image.width, CV_8UC1, const_cast<std::uint8_t*>(image.data),
                      static_cast<std::size_t>(image.stride));
  cv::Mat values;
  whole(cv::Rect(region.x_min, region.y_min, region.width(), region.height()))
      .convertTo(values, CV_32F);
  return values;
}

std::vector<float> inner(const cv::Mat& wide, const ImageRegion& from, const ImageRegion& region) {
  std::vector<float> values;
  values.reserve(static_cast<std::size_t>(region.width()) *
                 static_cast<std::size_t>(region.height()));
  for (int y = region.y_min; y <= region.y_max; ++y) {
    const float* row = wide.ptr<float>(y - from.y_min) + (region.x_min - from.x_min);
    values.insert(values.end(), row, row + region.width());
  }
  return values;
}

}  // namespace

ImageEdges::ImageEdges(const ImageView& image, const BitImage* ignore, const ImageRegion& region)
    : region_(cutTo(region, image)) {
  if (region_.empty()) return;
  const ImageRegion wide = cutTo({region_.x_min - kBlurReach_px, region_.y_min - kBlurReach_px,
                                  region_.x_max + kBlurReach_px, region_.y_max + kBlurReach_px},
                                 image);
  cv::Mat blurred;
  cv::GaussianBlur(cutOut(image, wide), blurred, cv::Size(), kSigma_px, kSigma_px,
                   cv::BORDER_REPLICATE);
  cv::Mat dx;
  cv::Mat dy;
  cv::Scharr(blurred, dx, CV_32F, 1, 0, kScharrScale, 0.0, cv::BORDER_REPLICATE);
  cv::Scharr(blurred, dy, CV_32F, 0, 1, kScharrScale, 0.0, cv::BORDER_REPLICATE);
  dx_ = inner(dx, wide, region_);
  dy_ = inner(dy, wide, region_);
  ignored_.assign(dx_.size(), 0);
  if (ignore == nullptr) return;
  for (int y = region_.y_min; y <= region_.y_max; ++y)
    for (int x = region_.x_min; x <= region_.x_max; ++x)
      ignored_[indexOf(x, y)] = ignore->get(x, y) ? 1 : 0;
}

Eigen::Vector2d ImageEdges::between(const Eigen::Vector2d& pixel) const {
  const int x =
      std::clamp(static_cast<int>(std::floor(pixel.x())), region_.x_min, region_.x_max - 1);
  const int y =
      std::clamp(static_cast<int>(std::floor(pixel.y())), region_.y_min, region_.y_max - 1);
  const double u = pixel.x() - x;
  const double v = pixel.y() - y;
  return (1.0 - v) * ((1.0 - u) * gradient(x, y) + u * gradient(x + 1, y)) +
         v * ((1.0 - u) * gradient(x, y + 1) + u * gradient(x + 1, y + 1));
}

bool ImageEdges::canLook(const Eigen::Vector2d& predicted_px, double radius_px) const {
  const double reach = radius_px + 1.0;
  if (!(predicted_px.x() - reach >= region_.x_min && predicted_px.x() + reach <= region_.x_max &&
        predicted_px.y() - reach >= region_.y_min && predicted_px.y() + reach <= region_.y_max))
    return false;
  const int x = static_cast<int>(std::lround(predicted_px.x()));
  const int y = static_cast<int>(std::lround(predicted_px.y()));
  return !isIgnored(x, y);
}

std::optional<FoundEdge> ImageEdges::across(const Eigen::Vector2d& predicted_px,
                                            const Eigen::Vector2d& normal, double radius_px,
                                            double least_slope) const {
  if (!canLook(predicted_px, radius_px)) return {};
  const int reach = std::min(static_cast<int>(radius_px / kStep_px), kMostSteps / 2 - 1);
  std::array<double, kMostSteps + 1> slope{};  // of steps -reach - 1 ... reach + 1
  std::array<bool, kMostSteps + 1> agrees{};
  const int count = 2 * reach + 3;
  for (int i = 0; i < count; ++i) {
    const Eigen::Vector2d at = predicted_px + (i - reach - 1) * kStep_px * normal;
    const Eigen::Vector2d found = between(at);
    slope[static_cast<std::size_t>(i)] = std::abs(found.dot(normal));
    agrees[static_cast<std::size_t>(i)] =
        slope[static_cast<std::size_t>(i)] >= kAlongNormal * found.norm();
    if (isIgnored(static_cast<int>(std::lround(at.x())), static_cast<int>(std::lround(at.y()))))
      agrees[static_cast<std::size_t>(i)] = false;
  }
  std::size_t best = 0;
  for (std::size_t i = 1; i + 1 < static_cast<std::size_t>(count); ++i) {
    const bool peak = slope[i] >= slope[i - 1] && slope[i] > slope[i + 1];
    if (peak && agrees[i] && slope[i] >= least_slope && (best == 0 || slope[i] > slope[best]))
      best = i;
  }
  if (best == 0) return {};
  const double curvature = slope[best - 1] - 2.0 * slope[best] + slope[best + 1];
  const double shift =
      curvature < 0.0 ? 0.5 * (slope[best - 1] - slope[best + 1]) / curvature : 0.0;
  return FoundEdge{(static_cast<double>(best) - reach - 1 + shift) * kStep_px, slope[best]};
}

std::vector<std::uint8_t> ImageEdges::thinEdges(double least_slope) const {
  std::vector<std::uint8_t> edges(dx_.size(), 0);
  if (region_.empty()) return edges;
  // Canny takes integers: a 64th of a gray value per pixel is fine enough.
  constexpr double kUnits = 64.0;
  const auto packed = [this](const std::vector<float>& values) {
    const cv::Mat header(region_.height(), region_.width(), CV_32F,
                         const_cast<float*>(values.data()));
    cv::Mat made;
    header.convertTo(made, CV_16S, kUnits);
    return made;
  };
  cv::Mat found(region_.height(), region_.width(), CV_8U, edges.data());
  cv::Canny(packed(dx_), packed(dy_), found, 0.5 * kUnits * least_slope, kUnits * least_slope,
            true);
  for (std::size_t i = 0; i < edges.size(); ++i)
    if (ignored_[i] != 0) edges[i] = 0;
  return edges;
}

}  // namespace boresight::sessions
