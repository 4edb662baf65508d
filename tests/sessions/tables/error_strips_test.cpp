// SPDX-License-Identifier: Apache-2.0
#include "sessions/tables/error_strips.h"

#include <opencv2/imgcodecs.hpp>

#include "tests/sessions/tables/made_runs.h"
#include "tests/sessions/tables/pixels_like.h"
#include "tests/support/matchers.h"

namespace boresight::sessions {
namespace {

using test::madeRun;
using test::pixelsLike;

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

TEST(ErrorStripsFigure, ShowsSeedsCompletedAndFailedRuns) {
  std::vector<RunResult> runs;
  for (int i = 0; i < 40; ++i)
    runs.push_back(madeRun("bc-" + std::to_string(i), "ncc", i % 2 == 0, 0.01 * i, 0.02 * i));
  const Figure figure = errorStripsFigure(runs, CanvasFormat::kPng);
  EXPECT_EQ(figure.name, kStripsFigure);
  const cv::Mat image = cv::imdecode(figure.bytes, cv::IMREAD_COLOR);
  ASSERT_FALSE(image.empty());
  EXPECT_GT(pixelsLike(image, {178, 115, 0}), 20) << "seeds, blue";
  EXPECT_GT(pixelsLike(image, {115, 158, 0}), 20) << "completed, green";
  EXPECT_GT(pixelsLike(image, {26, 38, 204}), 5) << "failed, red";
}

TEST(ErrorStripsFigure, WithoutTruth_IsDrawnEmpty) {
  RunResult blind = madeRun("bc-1", "whs");
  blind.error.reset();
  blind.seed_error.reset();
  blind.requirement.reset();
  const Figure figure = errorStripsFigure({&blind, 1}, CanvasFormat::kPdf);
  EXPECT_EQ(std::string(figure.bytes.begin(), figure.bytes.begin() + 5), "%PDF-");
}

}  // namespace
}  // namespace boresight::sessions
