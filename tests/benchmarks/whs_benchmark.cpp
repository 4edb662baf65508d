// SPDX-License-Identifier: Apache-2.0
// WHS beside OpenCV's normalized cross-correlation on the same template and window. The scene is
// drawn: an object of lines and circles, seen displaced, with gaps, among clutter (6 % edge
// pixels).
#include <algorithm>
#include <chrono>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <cstdio>
#include <map>
#include <utility>
#include <vector>

#include <benchmark/benchmark.h>
#include <opencv2/core.hpp>
#include <opencv2/imgproc.hpp>

#include "core/match/whs.h"

namespace {

using boresight::Arena;
using boresight::BitImage;

constexpr int kImage_px = 1024;

struct Bits {
  explicit Bits(const cv::Mat& pixels)
      : words(static_cast<std::size_t>(BitImage::wordsPerRow(pixels.cols) * pixels.rows)) {
    image.words = words;
    image.width = pixels.cols;
    image.height = pixels.rows;
    image.words_per_row = BitImage::wordsPerRow(pixels.cols);
    for (int y = 0; y < pixels.rows; ++y) {
      for (int x = 0; x < pixels.cols; ++x) {
        if (pixels.at<std::uint8_t>(y, x) != 0) image.set(x, y);
      }
    }
  }
  std::vector<std::uint64_t> words;
  BitImage image;
};

void drawCurves(cv::Mat& canvas, int count, cv::RNG& random) {
  for (int k = 0; k < count; ++k) {
    const cv::Point from(random.uniform(0, kImage_px), random.uniform(0, kImage_px));
    if (k % 3 == 0) {
      cv::circle(canvas, from, random.uniform(15, 120), 255);
    } else {
      const double angle = random.uniform(0.0, CV_PI);
      const int length = random.uniform(60, 300);
      cv::line(
          canvas, from,
          from + cv::Point(cvRound(length * std::cos(angle)), cvRound(length * std::sin(angle))),
          255);
    }
  }
}

struct Scene {
  cv::Mat object, test;

  Scene() : object(kImage_px, kImage_px, CV_8U, cv::Scalar(0)) {
    cv::RNG random(7);
    drawCurves(object, 75, random);
    test = cv::Mat(object.size(), CV_8U, cv::Scalar(0));
    object(cv::Rect(0, 0, kImage_px - 23, kImage_px - 17))
        .copyTo(test(cv::Rect(23, 17, kImage_px - 23, kImage_px - 17)));
    cv::Mat gaps(object.size(), CV_8U);
    random.fill(gaps, cv::RNG::UNIFORM, 0, 100);
    test.setTo(0, gaps < 25);
    drawCurves(test, 300, random);
    random.fill(gaps, cv::RNG::UNIFORM, 0, 1000);
    test.setTo(255, gaps < 8);
  }
};

/// A template of `side` px in the middle and a window of `extent` x `extent` offsets around it.
struct Case {
  int side, extent;
  bool half_mask;
  cv::Mat template_pixels, region;
  Bits object, mask, test;
  boresight::TemplateView view;
  boresight::SearchWindow window;
  std::vector<std::byte> memory;
  boresight::WhsSearch search;

  Case(int side_px, int extent_px, bool half, const Scene& scene)
      : side(side_px),
        extent(extent_px),
        half_mask(half),
        object(scene.object),
        mask(makeMask(half)),
        test(scene.test) {
    const int center = kImage_px / 2 - 20;
    const int corner = kImage_px / 2 - extent / 2;
    view = {&object.image, &mask.image, center, center, side};
    window = {corner, corner, corner + extent - 1, corner + extent - 1};
    template_pixels =
        scene.object(cv::Rect(center - side / 2, center - side / 2, side, side)).clone();
    region = scene
                 .test(cv::Rect(corner - side / 2, corner - side / 2, extent + side - 1,
                                extent + side - 1))
                 .clone();
    Arena count;
    (void)search.create(512, 1400, count);
    memory.resize(count.highWater());
    Arena arena{memory};
    if (search.create(512, 1400, arena) != boresight::Status::kOk) std::abort();
  }

  static cv::Mat makeMask(bool half) {
    cv::Mat mask(kImage_px, kImage_px, CV_8U, cv::Scalar(255));
    if (half) {
      const int c = kImage_px / 2 - 20;
      const std::vector<cv::Point> outside{
          {0, 0}, {c + 150, 0}, {c - 250, kImage_px}, {0, kImage_px}};
      cv::fillConvexPoly(mask, outside, 0);
    }
    return mask;
  }

  void whs() {
    if (search.begin(view, test.image, window, view.center_x, view.center_y, 8) !=
        boresight::Status::kOk) {
      std::abort();
    }
    while (!search.step()) {
    }
    benchmark::DoNotOptimize(search.peak());
  }
  void ncc() {
    cv::Mat scores;
    cv::matchTemplate(region, template_pixels, scores, cv::TM_CCOEFF_NORMED);
    cv::Point best;
    cv::minMaxLoc(scores, nullptr, nullptr, nullptr, &best);
    benchmark::DoNotOptimize(best);
  }
};

const Scene& scene() {
  static const Scene the_scene;
  return the_scene;
}

void runCase(benchmark::State& state, bool whs) {
  Case the_case(static_cast<int>(state.range(0)), static_cast<int>(state.range(1)),
                state.range(2) != 0, scene());
  for (auto _ : state) whs ? the_case.whs() : the_case.ncc();
  const double offsets = static_cast<double>(the_case.extent) * the_case.extent;
  state.counters["ns_per_offset"] = benchmark::Counter(
      offsets * 1e-9, benchmark::Counter::kIsIterationInvariantRate | benchmark::Counter::kInvert);
  the_case.whs();
  state.counters["edges_per_row"] =
      the_case.search.norms().edges / static_cast<double>(the_case.side);
}
void Whs(benchmark::State& state) { runCase(state, true); }
void OpenCvNcc(benchmark::State& state) { runCase(state, false); }

const std::vector<std::vector<std::int64_t>> kCases{
    {32, 64, 128, 256}, {64, 150, 300, 600}, {0, 1}};
BENCHMARK(Whs)->ArgNames({"side", "window", "half_mask"})->ArgsProduct(kCases);
BENCHMARK(OpenCvNcc)->ArgNames({"side", "window", "half_mask"})->ArgsProduct(kCases);

double bestOf(int repetitions, Case& the_case, bool whs) {
  double best_s = 1e9;
  for (int k = 0; k < repetitions; ++k) {
    const auto start = std::chrono::steady_clock::now();
    whs ? the_case.whs() : the_case.ncc();
    const std::chrono::duration<double> elapsed = std::chrono::steady_clock::now() - start;
    best_s = std::min(best_s, elapsed.count());
  }
  return best_s;
}

/// The figure to watch: the geometric mean over all cases of NCC's time over WHS's.
void printRatios() {
  double sum_of_logs = 0.0;
  int cases = 0;
  for (const std::int64_t side : kCases[0]) {
    for (const std::int64_t extent : kCases[1]) {
      for (const std::int64_t half : kCases[2]) {
        Case the_case(static_cast<int>(side), static_cast<int>(extent), half != 0, scene());
        const double whs_s = bestOf(7, the_case, true);
        const double ncc_s = bestOf(5, the_case, false);
        const double offsets = static_cast<double>(extent) * static_cast<double>(extent);
        std::printf(
            "side %3d window %3d %s c+ %5d  whs %8.3f ms (%5.2f ns/offset)  ncc %8.3f ms  ratio "
            "%5.1f\n",
            the_case.side, the_case.extent, half != 0 ? "half" : "full",
            the_case.search.norms().edges, 1e3 * whs_s, 1e9 * whs_s / offsets, 1e3 * ncc_s,
            ncc_s / whs_s);
        sum_of_logs += std::log(ncc_s / whs_s);
        ++cases;
      }
    }
  }
  std::printf("geometric mean of %d cases: WHS is %.1f times as fast as matchTemplate\n", cases,
              std::exp(sum_of_logs / cases));
}

}  // namespace

int main(int argc, char** argv) {
  cv::setNumThreads(1);
  benchmark::Initialize(&argc, argv);
  std::printf("edge pixels of the test image: %.1f %%\n",
              100.0 * cv::countNonZero(scene().test) / (1.0 * kImage_px * kImage_px));
  benchmark::RunSpecifiedBenchmarks();
  printRatios();
  return 0;
}
