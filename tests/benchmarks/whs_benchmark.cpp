// SPDX-License-Identifier: Apache-2.0
// WHS beside OpenCV's normalized cross-correlation, and beside WHS by Fourier transform as it was
// published, on the same template and window, with one thread. The scene is drawn: an object of
// lines and circles, seen displaced, with gaps, among clutter (7 % edge pixels). Each case runs
// until its figure is stable (Google Benchmark); at the end a table repeats all cases with the
// shortest of some runs and prints the geometric means. Times are the thread's own, so that other
// programs disturb little.
//
//     whs_benchmark                             everything
//     whs_benchmark --benchmark_filter=none     the table alone
#include <algorithm>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <cstdio>
#include <cstdlib>
#include <ctime>
#include <string>
#include <vector>

#include <benchmark/benchmark.h>
#include <opencv2/core.hpp>
#include <opencv2/imgproc.hpp>

#include "core/base/kernels.h"
#include "core/match/whs.h"
#include "tests/core/match/whs_fft.h"

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
  bool half_mask;
  cv::Mat template_pixels, region;
  Bits object, mask, test;
  boresight::TemplateView view;
  boresight::SearchWindow window;
  std::vector<std::byte> memory;
  boresight::WhsSearch search;

  Case(int side_px, int extent_px, bool half, const Scene& scene,
       Kernels kernels = Kernels::kPortable)
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
    use(kernels);
  }

  void use(Kernels kernels) {
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
  void fft() {
    const boresight::test::FftProblem problem(view, test.image, window);
    const boresight::WhsNorms norms = boresight::whsNorms(view);
    cv::Mat1d scores;
    cv::addWeighted(problem.edgeHits(), 1.0 / std::max(norms.edges, 1), problem.emptyHits(),
                    1.0 / std::max(norms.empties, 1), 0.0, scores);
    cv::Point best;
    cv::minMaxLoc(scores, nullptr, nullptr, nullptr, &best);
    benchmark::DoNotOptimize(best);
  }
};

const Scene& scene() {
  static const Scene the_scene;
  return the_scene;
}

enum class Method { kWhs, kNcc, kFft };

void runOnce(Case& the_case, Method method) {
  switch (method) {
    case Method::kWhs:
      return the_case.whs();
    case Method::kNcc:
      return the_case.ncc();
    case Method::kFft:
      return the_case.fft();
  }
}

void runCase(benchmark::State& state, Method method, Kernels kernels) {
  if (!boresight::kernelsAvailable(kernels)) {
    state.SkipWithError("not available here");
    return;
  }
  Case the_case(static_cast<int>(state.range(0)), static_cast<int>(state.range(1)),
                state.range(2) != 0, scene(), kernels);
  for (auto _ : state) runOnce(the_case, method);
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
    add(std::string("Whs/") + boresight::kernelsName(kernels), Method::kWhs, kernels);
  }
  add("OpenCvNcc", Method::kNcc, Kernels::kPortable);
  add("WhsByFft", Method::kFft, Kernels::kPortable);
}

double threadSeconds() {
  std::timespec now{};
  clock_gettime(CLOCK_THREAD_CPUTIME_ID, &now);
  return static_cast<double>(now.tv_sec) + 1e-9 * static_cast<double>(now.tv_nsec);
}

double bestOf(int repetitions, Case& the_case, Method method) {
  double best_s = 1e9;
  for (int k = 0; k < repetitions; ++k) {
    const double start_s = threadSeconds();
    runOnce(the_case, method);
    best_s = std::min(best_s, threadSeconds() - start_s);
  }
  return best_s;
}

/// Times of a case: NCC, WHS by FFT, and WHS with each set of kernels (0: not available).
struct Times {
  double ncc_s = 0.0, fft_s = 0.0;
  double whs_s[boresight::kKernelSets] = {};
};

Times measure(Case& the_case) {
  Times times;
  for (int k = 0; k < boresight::kKernelSets; ++k) {
    const Kernels kernels = static_cast<Kernels>(k);
    if (!boresight::kernelsAvailable(kernels)) continue;
    the_case.use(kernels);
    times.whs_s[k] = bestOf(9, the_case, Method::kWhs);
  }
  times.ncc_s = bestOf(5, the_case, Method::kNcc);
  times.fft_s = bestOf(2, the_case, Method::kFft);
  return times;
}

/// The figures to watch: the geometric means over all cases of NCC's time over WHS's.
void printTable() {
  std::printf("%-25s %10s %10s", "milliseconds", "NCC", "FFT");
  for (int k = 0; k < boresight::kKernelSets; ++k) {
    std::printf(" %10s", boresight::kernelsName(static_cast<Kernels>(k)));
  }
  std::printf("\n");
  double fft_logs = 0.0, whs_logs[boresight::kKernelSets] = {};
  int cases = 0;
  for (const std::int64_t side : kCases[0]) {
    for (const std::int64_t extent : kCases[1]) {
      for (const std::int64_t half : kCases[2]) {
        Case the_case(static_cast<int>(side), static_cast<int>(extent), half != 0, scene());
        const Times times = measure(the_case);
        std::printf("side %3d window %3d %s %10.3f %10.3f", the_case.side, the_case.extent,
                    half != 0 ? "half" : "full", 1e3 * times.ncc_s, 1e3 * times.fft_s);
        fft_logs += std::log(times.ncc_s / times.fft_s);
        for (int k = 0; k < boresight::kKernelSets; ++k) {
          const double whs_s = times.whs_s[k];
          std::printf(" %10.3f", 1e3 * whs_s);
          if (whs_s > 0.0) whs_logs[k] += std::log(times.ncc_s / whs_s);
        }
        std::printf("   x%.1f x%.1f\n", times.ncc_s / times.whs_s[0],
                    times.ncc_s / times.whs_s[static_cast<int>(boresight::bestKernels())]);
        ++cases;
      }
    }
  }
  std::printf("\nmatchTemplate's time over that of, geometric mean of %d cases:\n", cases);
  std::printf("  WHS by FFT        %6.2f\n", std::exp(fft_logs / cases));
  for (int k = 0; k < boresight::kKernelSets; ++k) {
    const Kernels kernels = static_cast<Kernels>(k);
    if (boresight::kernelsAvailable(kernels)) {
      std::printf("  WHS %-12s  %6.2f\n", boresight::kernelsName(kernels),
                  std::exp(whs_logs[k] / cases));
    } else {
      std::printf("  WHS %-12s  not available here\n", boresight::kernelsName(kernels));
    }
  }
}

}  // namespace

int main(int argc, char** argv) {
  cv::setNumThreads(1);
  benchmark::Initialize(&argc, argv);
  registerBenchmarks();
  std::printf("edge pixels of the test image: %.1f %%\n",
              100.0 * cv::countNonZero(scene().test) / (1.0 * kImage_px * kImage_px));
  benchmark::RunSpecifiedBenchmarks();
  printTable();
  return 0;
}
