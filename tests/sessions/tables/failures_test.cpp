// SPDX-License-Identifier: Apache-2.0
#include "sessions/tables/result_figures.h"

#include <gtest/gtest.h>

#include <opencv2/imgcodecs.hpp>

#include "sessions/evaluation/batch.h"
#include "sessions/evaluation/results_file.h"
#include "tests/sessions/tables/made_runs.h"
#include "tests/sessions/tables/pixels_like.h"
#include "tests/support/example_case.h"
#include "tests/support/matchers.h"
#include "tests/support/run_batch.h"
#include "tests/support/temporary_folder.h"

namespace boresight::sessions {
namespace {

using test::madeRun;
using test::runBatch;

PoseError off(double lateral_mm, double geodesic_mrad) {
  return {0.0, lateral_mm, 0.0, 0.0, geodesic_mrad, std::nullopt};
}

/// A failed run from a seed 10 mm and 100 mrad off whose iterations leave these parts of that.
RunResult runThatLeaves(const std::vector<double>& parts) {
  RunResult run = madeRun("bc-1", "whs", false);
  run.seed_error = off(10.0, 100.0);
  for (const double part : parts) {
    const auto index = static_cast<std::int32_t>(run.steps.size());
    RunStep& step = run.steps.emplace_back();
    step.index = index;
    step.kind = "match";
    step.support = 5;
    step.matches = 60;
    step.error = off(10.0 * part, 50.0 * part);
  }
  if (!parts.empty()) run.error = run.steps.back().error;
  return run;
}

TEST(Failures, AreToldApartByTheNearestIteration) {
  EXPECT_EQ(whereAstray(runThatLeaves({2.0, 1.5})), Astray::kLedAway);
  EXPECT_EQ(whereAstray(runThatLeaves({0.8, 0.3, 3.0})), Astray::kPartOfWay);
  EXPECT_EQ(whereAstray(runThatLeaves({0.8, 0.09, 3.0})), Astray::kCameNear);
  EXPECT_EQ(whereAstray(runThatLeaves({})), Astray::kNoTruth);
  EXPECT_EQ(whereAstray(madeRun("bc-1", "whs", true, 0.5)), Astray::kBeyondNeed);
  RunResult refused = runThatLeaves({0.5});
  refused.status = "input_error";
  EXPECT_EQ(whereAstray(refused), Astray::kNotBegun);
  RunResult turned = runThatLeaves({0.01});
  turned.steps.front().error = off(0.1, 30.0);
  EXPECT_EQ(whereAstray(turned), Astray::kPartOfWay) << "an angle is left";
}

TEST(Failures, TheStoryNamesTheWayAndWhy) {
  RunResult run = runThatLeaves({0.8, 0.05, 3.0});
  run.message = "its edges explain the image no better than chance";
  const std::string story = failureStory(run);
  EXPECT_THAT(story, HasSubstr("pnp_failed: its edges explain the image no better than chance."));
  EXPECT_THAT(story, HasSubstr("Off by 10.00 mm, 5.73 deg at the seed; 8.00 mm, 2.29 deg after the "
                               "first iteration (5 of 60 matches agree); nearest 0.50 mm, 0.14 deg "
                               "after iteration 2."));
  EXPECT_THAT(story, HasSubstr("near the truth"));
  EXPECT_THAT(failureStory(madeRun("bc-1", "whs", true, 0.8)),
              HasSubstr("converged, 2.0 times beyond what is required."));
}

/// The example from its own seeds and by options under which none converges.
class FailuresOfExample : public testing::Test {
 protected:
  FailuresOfExample() {
    const Dataset dataset = readDataset(test::exampleFolder() / "dataset.json");
    BatchOptions options;
    options.localizer = defaultProfile();
    options.localizer.loop.max_iterations = 1;
    runs_ = runBatch(dataset, options, {});
    RunResult good = runs_.front();
    good.reseed = 1;
    good.completed = true;
    good.success = true;
    good.false_positive = false;
    std::vector<RunResult> all = runs_;
    all.push_back(good);
    write(file_, datasetFacts(dataset), options.localizer, all);
  }
  static void write(const std::filesystem::path& file, const DatasetFacts& facts,
                    const LocalizerOptions& options, const std::vector<RunResult>& runs) {
    ResultsWriter writer(file, facts);
    writer.admit(methodFacts("whs", "default", options));
    writer.begin(BatchRun{});
    for (const RunResult& run : runs) writer.add(run);
  }
  const test::TemporaryFolder folder_;
  const std::filesystem::path file_ = folder_ / "r.sqlite";
  std::vector<RunResult> runs_;
};

TEST_F(FailuresOfExample, AreReadWithTheirIterations) {
  const std::vector<Failure> failures = failuresOf({file_});
  ASSERT_EQ(failures.size(), runs_.size()) << "the one that succeeded is left out";
  for (std::size_t i = 0; i < runs_.size(); ++i) {
    const RunResult& listed = failures[i].run;
    const auto ran = std::find_if(runs_.begin(), runs_.end(),
                                  [&](const auto& run) { return run.case_id == listed.case_id; });
    ASSERT_NE(ran, runs_.end());
    ASSERT_EQ(listed.steps.size(), ran->steps.size());
    const RunStep& last = listed.steps.at(ran->steps.size() - 1);
    EXPECT_EQ(last.kind, ran->steps.back().kind);
    EXPECT_EQ(last.support, ran->steps.back().support);
    ASSERT_TRUE(last.error);
    EXPECT_EQ(last.error->lateral_mm, ran->steps.back().error->lateral_mm);
    EXPECT_EQ(last.camera_from_station.translation_m,
              ran->steps.back().camera_from_station.translation_m);
  }
  EXPECT_TRUE(failuresOf({file_}, {.methods = {"ncc"}}).empty());
}

TEST_F(FailuresOfExample, ARunWithoutIterationsDoesNotTakeThoseOfAnotherFile) {
  const std::filesystem::path unread = folder_ / "unread.sqlite";
  RunResult run = runs_.front();
  run.status = "input_error";
  run.steps.clear();
  write(unread, DatasetFacts{}, LocalizerOptions{}, {run});
  const std::vector<Failure> failures = failuresOf({unread, file_});
  ASSERT_EQ(failures.size(), 1 + runs_.size());
  EXPECT_EQ(failures.front().run.status, "input_error");
  EXPECT_TRUE(failures.front().run.steps.empty());
  EXPECT_FALSE(failures.back().run.steps.empty());
}

int pixelsOf(const cv::Mat& image, const ColorBgr& color) {
  return test::pixelsLike(image, {1.0 * color[0], 1.0 * color[1], 1.0 * color[2]}, 40.0);
}

TEST_F(FailuresOfExample, TheSheetShowsSeedTruthAndEndUnlessTheDatasetIsGone) {
  std::vector<Failure> failures = failuresOf({file_});
  const auto sheet = [&failures] {
    const std::vector<Figure> pages = failureSheets(failures, CanvasFormat::kPng);
    EXPECT_EQ(pages.size(), 1u);
    EXPECT_EQ(pages.at(0).name, "failures_1");
    return cv::imdecode(pages.front().bytes, cv::IMREAD_COLOR);
  };
  for (const ColorBgr& color : {kSeedColor, kTruthColor, kResultColor})
    EXPECT_GT(pixelsOf(sheet(), color), 500);
  for (Failure& failure : failures) failure.dataset = folder_ / "gone.json";
  EXPECT_EQ(pixelsOf(sheet(), kResultColor), 0);
}

TEST_F(FailuresOfExample, PagesAreFilledWithSixEach) {
  const std::vector<Failure> many(7, failuresOf({file_}).front());
  const std::vector<Figure> pages = failureSheets(many, CanvasFormat::kSvg);
  ASSERT_EQ(pages.size(), 2u);
  EXPECT_EQ(pages.back().name, "failures_2");
  EXPECT_EQ(failureSheets(many, CanvasFormat::kPdf).size(), 1u);
  EXPECT_TRUE(failureSheets({}, CanvasFormat::kPdf).empty());
}

}  // namespace
}  // namespace boresight::sessions
