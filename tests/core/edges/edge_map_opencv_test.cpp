// SPDX-License-Identifier: Apache-2.0
#include "core/edges/edge_map.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdlib>
#include <filesystem>
#include <opencv2/imgcodecs.hpp>
#include <opencv2/imgproc.hpp>
#include <string>
#include <vector>

#include "tests/core/edges/opencv_images.h"

namespace boresight {
namespace {

/// Gradient magnitudes, in the units of cv::Canny's thresholds, of pixels that `counts` sets.
std::vector<double> magnitudes(const cv::Mat& image, const cv::Mat& counts) {
  const auto [dx, dy] = sobelByOpenCv(image);
  std::vector<double> all;
  for (int y = 0; y < image.rows; ++y) {
    for (int x = 0; x < image.cols; ++x) {
      if (counts.at<std::uint8_t>(y, x) == 0) continue;
      const double gx = dx.at<short>(y, x);
      const double gy = dy.at<short>(y, x);
      all.push_back(std::sqrt(gx * gx + gy * gy));
    }
  }
  return all;
}

/// The smallest integer that at least the share `quantile` does not exceed.
void expectQuantile(const std::vector<double>& all, double threshold, double quantile) {
  const auto share = [&all](double limit) {
    return static_cast<double>(std::ranges::count_if(all, [&](double m) { return m <= limit; })) /
           static_cast<double>(all.size());
  };
  EXPECT_EQ(threshold, std::floor(threshold));
  EXPECT_GE(share(threshold), quantile);
  if (threshold > 0.0) {
    EXPECT_LT(share(threshold - 1.0), quantile);
  }
}

EdgeMap detect(const cv::Mat& image, const BitImage* ignore, const EdgeOptions& options,
               TestArena& arena) {
  EdgeMap map;
  EXPECT_EQ(detectEdges(asView(image), ignore, options, *arena, map), Status::kOk);
  return map;
}

void expectSameAsOpenCv(const cv::Mat& image, const EdgeOptions& options) {
  TestArena arena((std::size_t{1} << 20) + image.total());
  const EdgeMap map = detect(image, nullptr, options, arena);
  // The core's Gaussian has a test of its own, and Canny's oracle wants equal input.
  const cv::Mat smooth = smoothedByCore(asView(equalizedByOpenCv(image, options.equalization)),
                                        options.gaussian_sigma_px);
  cv::Mat expected;
  cv::Canny(smooth, expected, map.low_threshold, map.high_threshold, 3, true);
  EXPECT_EQ(countDifferent(unpack(map.level[0]), expected), 0);
  EXPECT_EQ(map.edge_count, cv::countNonZero(expected));
  if (options.thresholds == CannyThresholds::kAbsolute) {
    EXPECT_EQ(map.low_threshold, std::min(options.low_threshold, options.high_threshold));
    EXPECT_EQ(map.high_threshold, std::max(options.low_threshold, options.high_threshold));
    return;
  }
  expectQuantile(magnitudes(smooth, cv::Mat::ones(image.size(), CV_8UC1)), map.high_threshold,
                 options.high_quantile);
  EXPECT_EQ(map.low_threshold, EdgeDetector::kLowRatio * map.high_threshold);
}

std::vector<EdgeOptions> optionsForAllWays() {
  std::vector<EdgeOptions> all(6);
  for (std::size_t way = 0; way < all.size(); ++way) {
    all[way].equalization =
        std::array{Equalization::kHistogram, Equalization::kOff, Equalization::kClahe}[way % 3];
    if (way < 3) continue;
    all[way].thresholds = CannyThresholds::kAbsolute;
    all[way].low_threshold = 220.0;  // the wrong way round: exchanged
    all[way].high_threshold = 90.0;
  }
  return all;
}

TEST(DetectEdges, EqualsOpenCvStageByStage) {
  Random random(71);
  for (EdgeOptions options : optionsForAllWays()) {
    for (const Size size : kSizes) {
      for (const Pattern pattern : {Pattern::kDisks, Pattern::kNoise, Pattern::kSpecks}) {
        SCOPED_TRACE(testing::PrintToString(size));
        TestImage image = makeImage(pattern, size, random);
        options.high_quantile = random.uniform(0.5, 0.99);
        options.gaussian_sigma_px = random.uniform(0.0, 3.0);
        expectSameAsOpenCv(asMat(image), options);
      }
    }
  }
}

/// Candidates and strong pixels from cv::Canny with equal thresholds, ignored ones taken out, and
/// then the connected components of candidates that hold a strong pixel.
cv::Mat cannyWithoutIgnored(const cv::Mat& image, const EdgeMap& map, const cv::Mat& near_ignored) {
  cv::Mat candidates;
  cv::Mat strong;
  cv::Canny(image, candidates, map.low_threshold, map.low_threshold, 3, true);
  cv::Canny(image, strong, map.high_threshold, map.high_threshold, 3, true);
  candidates.setTo(0, near_ignored);
  strong.setTo(0, near_ignored);
  cv::Mat labels;
  const int count = cv::connectedComponents(candidates, labels, 8, CV_32S);
  const auto label = [&labels](int y, int x) {
    return static_cast<std::size_t>(labels.at<int>(y, x));
  };
  std::vector<bool> kept(static_cast<std::size_t>(count), false);
  for (int y = 0; y < image.rows; ++y)
    for (int x = 0; x < image.cols; ++x)
      if (strong.at<std::uint8_t>(y, x) != 0) kept[label(y, x)] = true;
  for (int y = 0; y < image.rows; ++y)
    for (int x = 0; x < image.cols; ++x)
      if (!kept[label(y, x)]) candidates.at<std::uint8_t>(y, x) = 0;
  return candidates;
}

TEST(DetectEdges, LeavesIgnoredPixelsOutOfCountsAndEdges) {
  Random random(73);
  EdgeOptions options;
  options.equalization = Equalization::kOff;
  for (int round = 0; round < 6; ++round) {
    for (const Size size : {Size{64, 64}, Size{201, 144}, Size{330, 90}}) {
      TestImage image = makeImage(Pattern::kDisks, size, random);
      TestBits ignore(size.width, size.height);
      ignoreRectangles(*ignore, random);
      TestArena arena;
      const EdgeMap map = detect(asMat(image), &*ignore, options, arena);
      const cv::Mat smooth = smoothedByCore(image.view(), options.gaussian_sigma_px);
      const cv::Mat ignored = unpack(*ignore);
      expectQuantile(magnitudes(smooth, ~ignored), map.high_threshold, options.high_quantile);
      constexpr int side = 2 * EdgeDetector::kIgnoreMargin_px + 1;
      cv::Mat near_ignored;
      cv::dilate(ignored, near_ignored, cv::Mat::ones(side, side, CV_8UC1));
      EXPECT_EQ(
          countDifferent(unpack(map.level[0]), cannyWithoutIgnored(smooth, map, near_ignored)), 0)
          << testing::PrintToString(size);
    }
  }
}

std::string dataFolder() {
  if (const char* folder = std::getenv("BORESIGHT_DATA"); folder != nullptr && *folder != '\0')
    return folder;
  return BORESIGHT_DATA_FOLDER;
}

/// Images below `folder`, in the order of their paths; every `step`-th.
std::vector<std::string> imagesBelow(const std::string& folder, std::size_t step) {
  std::vector<std::string> paths;
  std::error_code error;
  for (const auto& entry : std::filesystem::recursive_directory_iterator(folder, error)) {
    const std::string extension = entry.path().extension().string();
    if (extension == ".png" || extension == ".jpg") paths.push_back(entry.path().string());
  }
  std::ranges::sort(paths);
  std::vector<std::string> chosen;
  for (std::size_t i = 0; i < paths.size(); i += step) chosen.push_back(paths[i]);
  return chosen;
}

/// With every step-th image of a folder.
void expectSameOnData(const std::string& name, std::size_t step) {
  const std::vector<std::string> paths = dataFolder().empty()
                                             ? std::vector<std::string>()
                                             : imagesBelow(dataFolder() + "/" + name, step);
  if (paths.empty())
    GTEST_SKIP() << "no images in '" << dataFolder() << "/" << name
                 << "'; the variable BORESIGHT_DATA names the folder that holds '" << name << "'";
  const std::vector<EdgeOptions> ways = optionsForAllWays();
  std::size_t way = 0;
  for (const std::string& path : paths) {
    SCOPED_TRACE(path);
    const cv::Mat image = cv::imread(path, cv::IMREAD_GRAYSCALE);
    ASSERT_FALSE(image.empty());
    expectSameAsOpenCv(image, EdgeOptions{});
    // The ways to equalize take turns over the images.
    for (int i = 0; i < 2; ++i) expectSameAsOpenCv(image, ways[++way % 3]);
    cv::Mat expected;
    cv::GaussianBlur(image, expected, cv::Size(), 1.5);
    EXPECT_LE(cv::norm(smoothedByCore(asView(image), 1.5), expected, cv::NORM_INF), 1.0);
  }
}

TEST(DetectEdgesOnData, EqualsOpenCvOnRealImages) { expectSameOnData("real", 1); }

TEST(DetectEdgesOnData, EqualsOpenCvOnSyntheticImages) { expectSameOnData("synthetic", 4); }

}  // namespace
}  // namespace boresight
