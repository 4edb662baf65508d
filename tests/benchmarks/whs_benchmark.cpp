// SPDX-License-Identifier: Apache-2.0
// Times WHS with each set of kernels and OpenCV's normalized cross-correlation on the same template
// and window, with one thread. The scene is drawn:
// an object of lines and circles, displaced, with gaps, among clutter (7 % edge pixels).
#include <algorithm>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <cstdio>
#include <cstdlib>
#include <string>
#include <vector>

#include <benchmark/benchmark.h>
#include <opencv2/core.hpp>
#include <opencv2/imgproc.hpp>

#include "core/base/kernels.h"
#include "core/match/whs.h"

namespace {

using boresight::Arena;
using boresight::BitImage;
using boresight::Kernels;

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
  cv::Mat template_pixels, region;
  Bits object, mask, test;
  boresight::TemplateView view;
  boresight::SearchWindow window;
  std::vector<std::byte> memory;
  boresight::WhsSearch search;

  Case(int side_px, int extent_px, bool half, const Scene& scene, Kernels kernels)
      : side(side_px),
        extent(extent_px),
        object(scene.object),
        mask(makeMask(half)),
        test(scene.test) {
    const int center = kImage_px / 2 - 20;
    const int corner = kImage_px / 2 - extent / 2;
    view = {&object.image, &mask.image, center, center, side};
    window = {corner, corner, corner + extent - 1, corner + extent - 1};
    const auto square = [this](int from, int size) {
      return cv::Rect(from - side / 2, from - side / 2, size, size);
    };
    template_pixels = scene.object(square(center, side)).clone();
    region = scene.test(square(corner, extent + side - 1)).clone();
    Arena count;
    (void)search.create(512, 1400, kernels, count);
    memory.assign(count.highWater(), std::byte{0});
    Arena arena{memory};
    if (search.create(512, 1400, kernels, arena) != boresight::Status::kOk) std::abort();
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
        boresight::Status::kOk)
      std::abort();
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

using Method = void (Case::*)();

void runCase(benchmark::State& state, Method method, Kernels kernels) {
  if (!boresight::kernelsAvailable(kernels)) {
    state.SkipWithError("not available here");
    return;
  }
  Case the_case(static_cast<int>(state.range(0)), static_cast<int>(state.range(1)),
                state.range(2) != 0, scene(), kernels);
  for (auto _ : state) (the_case.*method)();
  const double offsets = static_cast<double>(the_case.extent) * the_case.extent;
  state.counters["ns_per_offset"] = benchmark::Counter(
      offsets * 1e-9, benchmark::Counter::kIsIterationInvariantRate | benchmark::Counter::kInvert);
  the_case.whs();
  state.counters["edges_per_row"] =
      the_case.search.norms().edges / static_cast<double>(the_case.side);
}

const std::vector<std::vector<std::int64_t>> kCases{
    {32, 64, 128, 256}, {64, 150, 300, 600}, {0, 1}};

void registerBenchmarks() {
  const auto add = [](const std::string& name, Method method, Kernels kernels) {
    benchmark::RegisterBenchmark(
        name.c_str(),
        [method, kernels](benchmark::State& state) { runCase(state, method, kernels); })
        ->ArgNames({"side", "window", "half_mask"})
        ->ArgsProduct(kCases);
  };
  for (int k = 0; k < boresight::kKernelSets; ++k) {
    const Kernels kernels = static_cast<Kernels>(k);
    add(std::string("Whs/") + boresight::kernelsName(kernels), &Case::whs, kernels);
  }
  add("OpenCvNcc", &Case::ncc, Kernels::kPortable);
}

}  // namespace

int main(int argc, char** argv) {
  cv::setNumThreads(1);
  benchmark::Initialize(&argc, argv);
  registerBenchmarks();
  std::printf("edge pixels of the test image: %.1f %%\n",
              100.0 * cv::countNonZero(scene().test) / (1.0 * kImage_px * kImage_px));
  benchmark::RunSpecifiedBenchmarks();
  return 0;
}
