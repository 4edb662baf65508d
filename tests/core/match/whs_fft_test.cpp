// SPDX-License-Identifier: Apache-2.0
// WHS by Fourier transform as published (Pham 2025, Eqs. 7-9), in double precision with OpenCV:
// neither the method nor any code is shared with core/match.
#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <vector>

#include <gtest/gtest.h>

#include <opencv2/core.hpp>

#include "core/match/whs.h"
#include "tests/core/match/search_problem.h"

namespace boresight::test {
namespace {

/// Pixels of a bit image as 0 and 1.
cv::Mat1d pixelsOf(const BitImage& image, int x, int y, int width, int height) {
  cv::Mat1d pixels(height, width);
  for (int v = 0; v < height; ++v) {
    for (int u = 0; u < width; ++u) pixels(v, u) = image.get(x + u, y + v) ? 1.0 : 0.0;
  }
  return pixels;
}

/// sum over (u, v) of pattern(v, u) region(y + v, x + u) for all places of the pattern within the
/// region. The transform is as large as the region: what wraps around lies beyond these places.
cv::Mat1d correlation(const cv::Mat1d& region, const cv::Mat1d& pattern) {
  const cv::Size size(cv::getOptimalDFTSize(region.cols), cv::getOptimalDFTSize(region.rows));
  const auto spectrum = [&size](const cv::Mat1d& pixels) {
    cv::Mat1d padded(size, 0.0);
    pixels.copyTo(padded(cv::Rect(cv::Point(0, 0), pixels.size())));
    cv::dft(padded, padded, 0, pixels.rows);
    return padded;
  };
  cv::Mat1d product;
  cv::mulSpectrums(spectrum(region), spectrum(pattern), product, 0, true);
  cv::idft(product, product, cv::DFT_SCALE | cv::DFT_REAL_OUTPUT);
  return product(cv::Rect(0, 0, region.cols - pattern.cols + 1, region.rows - pattern.rows + 1));
}

/// The counts of a window row by row, rounded: template edges and empty pixels inside the mask,
/// over the test edges that the window's templates cover.
std::vector<WhsCounts> whsMapByFft(const TemplateView& view, const BitImage& test_edges,
                                   const SearchWindow& window) {
  const int side = view.side_px, half = side / 2;
  const auto square = [&](const BitImage& image) {
    return pixelsOf(image, view.center_x - half, view.center_y - half, side, side);
  };
  const cv::Mat1d mask = square(*view.mask);
  const cv::Mat1d edges(square(*view.edges).mul(mask));
  const cv::Mat1d empties(mask - edges);
  const cv::Mat1d region = pixelsOf(test_edges, window.x_min - half, window.y_min - half,
                                    window.width() + side - 1, window.height() + side - 1);
  cv::Mat1d no_edges;
  cv::subtract(1.0, region, no_edges);
  const cv::Mat1d edge_hits = correlation(region, edges);
  const cv::Mat1d empty_hits = correlation(no_edges, empties);
  std::vector<WhsCounts> map;
  for (int y = 0; y < window.height(); ++y) {
    for (int x = 0; x < window.width(); ++x) {
      map.push_back({static_cast<std::int32_t>(cvRound(edge_hits(y, x))),
                     static_cast<std::int32_t>(cvRound(empty_hits(y, x)))});
    }
  }
  return map;
}

constexpr int kMaskKinds = static_cast<int>(MaskKind::kCount);

TEST(WhsByFft, GivesTheIntegersOfTheCoreAndTheMaximumOfEverySearch) {
  Dice dice;
  std::vector<OwnedSearch> searches;
  searches.reserve(kKernelSets);  // a search points into its own memory
  for (const Kernels kernels : availableKernels()) searches.emplace_back(256, 300, kernels);
  for (int trial = 0; trial < 60; ++trial) {
    const int side = 2 * dice.between(4, trial % 8 == 0 ? 100 : 60);
    const auto problem =
        randomProblem(side, static_cast<MaskKind>(trial % kMaskKinds), 200, 150, dice);
    SCOPED_TRACE(testing::Message() << "trial " << trial << " side " << side);
    const SearchWindow& window = problem->window;
    const std::vector<WhsCounts> map = whsMapByFft(problem->view, problem->test.image, window);
    std::vector<WhsCounts> map_of_core(map.size());
    whsScoreMap(problem->view, problem->test.image, window, map_of_core);
    ASSERT_EQ(map_of_core, map);
    const WhsNorms norms = whsNormsReference(problem->view);
    std::int64_t largest = 0;
    for (const WhsCounts& counts : map) largest = std::max(largest, whsComparable(counts, norms));
    for (OwnedSearch& owned : searches) {
      const WhsPeak peak = run(owned.search, *problem);
      const int x = peak.x - window.x_min, y = peak.y - window.y_min;
      ASSERT_EQ(peak.counts, map[static_cast<std::size_t>(y * window.width() + x)]);
      ASSERT_EQ(whsComparable(peak.counts, norms), largest);
    }
  }
}

}  // namespace
}  // namespace boresight::test
