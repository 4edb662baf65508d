// SPDX-License-Identifier: Apache-2.0
#include "sessions/tables/result_figures.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <opencv2/imgcodecs.hpp>
#include <string>

#include "tests/sessions/tables/made_runs.h"

namespace boresight::sessions {
namespace {

using test::madeRun;

constexpr int kFoot_px = 110;

/// Two methods that differ by a factor in everything, so that neither hides the other.
std::vector<RunResult> sample() {
  std::vector<RunResult> runs;
  for (int i = 0; i < 30; ++i)
    for (const double factor : {1.0, 5.0}) {
      runs.push_back(madeRun((i % 2 == 0 ? "bc-" : "os-") + std::to_string(i),
                             factor > 1.0 ? "ncc" : "whs", i % 7 != 0, factor * 0.01 * i,
                             factor * 0.02 * i, factor * 0.2 * i));
      runs.back().seed_error->lateral_mm = i;
      runs.back().seed_error->geodesic_mrad = 2.0 * i;
      runs.back().seconds.matching = factor * (0.1 + 0.01 * i);
    }
  return runs;
}

std::string begin(const Figure& figure, std::size_t length) {
  return {figure.bytes.begin(), figure.bytes.begin() + static_cast<std::ptrdiff_t>(length)};
}

TEST(ResultFigures, AreFilesOfEachFormat) {
  for (const Figure& figure : resultFigures(sample(), CanvasFormat::kPdf))
    EXPECT_EQ(begin(figure, 5), "%PDF-") << figure.name;
  for (const Figure& figure : resultFigures(sample(), CanvasFormat::kSvg))
    EXPECT_EQ(begin(figure, 5), "<?xml") << figure.name;
}

TEST(ResultFigures, ShowEveryMethodInItsColour) {
  for (const Figure& figure : resultFigures(sample(), CanvasFormat::kPng)) {
    const cv::Mat whole = cv::imdecode(figure.bytes, cv::IMREAD_COLOR);
    ASSERT_GT(whole.rows, 2 * kFoot_px) << figure.name;
    const cv::Mat image = whole.rowRange(0, whole.rows - kFoot_px);  // without the names
    EXPECT_EQ(image.at<cv::Vec3b>(2, 2), cv::Vec3b(255, 255, 255)) << "on white";
    for (const cv::Scalar& bgr : {cv::Scalar(178, 115, 0), cv::Scalar(0, 94, 214)}) {
      cv::Mat of_method;
      cv::inRange(image, bgr - cv::Scalar::all(3), bgr + cv::Scalar::all(3), of_method);
      EXPECT_GT(cv::countNonZero(of_method), 30) << figure.name << " " << bgr;
    }
  }
}

TEST(ResultFigures, StandRunsWithoutTruth) {
  std::vector<RunResult> runs = sample();
  for (RunResult& run : runs) {
    run.error.reset();
    run.seed_error.reset();
    run.success.reset();
  }
  EXPECT_EQ(resultFigures(runs, CanvasFormat::kPdf).size(), 4u);
}

}  // namespace
}  // namespace boresight::sessions
