// SPDX-License-Identifier: Apache-2.0
#include "sessions/review/run_difference.h"

#include <gtest/gtest.h>

#include <stop_token>
#include <utility>

#include "sessions/session/session_maker.h"
#include "tests/support/example_case.h"
#include "tests/support/matchers.h"
#include "tests/support/temporary_folder.h"

namespace boresight::sessions {
namespace {

RunSide converged(int failed, std::optional<double> error_share = {}) {
  RunSide side;
  side.digest = "of " + std::to_string(failed) + " " + std::to_string(error_share.value_or(-1.0));
  side.converged = true;
  side.checks_failed = failed;
  side.error_share = error_share;
  return side;
}

RunSide failedRun() {
  RunSide side = converged(5);
  side.digest = "failed";
  side.converged = false;
  return side;
}

RunChange changeBetween(const RunSide& before, const RunSide& after) {
  RunDifference run_difference;
  run_difference.before = before;
  run_difference.after = after;
  judgeChange(run_difference);
  EXPECT_FALSE(run_difference.why.empty());
  return run_difference.change;
}

/// Each of a list from the best to the worst is better than every later one.
void expectOrdered(const std::vector<RunSide>& sides) {
  for (std::size_t i = 0; i < sides.size(); ++i)
    for (std::size_t j = 0; j < sides.size(); ++j) {
      const RunChange expected = i < j   ? RunChange::kWorse
                                 : j < i ? RunChange::kBetter
                                         : RunChange::kSame;
      EXPECT_EQ(changeBetween(sides[i], sides[j]), expected) << i << " to " << j;
    }
}

TEST(RunChangeTest, JudgesByTheTruthWhereItIsKnownAndByTheChecksElsewhere) {
  // The checks say otherwise: the truth decides.
  expectOrdered({converged(9, 0.4), failedRun(), converged(0, 1.5), converged(0, 4.0)});
  expectOrdered({converged(0), converged(1), converged(3), failedRun()});
  EXPECT_EQ(changeBetween(converged(0, 0.1), converged(2, 0.9)), RunChange::kSame)
      << "right both times";
  EXPECT_EQ(changeBetween(converged(0, 2.00), converged(0, 2.05)), RunChange::kSame)
      << "less than a tenth of the requirement";
}

RunDifference differenceOf(const RunSide& before, const RunSide& after) {
  RunDifference difference;
  difference.case_id = "a";
  difference.before = before;
  difference.after = after;
  judgeChange(difference);
  return difference;
}

TEST(RunChangeTest, AnAcceptedWrongMesh_IsWorseThanAFailedRun) {
  RunSide wrong = converged(0, 0.1);
  wrong.wrong_mesh = true;
  EXPECT_EQ(changeBetween(failedRun(), wrong), RunChange::kWorse);
  EXPECT_EQ(changeBetween(wrong, failedRun()), RunChange::kBetter);
  EXPECT_EQ(differenceOf(wrong, failedRun()).why, "accepted on a wrong mesh before, now failed");
  RunSide unknown = converged(0);
  unknown.wrong_mesh = true;
  unknown.digest = "unknown";
  EXPECT_EQ(changeBetween(wrong, unknown), RunChange::kSame) << "both are wrong, by no figure";
}

TEST(RunChangeTest, PoseAtTheRequirement_IsRight) {
  EXPECT_EQ(changeBetween(converged(0, 0.2), converged(0, 1.0)), RunChange::kSame);
  EXPECT_EQ(changeBetween(converged(0, 1.0), converged(0, 1.01)), RunChange::kWorse);
  EXPECT_EQ(changeBetween(converged(0, 2.0), converged(0, 2.125)), RunChange::kWorse);
  EXPECT_EQ(changeBetween(converged(0, 2.125), converged(0, 2.0)), RunChange::kBetter);
  EXPECT_EQ(changeBetween(converged(0, 2.0), converged(0, 2.09)), RunChange::kSame);
}

TEST(RunChangeTest, Reason_NamesBothSides) {
  EXPECT_EQ(differenceOf(converged(0, 0.5), converged(3, 1.5)).why,
            "error 50 % of the requirement before, now error 150 % of the requirement");
  EXPECT_EQ(differenceOf(failedRun(), converged(3, 0.25)).why,
            "failed before, now error 25 % of the requirement");
  EXPECT_EQ(differenceOf(converged(0), converged(1)).why,
            "all checks passed before, now 1 check failed");
  EXPECT_EQ(differenceOf(converged(2), failedRun()).why,
            "2 checks failed before, now the run failed");
  RunSide again = converged(2);
  again.digest = "again";
  EXPECT_EQ(differenceOf(converged(2), again).why, "2 checks failed before and now");
  EXPECT_EQ(differenceOf(again, again).why, "bit for bit");
}

TEST(DifferenceText, HasALinePerThingThatChanged) {
  RunSide before = converged(1, 0.5);
  before.status = "converged";
  before.iterations = 9;
  before.inliers = 31;
  before.checks_passed = 20;
  RunSide after = failedRun();
  after.status = "pnp_failed";
  after.iterations = 4;
  after.inliers = 3;
  after.checks_passed = 2;
  RunDifference difference = differenceOf(before, after);
  const auto lines = [&difference] {
    std::vector<std::string> texts;
    for (const DifferenceLine& line : differenceLines(difference))
      texts.push_back(line.label + " | " + line.before + " | " + line.after);
    return texts;
  };
  EXPECT_THAT(lines(),
              ElementsAre("Status | converged, 9 iterations | pnp_failed, 4 iterations",
                          "Inliers | 31 | 3", "Checks | 20 passed, 1 failed | 2 passed, 5 failed"));
  difference.after.inliers.reset();
  EXPECT_THAT(lines(), Contains("Inliers | 31 | -")) << "no matching iteration led to its pose";
  difference.before.error.emplace();
  difference.before.error->normal_mm = 1.5;
  difference.before.error->lateral_mm = 2.25;
  difference.before.error->rotation_mrad = 0.125;
  difference.checks = {{"Coverage", CheckState::kPassed, CheckState::kNotApplicable}};
  difference.options = {{"pnp.seed", "1", "2"}};
  EXPECT_THAT(lines(), testing::IsSupersetOf(
                           {"Error: along, across, rotation | 1.50 mm, 2.25 mm, 0.12 mrad | -",
                            "Coverage | passed | not applicable", "pnp.seed | 1 | 2"}));
  std::swap(difference.before.error, difference.after.error);
  EXPECT_THAT(lines(),
              Contains("Error: along, across, rotation | - | 1.50 mm, 2.25 mm, 0.12 mrad"));
  EXPECT_THAT(differenceText(difference), Not(HasSubstr("Final poses")));
  difference.after.converged = true;
  difference.comparison.translation_mm = 1.25;
  difference.comparison.rotation_mrad = 0.5;
  EXPECT_THAT(differenceText(difference),
              HasSubstr("Final poses 1.250 mm and 0.500 mrad apart at the camera.\n"));
  difference.before.converged = false;
  EXPECT_THAT(differenceText(difference), Not(HasSubstr("Final poses")));
  EXPECT_EQ(changeText(difference), "Worse: error 50 % of the requirement before, now failed.");
  difference.inputs_differ = true;
  difference.comparison.first = FirstDifference{RunPart::kSeed, -1, -1, "the seeds differ"};
  EXPECT_EQ(changeText(difference),
            "Worse: error 50 % of the requirement before, now failed. The inputs of the runs "
            "differ. First difference: seed: the seeds differ.");
}

TEST(OptionChangesTest, EachChangedOption_IsListedWithItsUnit) {
  LocalizerOptions before;
  LocalizerOptions after = before;
  EXPECT_THAT(optionChanges(before, after), IsEmpty());
  after.pnp.min_inliers = 99;
  after.loop.inlier_threshold_px = 7.5;
  after.search.enabled = !before.search.enabled;
  const auto changes = optionChanges(before, after);
  ASSERT_THAT(changes, SizeIs(3));
  for (const OptionChangeText& change : changes) {
    EXPECT_NE(change.before, change.after) << change.name;
    if (change.name == "pnp.min_inliers") {
      EXPECT_EQ(change.after, "99");
    }
    if (change.name == "loop.inlier_threshold_px") {
      EXPECT_EQ(change.after, "7.5 px");
    }
  }
}

class RunDifferenceTest : public ::testing::Test {
 protected:
  std::string run(const OptionList& options) {
    Session with = session_;
    with.options = options;
    const LocalizationTrace trace = runCase(with, id_);
    session_ = withRun(session_, storeRun(with, id_, trace, folder_.path() / "s.boresight.json"));
    return trace.digest;
  }
  RunDifference compare() const {
    const auto pair = lastTwoRuns(session_, id_);
    return compareRuns(session_, pair->before->digest, pair->after->digest,
                       loadCase(*session_.findCase(id_)));
  }

  test::TemporaryFolder folder_;
  Session session_ = makeSession(test::exampleFolder() / "dataset.json");
  std::string id_ = session_.cases[0]->id;
};

TEST_F(RunDifferenceTest, NamesTheOptionTheFirstDifferenceAndWhoIsBetter) {
  const std::string first = run({});
  EXPECT_FALSE(lastTwoRuns(session_, id_)) << "one run has none before it";
  const std::string second = run({{"support.min_probability", 1.0}});
  const RunDifference run_difference = compare();
  EXPECT_EQ(run_difference.before.digest, first);
  EXPECT_EQ(run_difference.after.digest, second);
  ASSERT_EQ(run_difference.options.size(), 1u);
  EXPECT_EQ(run_difference.options[0].name, "support.min_probability");
  EXPECT_EQ(run_difference.options[0].after, "1");
  ASSERT_TRUE(run_difference.comparison.first);
  EXPECT_EQ(run_difference.comparison.first->part, RunPart::kOptions);
  EXPECT_TRUE(run_difference.before.converged);
  EXPECT_FALSE(run_difference.after.converged);
  EXPECT_EQ(run_difference.change, RunChange::kWorse);
  ASSERT_TRUE(run_difference.before.error);
  const SessionCase& session_case = *session_.findCase(id_);
  const PoseError error = poseError(*session_case.camera_from_station_truth,
                                    loadRun(session_.runs[0]).camera_from_station,
                                    session_case.camera_from_end_effector);
  EXPECT_DOUBLE_EQ(run_difference.before.error->lateral_mm, error.lateral_mm);
  EXPECT_FALSE(run_difference.after.error);
  for (const CheckChange& check : run_difference.checks)
    EXPECT_NE(check.before, check.after) << check.title;
  EXPECT_THAT(run_difference.checks,
              Contains(AllOf(testing::Field(&CheckChange::before, CheckState::kPassed),
                             testing::Field(&CheckChange::after, CheckState::kFailed))));
  EXPECT_THAT(differenceText(run_difference), HasSubstr("support.min_probability"));
  EXPECT_THAT(changeText(run_difference), StartsWith("Worse"));
}

TEST_F(RunDifferenceTest, RunListLines_OfAnotherSeedAndOption_NameBothAndTheDistance) {
  run({});
  const auto loaded = loadCase(*session_.findCase(id_));
  session_ = withChanged(session_, id_, [](SessionCase& changed) {
    changed.camera_from_station_seed.translation_m.x() += 1e-3;
  });
  run({{"pnp.min_inliers", std::int64_t{13}}});
  EXPECT_TRUE(compare().inputs_differ);
  EXPECT_THAT(changeText(compare()), HasSubstr("The inputs of the runs differ"));
  const auto linesOfRuns = [&] {
    return runListLines(std::vector<RunRecord>(session_.runs.begin(), session_.runs.end()),
                        *loaded);
  };
  std::vector<RunListLine> lines = linesOfRuns();
  ASSERT_EQ(lines.size(), 2u);
  EXPECT_EQ(lines[0].changed, "") << "no run is before it";
  EXPECT_THAT(lines[1].changed, testing::MatchesRegex("inputs, pnp\\.min_inliers .+ -> 13"));
  ASSERT_TRUE(lines[1].moved);
  const Pose first = loadRun(session_.runs[0]).camera_from_station;
  const Pose second = loadRun(session_.runs[1]).camera_from_station;
  EXPECT_NEAR(lines[1].moved->rotation_deg,
              first.rotation.angularDistance(second.rotation) / kDegree_rad, 1e-9);
  EXPECT_TRUE(lines[1].moved->projection_px);
  std::filesystem::remove(session_.runs[0].file);
  lines = linesOfRuns();
  EXPECT_FALSE(lines[1].moved);
  EXPECT_EQ(lines[1].changed, "inputs");
}

/// Three options are named; of more, two and the number of the others.
TEST_F(RunDifferenceTest, RunListLines_OfManyOptions_CountTheOthers) {
  const OptionList three = {{"pnp.min_inliers", std::int64_t{13}},
                            {"pnp.seed", std::int64_t{5}},
                            {"support.min_support", 0.1}};
  OptionList four = three;
  four.emplace_back("refinement.enabled", false);
  OptionList other = {{"loop.max_iterations", std::int64_t{30}}};
  run(four);
  run(other);
  other.insert(other.end(), three.begin(), three.end());
  run(other);
  other.emplace_back("refinement.enabled", false);
  run(other);
  const std::vector<RunRecord> runs(session_.runs.begin(), session_.runs.end());
  const auto loaded = loadCase(*session_.findCase(id_));
  const auto lines = runListLines(runs, *loaded);
  ASSERT_EQ(lines.size(), 4u);
  EXPECT_THAT(lines[1].changed, testing::EndsWith(" and 3 other options"));
  EXPECT_THAT(lines[2].changed, AllOf(HasSubstr("pnp.min_inliers"), HasSubstr("pnp.seed"),
                                      HasSubstr("support.min_support"), Not(HasSubstr("other"))));
  EXPECT_EQ(lines[3].changed, "refinement.enabled true -> false");
  std::stop_source stop;
  stop.request_stop();
  EXPECT_EQ(runListLines(runs, *loaded, stop.get_token())[1].changed, "");
}

TEST_F(RunDifferenceTest, PoseDistanceText_GivesMillimetresDegreesAndPixels) {
  const auto loaded = loadCase(*session_.findCase(id_));
  Pose moved = *loaded->source.camera_from_station_truth;
  moved.translation_m.z() += 2e-3;
  const PoseDistance distance =
      poseDistance(*loaded, *loaded->source.camera_from_station_truth, moved);
  EXPECT_NEAR(distance.translation_mm, 2.0, 1e-9);
  EXPECT_EQ(poseDistanceText({2.0, 0.0, std::nullopt}), "2.00 mm, 0.000 deg");
  EXPECT_EQ(poseDistanceText({0.12, 0.034, 0.84}), "0.12 mm, 0.034 deg, 0.8 px");
}

TEST_F(RunDifferenceTest, ATruthThatIsCoarserThanTheRequirementDoesNotJudge) {
  run({});
  run({{"loop.max_iterations", std::int64_t{30}}});
  EXPECT_TRUE(compare().after.error_share);
  session_ = withChanged(session_, id_, [](SessionCase& changed) {
    changed.truth_covariance = 1e-4 * Matrix6d::Identity();
  });
  const RunDifference run_difference = compare();
  EXPECT_TRUE(run_difference.after.error);
  EXPECT_FALSE(run_difference.after.error_share);
}

TEST_F(RunDifferenceTest, RefusesRunsThatTheCaseDoesNotHave) {
  const std::string digest = run({});
  const auto loaded = loadCase(*session_.findCase(id_));
  EXPECT_THROW(compareRuns(session_, digest, std::string(64, '0'), loaded), std::invalid_argument);
  const RunDifference same = compareRuns(session_, digest, digest, loaded);
  EXPECT_EQ(same.change, RunChange::kSame);
  EXPECT_EQ(same.why, "bit for bit");
  EXPECT_FALSE(same.inputs_differ);
  EXPECT_TRUE(same.options.empty());
  EXPECT_EQ(same.comparison.verdict, RunVerdict::kEqual);
}

}  // namespace
}  // namespace boresight::sessions
