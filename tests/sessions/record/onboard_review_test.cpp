// SPDX-License-Identifier: Apache-2.0
#include "sessions/record/onboard_review.h"

#include <gtest/gtest.h>

#include <map>

#include "sessions/io/files/errors.h"
#include "sessions/io/files/file_bytes.h"
#include "tests/sessions/record/recorded_run.h"
#include "tests/support/matchers.h"
#include "tests/support/temporary_folder.h"

namespace boresight::test {
namespace {

using namespace sessions;

TEST(OnboardReviewTest, Record_IsReplayedAndAgreesWithTheRunOnTheGround) {
  const TemporaryFolder folder;
  const ExampleRun& example = exampleRun();
  const auto file = folder.write("r.whsr", example.run.bytes);
  const auto review = reviewRecord(file, sha256Text(example.run.bytes), example.problem);
  EXPECT_TRUE(review->record.whole());
  EXPECT_TRUE(review->plan.has_options);
  EXPECT_EQ(review->replay->digest, example.run.trace.digest);
  const RecordComparison found = compareWithGround(*review, example.run.trace, example.problem);
  EXPECT_EQ(found.verdict, RunVerdict::kEqual) << comparisonText(found);
  EXPECT_TRUE(found.inputs_compared);
  EXPECT_EQ(verdictText(found), "Agrees with the run on the ground bit for bit.");
}

TEST(OnboardReviewTest, OtherBytes_AreNotTheAttachedRecord) {
  const TemporaryFolder folder;
  const ExampleRun& example = exampleRun();
  const auto file = folder.write("r.whsr", example.run.bytes);
  EXPECT_THAT(folder.message([&] {
    (void)reviewRecord(file, sha256Text(std::string_view("another")), example.problem);
  }),
              AllOf(HasSubstr("r.whsr"), HasSubstr("differs from the attached record")));
}

std::map<std::string, std::string> sheetOf(const OnboardRecord& record) {
  const auto lines = recordSheet(record);
  return {lines.begin(), lines.end()};
}

TEST(RecordSheet, HasEndPoseSigmaAndDigest) {
  OnboardRecord record;
  record.iterations.resize(5);
  RecordedEnd& end = record.end.emplace();
  end.status = LocalizationStatus::kConverged;
  end.iterations = 5;
  end.attempts = 1;
  end.camera_from_station.translation_m = {0.01, -0.02, 0.5};
  end.camera_from_station.rotation =
      Eigen::Quaterniond(Eigen::AngleAxisd(0.5 * kPi, Eigen::Vector3d::UnitY()));
  end.covariance.diagonal() << 1e-6, 9e-6, 4e-6, 1e-8, 4e-8, 25e-8;
  end.digest = std::string(16, 'a') + std::string(48, 'b');
  const std::vector<std::pair<std::string, std::string>> expected = {
      {"Ended as", "converged"},
      {"Iterations", "5 in 1 attempt"},
      {"Camera from station", "10.00, -20.00, 500.00 mm"},
      {"Rotation vector", "0.000, 90.000, 0.000 deg"},
      {"One sigma at the camera, at most", "0.500 mm, 3.000 mrad"},
      {"Digest", "aaaaaaaaaaaaaaaa ..."},
      {"Record", "whole"}};
  EXPECT_EQ(recordSheet(record), expected);
  end.iterations = 7;
  end.attempts = 2;
  end.covariance.setZero();
  record.missing = {"2 of 7 iterations"};
  auto sheet = sheetOf(record);
  EXPECT_EQ(sheet["Iterations"], "7 in 2 attempts, 5 known");
  EXPECT_FALSE(sheet.contains("One sigma at the camera, at most"));
  EXPECT_EQ(sheet["Record"], "incomplete, see below");
  end.iterations = -7;
  EXPECT_THAT(sheetOf(record)["Iterations"], HasSubstr("5 known"));
  record.end.reset();
  sheet = sheetOf(record);
  EXPECT_EQ(sheet["Ended as"], "not known");
  EXPECT_EQ(sheet["Iterations"], "5 known");
  EXPECT_EQ(sheet.size(), 3u);
}

TEST(VerdictText, EachVerdict_HasItsSentence) {
  RecordComparison comparison;
  comparison.verdict = RunVerdict::kEqual;
  EXPECT_EQ(verdictText(comparison), "Agrees with the run on the ground bit for bit.");
  comparison.verdict = RunVerdict::kWithinLimits;
  EXPECT_EQ(verdictText(comparison),
            "Agrees with the run on the ground bit for bit as far as it reaches.");
  comparison.first = FirstDifference{};
  EXPECT_EQ(verdictText(comparison), "Within the limits; the pixels differ.");
  comparison.verdict = RunVerdict::kDifferent;
  EXPECT_EQ(verdictText(comparison), "Differs from the run on the ground.");
  comparison.verdict = RunVerdict::kUndecided;
  EXPECT_THAT(verdictText(comparison), HasSubstr("does not show whether they agree"));
}

TEST(LimitsText, NamesEachLimit) {
  ComparisonLimits limits;
  limits.found_px = 1.5;
  limits.found_share = 0.61;
  limits.inlier_share = 0.52;
  limits.pose_sigmas = 4.0;
  EXPECT_THAT(limitsText(limits),
              AllOf(HasSubstr("at least 61 % of the templates"), HasSubstr("within 1.5 px"),
                    HasSubstr("at least 52 % of the inliers"), HasSubstr("at most 4.0 sigmas")));
}

}  // namespace
}  // namespace boresight::test
