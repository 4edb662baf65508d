// SPDX-License-Identifier: Apache-2.0
#include "app/bench_matching.h"

#include <algorithm>
#include <chrono>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <limits>
#include <opencv2/core.hpp>
#include <opencv2/imgproc.hpp>
#include <stdexcept>

#include "app/commands.h"
#include "core/base/arena.h"
#include "core/match/whs.h"

namespace boresight::app {
namespace {

constexpr int kScene_px = 1024;
constexpr int kSides_px[] = {32, 64, 128, 256};
constexpr int kWindows_px[] = {64, 150, 300, 600};
constexpr int kSecondPeakExclusion_px = 6;
constexpr int kDisplacementX_px = 23;
constexpr int kDisplacementY_px = 17;

void drawCurves(cv::Mat& canvas, int count, cv::RNG& random) {
  for (int k = 0; k < count; ++k) {
    const cv::Point from(random.uniform(0, kScene_px), random.uniform(0, kScene_px));
    if (k % 3 == 0) {
      cv::circle(canvas, from, random.uniform(15, 120), 255);
    } else {
      const cv::Point along(random.uniform(-200, 200), random.uniform(-200, 200));
      cv::line(canvas, from, from + along, 255);
    }
  }
}

/// A binary image with its words.
struct Bits {
  explicit Bits(const cv::Mat& pixels)
      : words(static_cast<std::size_t>(BitImage::wordsPerRow(pixels.cols) * pixels.rows)) {
    image = {words, pixels.cols, pixels.rows, BitImage::wordsPerRow(pixels.cols)};
    for (int y = 0; y < pixels.rows; ++y) {
      for (int x = 0; x < pixels.cols; ++x) {
        if (pixels.at<std::uint8_t>(y, x) != 0) image.set(x, y);
      }
    }
  }
  Bits(const Bits&) = delete;
  Bits& operator=(const Bits&) = delete;

  std::vector<std::uint64_t> words;
  BitImage image;
};

/// The object's edges, and the same displaced, a quarter of them missing, among others.
struct Scene {
  cv::Mat object{kScene_px, kScene_px, CV_8U, cv::Scalar(0)};
  cv::Mat test{kScene_px, kScene_px, CV_8U, cv::Scalar(0)};

  Scene() {
    cv::RNG random(7);
    drawCurves(object, 75, random);
    const cv::Size rest(kScene_px - kDisplacementX_px, kScene_px - kDisplacementY_px);
    object(cv::Rect(cv::Point(), rest))
        .copyTo(test(cv::Rect(cv::Point(kDisplacementX_px, kDisplacementY_px), rest)));
    cv::Mat gaps(object.size(), CV_8U);
    random.fill(gaps, cv::RNG::UNIFORM, 0, 100);
    test.setTo(0, gaps < 25);
    drawCurves(test, 300, random);
  }
};

template <class Work>
double bestMilliseconds(int repetitions, const Work& work) {
  double best_ms = std::numeric_limits<double>::max();
  for (int k = 0; k < repetitions; ++k) {
    const auto begin = std::chrono::steady_clock::now();
    work();
    const std::chrono::duration<double, std::milli> elapsed =
        std::chrono::steady_clock::now() - begin;
    best_ms = std::min(best_ms, elapsed.count());
  }
  return best_ms;
}

class Matcher {
 public:
  Matcher() : whole_(cv::Mat(kScene_px, kScene_px, CV_8U, cv::Scalar(255))) {}

  MatchingFigure measure(int side_px, int window_px, int repetitions) {
    const int center = kScene_px / 2 - 20;
    const int corner = kScene_px / 2 - window_px / 2;
    const TemplateView view{&object_.image, &whole_.image, center, center, side_px};
    const SearchWindow window{corner, corner, corner + window_px - 1, corner + window_px - 1};
    const cv::Mat pattern =
        scene_.object(cv::Rect(center - side_px / 2, center - side_px / 2, side_px, side_px));
    const int extent = window_px + side_px - 1;
    const cv::Mat region =
        scene_.test(cv::Rect(corner - side_px / 2, corner - side_px / 2, extent, extent));
    MatchingFigure figure;
    figure.side_px = side_px;
    figure.window_px = window_px;
    for (const Kernels kernels : availableKernels()) {
      prepare(kernels);
      figure.whs_ms[static_cast<std::size_t>(kernels)] = bestMilliseconds(repetitions, [&] {
        require(search_.begin(view, test_.image, window, center, center, kSecondPeakExclusion_px));
        while (!search_.step()) {
        }
      });
    }
    figure.ncc_ms = bestMilliseconds(repetitions, [&] {
      cv::Mat scores;
      cv::matchTemplate(region, pattern, scores, cv::TM_CCOEFF_NORMED);
      cv::Point best;
      cv::minMaxLoc(scores, nullptr, nullptr, nullptr, &best);
    });
    return figure;
  }

 private:
  static void require(Status status) {
    if (status != Status::kOk) throw std::logic_error("the matching benchmark's own scene");
  }

  void prepare(Kernels kernels) {
    Arena count;
    (void)search_.create(kScene_px / 4, kScene_px, kernels, count);
    memory_.resize(count.highWater());
    Arena arena{memory_};
    require(search_.create(kScene_px / 4, kScene_px, kernels, arena));
  }

  Scene scene_;
  Bits object_{scene_.object};
  Bits test_{scene_.test};
  Bits whole_;
  std::vector<std::byte> memory_;
  WhsSearch search_;
};

}  // namespace

std::vector<MatchingFigure> measureMatching(int repetitions, bool quick) {
  cv::setNumThreads(1);
  Matcher matcher;
  std::vector<MatchingFigure> figures;
  for (const int side_px : kSides_px) {
    for (const int window_px : kWindows_px) {
      if (quick && window_px != kWindows_px[0]) continue;
      figures.push_back(matcher.measure(side_px, window_px, repetitions));
    }
  }
  return figures;
}

double meanRatio(const std::vector<MatchingFigure>& figures, Kernels kernels) {
  double sum = 0.0;
  for (const MatchingFigure& figure : figures)
    sum += std::log(figure.ncc_ms / figure.whs_ms[static_cast<std::size_t>(kernels)]);
  return figures.empty() ? 0.0 : std::exp(sum / static_cast<double>(figures.size()));
}

}  // namespace boresight::app
