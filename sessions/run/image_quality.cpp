// SPDX-License-Identifier: Apache-2.0
#include "sessions/run/image_quality.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdlib>
#include <vector>

#include <opencv2/core.hpp>
#include <opencv2/imgproc.hpp>

#include "core/accept/edge_width.h"
#include "sessions/text/text_table.h"

namespace boresight::sessions {
namespace {

constexpr int kBlack = 0;
constexpr int kSaturated = 255;
constexpr double kSigmaOfMedian = 1.4826;  ///< standard deviation over median absolute deviation
constexpr double kNormOfLaplacian = 6.0;   ///< of Immerkaer's kernel
constexpr double kStrongestEdges = 0.9;    ///< quantile of the gradient's length
constexpr int kMostEdgePixels = 4000;      ///< whose width is measured
constexpr double kSmoothing_px = 1.5;      ///< of the image whose edges are looked for

/// Not 0 where a pixel counts.
cv::Mat1b countedPixels(const BitImage* ignore, const cv::Rect& box) {
  cv::Mat1b counted(box.size(), 255);
  for (int y = 0; ignore != nullptr && y < box.height; ++y)
    for (int x = 0; x < box.width; ++x)
      if (ignore->get(box.x + x, box.y + y)) counted(y, x) = 0;
  return counted;
}

using GrayCounts = std::array<double, 256>;

GrayCounts grayCounts(const cv::Mat1b& gray, const cv::Mat1b& counted) {
  GrayCounts counts{};
  for (int y = 0; y < gray.rows; ++y)
    for (int x = 0; x < gray.cols; ++x)
      if (counted(y, x)) ++counts[gray(y, x)];
  return counts;
}

int percentile(const GrayCounts& counts, double total, double share) {
  double below = 0.0;
  for (std::size_t gray = 0; gray < counts.size(); ++gray) {
    below += counts[gray];
    if (below >= share * total) return static_cast<int>(gray);
  }
  return kSaturated;
}

double noiseOf(const cv::Mat1b& gray, const cv::Mat1b& counted) {
  const cv::Mat1d kernel = (cv::Mat1d(3, 3) << 1, -2, 1, -2, 4, -2, 1, -2, 1);
  cv::Mat1s response;
  cv::filter2D(gray, response, CV_16S, kernel);
  std::vector<short> lengths;
  for (int y = 1; y + 1 < gray.rows; ++y)
    for (int x = 1; x + 1 < gray.cols; ++x)
      if (counted(y, x) && gray(y, x) != kBlack && gray(y, x) != kSaturated)
        lengths.push_back(static_cast<short>(std::abs(response(y, x))));
  if (lengths.empty()) return 0.0;
  const auto middle = lengths.begin() + static_cast<std::ptrdiff_t>(lengths.size() / 2);
  std::nth_element(lengths.begin(), middle, lengths.end());
  return kSigmaOfMedian * *middle / kNormOfLaplacian;
}

/// Width of the strongest edges, which are thinned to the ridges of the gradient.
double edgeWidthOf(const ImageView& image, const BitImage* ignore, const cv::Mat1b& gray,
                   const cv::Point& corner) {
  cv::Mat1f smooth, along_x, along_y, length;
  gray.convertTo(smooth, CV_32F);
  cv::GaussianBlur(smooth, smooth, {}, kSmoothing_px);
  cv::Sobel(smooth, along_x, CV_32F, 1, 0);
  cv::Sobel(smooth, along_y, CV_32F, 0, 1);
  cv::magnitude(along_x, along_y, length);
  std::vector<float> sorted(length.begin(), length.end());
  const auto limit = sorted.begin() + static_cast<std::ptrdiff_t>(
                                          kStrongestEdges * static_cast<double>(sorted.size() - 1));
  std::nth_element(sorted.begin(), limit, sorted.end());
  std::vector<cv::Point> ridges;
  for (int y = 1; y + 1 < gray.rows; ++y)
    for (int x = 1; x + 1 < gray.cols; ++x) {
      const float current = length(y, x);
      if (current <= *limit || current <= 0.0F) continue;
      const int dx = cvRound(along_x(y, x) / current);
      const int dy = cvRound(along_y(y, x) / current);
      if (current > length(y + dy, x + dx) && current >= length(y - dy, x - dx))
        ridges.push_back({x, y});
    }
  EdgeWidthMeter meter(image, ignore);
  const std::size_t stride = std::max<std::size_t>(1, ridges.size() / kMostEdgePixels);
  for (std::size_t i = 0; i < ridges.size(); i += stride) {
    const cv::Point& at = ridges[i];
    const Eigen::Vector2d normal(along_x(at), along_y(at));
    meter.add(Eigen::Vector2d(corner.x + at.x, corner.y + at.y), normal.normalized());
  }
  return meter.width().widest_px();
}

}  // namespace

PixelRegion stationRegion(const Camera& camera, const MeshView& mesh,
                          const Pose& camera_from_station) {
  Eigen::AlignedBox2d box;
  for (std::size_t f = 0; f < mesh.faces.size(); ++f) {
    if (!mesh.parts[mesh.part_of_face[f]].match) continue;
    for (const std::int32_t index : mesh.faces[f].vertex) {
      Eigen::Vector2d pixel;
      const Eigen::Vector3f& vertex = mesh.vertices_in_station_m[static_cast<std::size_t>(index)];
      if (project(camera, camera_from_station * vertex.cast<double>(), pixel)) box.extend(pixel);
    }
  }
  const Eigen::AlignedBox2d image(Eigen::Vector2d::Zero(),
                                  Eigen::Vector2d(camera.width - 1, camera.height - 1));
  const Eigen::AlignedBox2d seen = box.intersection(image);
  if (seen.isEmpty()) return {};
  return {seen.min().cast<int>(), seen.max().array().ceil().matrix().cast<int>()};
}

std::optional<ImageQuality> measureImageQuality(const ImageView& image, const BitImage* ignore,
                                                const PixelRegion& region) {
  if (region.isEmpty()) return std::nullopt;
  const Eigen::Vector2i corner = region.min();
  const Eigen::Vector2i size = region.sizes() + Eigen::Vector2i::Ones();
  const cv::Rect box = cv::Rect(corner.x(), corner.y(), size.x(), size.y()) &
                       cv::Rect(0, 0, image.width, image.height);
  if (box.width < 3 || box.height < 3) return std::nullopt;
  cv::Mat1b gray(box.size());
  for (int y = 0; y < box.height; ++y)
    std::copy_n(image.row(box.y + y) + box.x, box.width, gray.ptr(y));
  const cv::Mat1b counted = countedPixels(ignore, box);
  const double total = cv::countNonZero(counted);
  if (total == 0.0) return std::nullopt;
  const GrayCounts counts = grayCounts(gray, counted);
  ImageQuality quality;
  cv::Scalar mean, deviation;
  cv::meanStdDev(gray, mean, deviation, counted);
  quality.noise_gray = noiseOf(gray, counted);
  quality.contrast_gray = deviation[0];
  quality.range_gray = percentile(counts, total, 0.99) - percentile(counts, total, 0.01);
  quality.saturated_share = counts[kSaturated] / total;
  quality.black_share = counts[kBlack] / total;
  quality.edge_width_px = edgeWidthOf(image, ignore, gray, box.tl());
  return quality;
}

std::optional<ImageQuality> imageQualityOf(const LocalizationProblem& problem) {
  return measureImageQuality(
      problem.image, problem.ignore,
      stationRegion(problem.camera, problem.mesh, problem.camera_from_station_seed));
}

std::string imageQualityText(const std::optional<ImageQuality>& quality) {
  if (!quality) return "the station's projection is outside the image";
  const auto percent = [](double share) { return fixedText(100.0 * share, 1) + " %"; };
  return "noise " + fixedText(quality->noise_gray, 1) + " gray, contrast " +
         fixedText(quality->contrast_gray, 0) + " gray (range " +
         fixedText(quality->range_gray, 0) + "), " + percent(quality->saturated_share) +
         " saturated, " + percent(quality->black_share) + " black, " +
         (quality->edge_width_px > 0.0
              ? "edges " + fixedText(quality->edge_width_px, 1) + " px wide"
              : std::string("too few edges for their width"));
}

}  // namespace boresight::sessions
