// SPDX-License-Identifier: Apache-2.0
#include "sessions/tables/result_figures.h"

#include <cmath>
#include <limits>
#include <string>

#include <gtest/gtest.h>
#include <opencv2/imgcodecs.hpp>

#include "sessions/tables/error_strips.h"
#include "tests/sessions/tables/made_runs.h"
#include "tests/sessions/tables/pixels_like.h"
#include "tests/support/matchers.h"

namespace boresight::sessions {
namespace {

using Point = std::array<double, 2>;
using test::madeRun;

/// Two methods that differ by a factor in everything, so that neither hides the other.
std::vector<RunResult> manyRuns() {
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

TEST(ResultFigures, AreFilesOfEachFormat) {
  for (const auto& [format, begin] :
       {std::pair{CanvasFormat::kPdf, "%PDF-"}, {CanvasFormat::kSvg, "<?xml"}})
    for (const Figure& figure : resultFigures(manyRuns(), format))
      EXPECT_EQ(std::string(figure.bytes.begin(), figure.bytes.begin() + 5), begin) << figure.name;
}

TEST(ResultFigures, ShowEveryMethodInItsColour) {
  for (const Figure& figure : resultFigures(manyRuns(), CanvasFormat::kPng)) {
    const cv::Mat whole = cv::imdecode(figure.bytes, cv::IMREAD_COLOR);
    constexpr int kFoot_px = 110;
    ASSERT_GT(whole.rows, 2 * kFoot_px) << figure.name;
    const cv::Mat image = whole.rowRange(0, whole.rows - kFoot_px);  // without the names
    EXPECT_EQ(image.at<cv::Vec3b>(2, 2), cv::Vec3b(255, 255, 255)) << "on white";
    for (const cv::Scalar& bgr : {cv::Scalar(178, 115, 0), cv::Scalar(0, 94, 214)})
      EXPECT_GT(test::pixelsLike(image, bgr), 30) << figure.name << " " << bgr;
  }
}

TEST(ResultFigures, StandRunsWithoutTruth) {
  const std::vector<RunResult> runs(30, test::blindRun("bc-1"));
  EXPECT_EQ(resultFigures(runs, CanvasFormat::kPdf).size(), 4u);
}

TEST(ShareBelow, IsAStaircaseOverAllRuns) {
  const double nan = std::numeric_limits<double>::quiet_NaN();
  EXPECT_THAT(shareBelow({0.3, 0.1, nan}, 4),
              ElementsAre(Point{0.1, 25.0}, Point{0.3, 25.0}, Point{0.3, 50.0}));
  EXPECT_TRUE(shareBelow({}, 4).empty());
}

TEST(SuccessAgainstTolerance, CountsCompletedRunsWithinEachMultiple) {
  // 0.2 mm is half of the requirement, 0.8 mm twice; the third is right but did not complete.
  const std::vector<RunResult> runs = {
      madeRun("bc-1", "whs", true, 0.2), madeRun("bc-2", "whs", true, -0.8, 0.1),
      madeRun("bc-3", "whs", false), madeRun("bc-4", "whs", true, 0.0, 0.0, 30.0)};
  const double factors[] = {0.25, 0.6, 2.5, 10.0};
  EXPECT_THAT(successAgainstTolerance(test::pointersTo(runs), factors),
              ElementsAre(Point{0.25, 0.0}, Point{0.6, 25.0}, Point{2.5, 50.0}, Point{10.0, 75.0}));
  RunResult blind = runs[0];
  blind.requirement.reset();
  blind.success.reset();
  EXPECT_TRUE(successAgainstTolerance(test::pointersTo({blind}), factors).empty());
}

TEST(GeometricSteps, HaveOneRatio) {
  const std::vector<double> steps = geometricSteps(0.01, 100.0, 5);
  ASSERT_EQ(steps.size(), 5u);
  for (std::size_t i = 0; i < 5; ++i)
    EXPECT_NEAR(steps[i], std::pow(10.0, static_cast<double>(i) - 2.0), 1e-12);
}

TEST(SuccessAgainstSeed, PutsRunsIntoBinsOfEqualSizeByHowFarTheyBegan) {
  std::vector<RunResult> runs;
  for (int i = 0; i < 6; ++i) {
    runs.push_back(madeRun("bc-" + std::to_string(i), "whs", true, i < 4 ? 0.0 : 9.0, 0.0, 0.0));
    runs.back().seed_error->normal_mm = 0.0;
    runs.back().seed_error->lateral_mm = 10.0 - i;  // the farthest first
  }
  // Ascending: 5 and 6 (wrong), 7 and 8 (right), 9 and 10 (right).
  EXPECT_THAT(successAgainstSeed(test::pointersTo(runs), SeedMeasure::kDistance_mm, 3),
              ElementsAre(Point{5.5, 0.0}, Point{7.5, 100.0}, Point{9.5, 100.0}));
  EXPECT_EQ(successAgainstSeed(test::pointersTo(runs), SeedMeasure::kDistance_mm, 100).size(), 6u);
  EXPECT_DOUBLE_EQ(*seedMeasure(madeRun("bc-1", "whs"), SeedMeasure::kDistance_mm), 5.0);
  EXPECT_DOUBLE_EQ(*seedMeasure(madeRun("bc-1", "whs"), SeedMeasure::kAngle_mrad), 20.0);
}

TEST(TimeAgainstError, TakesCompletedRuns) {
  std::vector<RunResult> runs = {madeRun("bc-1", "whs", true, 0.0, 0.3),
                                 madeRun("bc-2", "whs", false, 0.0, 0.3)};
  runs[0].seconds.matching = 1.5;
  runs[0].seconds.rendering = 0.5;
  EXPECT_THAT(timeAgainstError(test::pointersTo(runs)), ElementsAre(Point{2.0, 0.3}));
}

TEST(ErrorStrip, FailedRunsKeepTheErrorsOfTheirSeeds) {
  RunResult blind = madeRun("bc-4", "whs");
  blind.error.reset();
  const std::vector<RunResult> runs = {madeRun("bc-1", "whs", true, -0.2),
                                       madeRun("bc-2", "whs", false, 9.0),
                                       madeRun("bc-3", "whs", true, 0.1), blind};
  const ErrorStrip strip = errorStrip(test::pointersTo(runs), &PoseError::normal_mm);
  EXPECT_THAT(strip.completed, ElementsAre(-0.2, 0.1));
  EXPECT_THAT(strip.failed, ElementsAre(3.0)) << "as made_runs.h states its seeds";
}

TEST(SignedDecades, IsOddLinearNearZeroAndLogarithmicBeyond) {
  EXPECT_EQ(signedDecades(0.0, 0.01), 0.0);
  EXPECT_DOUBLE_EQ(signedDecades(-3.0, 0.01), -signedDecades(3.0, 0.01));
  EXPECT_NEAR(signedDecades(1e-6, 0.01) / signedDecades(5e-7, 0.01), 2.0, 1e-3);
  EXPECT_NEAR(signedDecades(1000.0, 0.01) - signedDecades(100.0, 0.01), 1.0, 1e-3);
}

TEST(ErrorStripsFigure, ShowsSeedsCompletedAndFailedRunsAndIsEmptyWithoutTruth) {
  std::vector<RunResult> runs;
  for (int i = 0; i < 40; ++i)
    runs.push_back(madeRun("bc-" + std::to_string(i), "ncc", i % 2 == 0, 0.01 * i, 0.02 * i));
  const Figure figure = errorStripsFigure(runs, CanvasFormat::kPng);
  EXPECT_EQ(figure.name, kStripsFigure);
  const cv::Mat image = cv::imdecode(figure.bytes, cv::IMREAD_COLOR);
  ASSERT_FALSE(image.empty());
  EXPECT_GT(test::pixelsLike(image, {178, 115, 0}), 20) << "seeds, blue";
  EXPECT_GT(test::pixelsLike(image, {115, 158, 0}), 20) << "completed, green";
  EXPECT_GT(test::pixelsLike(image, {26, 38, 204}), 5) << "failed, red";
  RunResult blind = test::blindRun("bc-1");
  blind.requirement.reset();
  const Figure empty = errorStripsFigure({&blind, 1}, CanvasFormat::kPdf);
  EXPECT_EQ(std::string(empty.bytes.begin(), empty.bytes.begin() + 5), "%PDF-");
}

}  // namespace
}  // namespace boresight::sessions
