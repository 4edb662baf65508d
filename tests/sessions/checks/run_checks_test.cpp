// SPDX-License-Identifier: Apache-2.0
// Runs made by hand: what every check says of them is known.
#include "sessions/checks/checks.h"

#include <gtest/gtest.h>

#include <cstdint>
#include <memory>
#include <optional>
#include <vector>

#include "sessions/trace/decisive_iterations.h"
#include "tests/sessions/checks/find_check.h"
#include "tests/support/matchers.h"

namespace boresight::sessions {
namespace {

using test::findCheck;

/// Templates on a line of pixels 10 ... 100 and their matches, of which the first `inliers` agree.
struct MadeMatches {
  int count = 10;
  int inliers = 10;
  int at_border = 0;
  int second_share = 50;  ///< of the best place's edge hits, %
};

void addMatch(const MadeMatches& made_matches, int index, IterationTrace& iteration) {
  Template item;
  item.center_x = 10 * (index + 1);
  item.center_y = 10 * (index + 1) * (index % 2 == 0 ? 1 : 2);
  item.depth_m = 0.5F + 0.01F * static_cast<float>(index);
  iteration.templates.push_back(item);
  Match match;
  match.norms = {100, 100};
  match.x = match.peak.x = item.center_x;
  match.y = match.peak.y = item.center_y;
  match.peak.counts = {100, 0};
  match.peak.has_second = true;
  match.peak.second_counts = {made_matches.second_share, 0};
  match.searched = true;
  match.at_border = index < made_matches.at_border;
  iteration.matches.push_back(match);
  iteration.correspondences.emplace_back();
  iteration.template_of.push_back(index);
  iteration.pnp.inlier.push_back(index < made_matches.inliers ? 1 : 0);
  iteration.pnp.residual_px.push_back(0.5);
  EdgePixel& pixel = iteration.render.pixels.emplace_back();
  pixel.x = static_cast<std::int16_t>(item.center_x);
  pixel.y = static_cast<std::int16_t>(item.center_y);
  pixel.depth_m = item.depth_m;
}

std::shared_ptr<IterationTrace> matching(const MadeMatches& made_matches, double correction_px) {
  auto iteration = std::make_shared<IterationTrace>();
  iteration->kind = IterationKind::kMatch;
  iteration->reached = Stage::kFinished;
  iteration->correction_image_px = correction_px;
  for (int i = 0; i < made_matches.count; ++i) addMatch(made_matches, i, *iteration);
  iteration->template_count = iteration->correspondence_count = made_matches.count;
  iteration->pnp.inlier_count = made_matches.inliers;
  return iteration;
}

ReviewSubject subjectOf(const MadeMatches& made_matches, double last_px = 0.1) {
  ReviewSubject subject;
  subject.run.emplace();
  subject.run->status = LocalizationStatus::kConverged;
  subject.run->iterations.push_back(matching(made_matches, 20.0));
  auto last = std::make_shared<IterationTrace>();
  last->kind = IterationKind::kRefine;
  last->reached = Stage::kFinished;
  last->status = LocalizationStatus::kConverged;
  last->correction_image_px = last_px;
  subject.run->iterations.push_back(last);
  return subject;
}

std::vector<Check> checksOf(const ReviewSubject& subject, const CheckLimits& limits = {}) {
  return test::addedChecks(addRunChecks, subject, limits);
}

Check checkOf(const ReviewSubject& subject, const std::string& id) {
  return findCheck(checksOf(subject), id);
}

TEST(RunChecks, ARunThatDidNotConvergeFailsAndSaysHowItEnded) {
  ReviewSubject subject = subjectOf({});
  EXPECT_EQ(checkOf(subject, "converged").state, CheckState::kPassed);
  subject.run->status = LocalizationStatus::kLeftUncertainty;
  const Check check = checkOf(subject, "converged");
  EXPECT_EQ(check.state, CheckState::kFailed);
  EXPECT_THAT(check.sentence, testing::StartsWith("No pose found. "));
  EXPECT_THAT(check.sentence, HasSubstr("uncertainty"));
}

TEST(RunChecks, CorrectionsAreComparedWithTheFirstOne) {
  ReviewSubject below_a_pixel = subjectOf({}, 0.2);  // no less than a quarter pixel is asked for
  below_a_pixel.run->iterations.front() = matching({}, 0.01);
  for (const ReviewSubject& subject : {subjectOf({}, 4.0), below_a_pixel}) {
    const Check shrinks = checkOf(subject, "corrections_shrink");
    EXPECT_NEAR(shrinks.figure.value(), 20.0, 1e-9);
    EXPECT_EQ(shrinks.state, CheckState::kPassed);
  }
  EXPECT_EQ(checkOf(subjectOf({}, 6.0), "corrections_shrink").state, CheckState::kFailed);
  ReviewSubject failed_last = subjectOf({});
  failed_last.run->status = LocalizationStatus::kPnpFailed;
  auto failed = std::make_shared<IterationTrace>();
  failed->status = LocalizationStatus::kPnpFailed;
  failed_last.run->iterations.push_back(failed);
  EXPECT_EQ(checkOf(failed_last, "corrections_shrink").state, CheckState::kNotApplicable);
}

TEST(RunChecks, InliersAreCountedAndSetAgainstTheMatches) {
  CheckLimits limits;
  limits.inlier_count = 10;
  limits.inlier_ratio_percent = 26;
  const auto checks = checksOf(subjectOf({.count = 40, .inliers = 10}), limits);
  EXPECT_EQ(findCheck(checks, "inlier_count").figure, 10.0);
  EXPECT_EQ(findCheck(checks, "inlier_count").state, CheckState::kPassed);
  const Check ratio = findCheck(checks, "inlier_ratio");
  EXPECT_EQ(ratio.figure, 25.0);
  EXPECT_EQ(ratio.state, CheckState::kFailed);
  EXPECT_THAT(ratio.sentence, HasSubstr("10 of 40"));
}

TEST(RunChecks, InliersAtOneEndOfTheStation_Fail) {
  const Check all = checkOf(subjectOf({.count = 20, .inliers = 20}), "inlier_spread");
  EXPECT_NEAR(all.figure.value(), 100.0, 1e-6);
  const auto checks = checksOf(subjectOf({.count = 20, .inliers = 4}));
  EXPECT_LT(findCheck(checks, "inlier_spread").figure.value(), 30.0);
  EXPECT_EQ(findCheck(checks, "inlier_spread").state, CheckState::kFailed);
  // Depth grows with the index: 4 of 20 in a row have sqrt((16 - 1) / (400 - 1)) of the deviation.
  EXPECT_NEAR(findCheck(checks, "inlier_depth").figure.value(), 19.39, 0.01);
  EXPECT_EQ(findCheck(checks, "inlier_depth").state, CheckState::kFailed);
}

TEST(RunChecks, MatchesOnBordersAndMarginsOfScoresAreMeasured) {
  const Check check =
      checkOf(subjectOf({.count = 20, .inliers = 20, .at_border = 9}), "matches_at_border");
  EXPECT_NEAR(check.figure.value(), 45.0, 1e-9);
  EXPECT_EQ(check.side, LimitSide::kAtMost);
  EXPECT_EQ(check.state, CheckState::kFailed);
  EXPECT_NEAR(checkOf(subjectOf({.second_share = 60}), "peak_margin").figure.value(), 40.0, 1e-9);
  EXPECT_EQ(checkOf(subjectOf({.second_share = 99}), "peak_margin").state, CheckState::kFailed);
}

TEST(RunChecks, OnlyTheLastAttemptCounts) {
  ReviewSubject subject = subjectOf({}, 0.1);
  auto& iterations = subject.run->iterations;
  iterations.insert(iterations.begin(), matching({.inliers = 1}, 500.0));
  for (std::size_t i = 1; i < iterations.size(); ++i) {
    auto later = std::make_shared<IterationTrace>(*iterations[i]);
    later->attempt = 1;
    iterations[i] = later;
  }
  EXPECT_NEAR(checkOf(subject, "corrections_shrink").figure.value(), 0.5, 1e-9);
  EXPECT_EQ(checkOf(subject, "inlier_count").figure, 10.0);
}

TEST(RunChecks, RepeatedIterationOfAHypothesis_CountsAsTheAttemptOfTheHypothesis) {
  ReviewSubject subject = subjectOf({}, 0.1);
  subject.run->hypotheses.resize(2);
  auto& iterations = subject.run->iterations;
  auto original = std::make_shared<IterationTrace>(*iterations.back());
  original->camera_from_station_before.translation_m.x() = 0.1;
  iterations.back() = original;
  auto repeated = std::make_shared<IterationTrace>(*original);
  auto other = matching({.inliers = 1}, 500.0);
  other->attempt = 1;
  repeated->attempt = 2;
  iterations.push_back(other);
  iterations.push_back(repeated);
  EXPECT_NEAR(checkOf(subject, "corrections_shrink").figure.value(), 0.5, 1e-9);
  EXPECT_EQ(checkOf(subject, "inlier_count").figure, 10.0);
  EXPECT_EQ(lastInliers(*subject.run), 10);

  iterations.erase(iterations.begin());
  EXPECT_EQ(lastInliers(*subject.run), std::nullopt);
  EXPECT_THAT(checkOf(subject, "inlier_count").sentence,
              HasSubstr("No matching iteration led to the pose."));
}

/// Without refinement the repeated iteration matches again, at another threshold.
TEST(RunChecks, RepeatedMatchOfAHypothesis_ReplacesTheOriginal) {
  const auto ofAttempt = [](std::int32_t attempt, const MadeMatches& matches, double correction_px,
                            double before_m) {
    auto iteration = matching(matches, correction_px);
    iteration->attempt = attempt;
    iteration->camera_from_station_before.translation_m.x() = before_m;
    return iteration;
  };
  ReviewSubject subject;
  subject.run.emplace();
  subject.run->status = LocalizationStatus::kConverged;
  subject.run->hypotheses.resize(2);
  subject.run->iterations = {ofAttempt(0, {.count = 40, .inliers = 20}, 10.0, 0.0),
                             ofAttempt(0, {.count = 40, .inliers = 30}, 0.5, 0.1),
                             ofAttempt(1, {.count = 40, .inliers = 1}, 500.0, 0.2),
                             ofAttempt(2, {.count = 40, .inliers = 36}, 2.0, 0.1)};
  EXPECT_EQ(lastMatching(*subject.run), subject.run->iterations.back());
  EXPECT_EQ(lastInliers(*subject.run), 36);
  EXPECT_EQ(checkOf(subject, "inlier_count").figure, 36.0);
  EXPECT_EQ(checkOf(subject, "inlier_ratio").figure, 90.0);
  EXPECT_NEAR(checkOf(subject, "corrections_shrink").figure.value(), 20.0, 1e-9);
  EXPECT_EQ(decisiveIterations(*subject.run).size(), 2u) << "the first and the repeated one";
}

/// That the checks are the same in the same order is a test of checkPose.
TEST(RunChecks, WithoutARunOrAMatching_AreNotApplicable) {
  ReviewSubject subject;
  for (const Check& check : checksOf(subject)) {
    EXPECT_EQ(check.state, CheckState::kNotApplicable) << check.id;
    EXPECT_FALSE(check.sentence.empty()) << check.id;
  }
  subject.run.emplace();
  subject.run->status = LocalizationStatus::kTooFewMatches;
  for (const Check& check : checksOf(subject)) EXPECT_NE(check.state, CheckState::kPassed);
}

using Points = std::vector<Eigen::Vector2d>;

/// A grid of 11 x 11 points over `width` x `height` px, turned by 30 deg.
Points grid(double width, double height) {
  Points points;
  for (int i = 0; i <= 10; ++i)
    for (int j = 0; j <= 10; ++j) {
      const Eigen::Vector2d flat(width * (i / 10.0 - 0.5), height * (j / 10.0 - 0.5));
      points.emplace_back(0.866 * flat.x() - 0.5 * flat.y() + 100.0,
                          0.5 * flat.x() + 0.866 * flat.y() + 50.0);
    }
  return points;
}

TEST(InlierSpread, IsTheLeastOverAllDirections) {
  EXPECT_NEAR(leastSpread(grid(200, 100), grid(200, 100), 1.0).value(), 1.0, 1e-9);
  // Half as wide one way, as wide the other: neither axis is one of the image's.
  EXPECT_NEAR(leastSpread(grid(100, 100), grid(200, 100), 0.0).value(), 0.5, 1e-3);
  EXPECT_NEAR(leastSpread(grid(200, 30), grid(200, 100), 0.0).value(), 0.3, 1e-3);
  EXPECT_LT(leastSpread(grid(200, 0), grid(200, 100), 1.0).value(), 0.05) << "a line";
  EXPECT_GT(leastSpread(grid(200, 0), grid(200, 0.5), 1.0).value(), 0.9) << "all are on it";
  EXPECT_FALSE(leastSpread(Points{{1.0, 2.0}}, grid(10, 10), 1.0));
  EXPECT_FALSE(leastSpread(grid(10, 10), Points(), 1.0));
}

TEST(InlierSpread, DeviationAndMedian) {
  const std::vector<double> values = {4.0, 1.0, 3.0, 2.0};
  EXPECT_DOUBLE_EQ(medianOf(values), 2.0);
  EXPECT_NEAR(deviationOf(values), 1.118033988749895, 1e-12);
  EXPECT_EQ(deviationOf(std::vector<double>{7.0}), 0.0);
}

}  // namespace
}  // namespace boresight::sessions
