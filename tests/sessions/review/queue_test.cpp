// SPDX-License-Identifier: Apache-2.0
#include "sessions/review/queue.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <mutex>
#include <stdexcept>

#include "sessions/decision/check_limits.h"
#include "sessions/review/thumbnail.h"
#include "sessions/session/session_maker.h"
#include "tests/sessions/review/judged_case.h"
#include "tests/support/example_case.h"
#include "tests/support/matchers.h"
#include "tests/support/temporary_folder.h"

namespace boresight::sessions {
namespace {

/// Few values each, so that ties are common.
QueueRow randomRow(Random& random, int number) {
  const auto pick = [&random](unsigned count) { return static_cast<int>(random.below(count)); };
  QueueRow row;
  row.case_id = "case " + std::to_string(number);
  row.group = static_cast<QueueGroup>(pick(5));
  row.failed = pick(3);
  if (pick(3) > 0) row.margin = (row.failed > 0 ? -1.0 : 1.0) * pick(3);
  if (pick(3) > 0) row.from_seed = SeedDistance{0.0, 0.0, 0.5 * pick(3)};
  return row;
}

/// The documented order, said once more without tuples.
bool comesFirst(const QueueRow& a, const QueueRow& b) {
  if (a.group != b.group) return a.group < b.group;
  if (a.failed != b.failed) return a.failed > b.failed;
  if (a.margin.has_value() != b.margin.has_value())
    return a.failed > 0 ? !a.margin.has_value() : a.margin.has_value();
  if (a.margin && *a.margin != *b.margin) return *a.margin < *b.margin;
  const double value = a.from_seed ? a.from_seed->share : 0.0;
  const double other = b.from_seed ? b.from_seed->share : 0.0;
  return value != other ? value > other : a.case_id < b.case_id;
}

TEST(QueueOrder, IsTheDocumentedOne) {
  Random random(11);
  std::vector<QueueRow> rows;
  for (int i = 0; i < 120; ++i) rows.push_back(randomRow(random, i));
  for (const QueueRow& a : rows)
    for (const QueueRow& b : rows)
      EXPECT_EQ(moreTrouble(a, b), comesFirst(a, b)) << a.case_id << ", " << b.case_id;
  EXPECT_LT(QueueGroup::kNoPose, QueueGroup::kOpen) << "failed runs come first";
  EXPECT_LT(QueueGroup::kOpen, QueueGroup::kDecided) << "and decided ones last";
}

Check figure(double value, double limit, LimitSide side) {
  Check check;
  check.figure = value;
  check.limit = limit;
  check.side = side;
  return check;
}

TEST(CheckMargin, IsRelativeToTheLimitAndNegativeBeyondIt) {
  EXPECT_DOUBLE_EQ(*checkMargin(figure(3.0, 4.0, LimitSide::kAtMost)), 0.25);
  EXPECT_DOUBLE_EQ(*checkMargin(figure(6.0, 4.0, LimitSide::kAtMost)), -0.5);
  EXPECT_DOUBLE_EQ(*checkMargin(figure(6.0, 4.0, LimitSide::kAtLeast)), 0.5);
  EXPECT_DOUBLE_EQ(*checkMargin(figure(0.0, 4.0, LimitSide::kAtLeast)), -1.0);
  EXPECT_DOUBLE_EQ(*checkMargin(figure(0.5, 1.0, LimitSide::kAtMost)), 0.5);
  EXPECT_DOUBLE_EQ(*checkMargin(figure(-3.0, -4.0, LimitSide::kAtMost)), -0.25);
  EXPECT_FALSE(checkMargin(figure(0.0, 0.0, LimitSide::kAtMost)));
  EXPECT_FALSE(checkMargin(figure(NAN, 1.0, LimitSide::kAtMost)));
  EXPECT_FALSE(checkMargin(Check()));
}

TEST(SeedDistanceTest, IsWhatThePoseWasDisplacedByAboutThePivot) {
  Random random(3);
  for (int i = 0; i < 50; ++i) {
    const Pose seed = test::randomPose(random);
    SeedUncertainty uncertainty;
    uncertainty.pivot_in_camera_m = Eigen::Vector3d(0.1, -0.2, 1.5);
    uncertainty.translation_m = {0.01, 0.02, 0.0};  // the third axis is not allowed to move
    uncertainty.rotation_rad = {0.1, 0.2, 0.3};
    Vector6d offset;
    offset << 0.05, -0.02, 0.03, 0.004, 0.016, -0.002;
    const Pose pose = displacedAboutPivot(seed, offset, uncertainty.pivot_in_camera_m);
    const SeedDistance seed_distance = seedDistance(seed, pose, uncertainty);
    EXPECT_NEAR(seed_distance.rotation_mrad,
                1e3 * std::sqrt(0.05 * 0.05 + 0.02 * 0.02 + 0.03 * 0.03), 1e-6);
    EXPECT_NEAR(seed_distance.translation_mm, std::sqrt(16.0 + 256.0 + 4.0), 1e-6);
    EXPECT_NEAR(seed_distance.share, 0.8, 1e-9);
  }
}

TEST(QueueRowTest, Row_SeparatesValidFromInvalidDecisions) {
  Random random(5);
  test::JudgedCase judged(random);
  QueueRow row;
  row.case_id = "a";
  row.run_digest = judged.subject.run->digest;
  takeReviewStatus(judged.session, row);
  EXPECT_EQ(row.group, QueueGroup::kOpen);
  Session decided = judged.validatedBy("Ada");
  takeReviewStatus(decided, row);
  EXPECT_EQ(row.group, QueueGroup::kDecided);
  EXPECT_THAT(troubleText(row), HasSubstr("Ada"));
  decided.review.second_person = true;
  takeReviewStatus(decided, row);
  EXPECT_EQ(row.group, QueueGroup::kAwaits);
  judged.session = judged.validatedBy("Ada");
  judged.noteRun(test::randomSha256(random), "converged", random);
  takeReviewStatus(judged.session, row);
  EXPECT_EQ(row.group, QueueGroup::kOpen) << "there is a later run";
}

TEST(QueueRowTest, RowKey_ChangesWithEveryInput) {
  Random random(6);
  test::JudgedCase judged(random);
  const std::string before = queueKey(judged.session, "a");
  EXPECT_EQ(queueKey(judged.validatedBy("Ada"), "a"), before) << "a decision changes no check";
  Session other = judged.session;
  other.review.preset = checkPresets().back().name;
  other.review.limits = {{"check.inlier_count", 99.0}};
  EXPECT_NE(queueKey(other, "a"), before);
  judged.noteRun(test::randomSha256(random), "converged", random);
  EXPECT_NE(queueKey(judged.session, "a"), before);
}

/// A row as `whs check` prints it, with every figure another.
QueueRow rowWithFigures() {
  QueueRow row;
  row.case_id = "a";
  row.group = QueueGroup::kOpen;
  row.review_state = ReviewState::kConverged;
  row.run_digest = "0123";
  row.passed = 20;
  row.margin = 0.125;
  row.margin_of = "Inliers";
  row.from_seed = SeedDistance{1.25, 2.5, 0.75};
  row.inliers = 31;
  row.iterations = 9;
  row.opens_at = 6;
  return row;
}

TEST(TroubleText, SaysWhatToDoAboutACase) {
  QueueRow row = rowWithFigures();
  EXPECT_EQ(troubleText(row), "20 checks passed, margin 12 %: Inliers");
  row.margin.reset();
  EXPECT_EQ(troubleText(row), "20 checks passed");
  row.checks = {figure(1.0, 2.0, LimitSide::kAtMost), figure(1.0, 2.0, LimitSide::kAtMost),
                figure(1.0, 2.0, LimitSide::kAtMost)};
  row.checks[0].title = "Coverage";
  row.checks[1].title = "Sigma";
  row.checks[2].title = "Clutter";
  row.checks[1].state = CheckState::kPassed;
  row.checks[0].state = CheckState::kFailed;
  row.failed = 1;
  EXPECT_EQ(troubleText(row), "1 check failed: Coverage");
  row.checks[2].state = CheckState::kFailed;
  row.failed = 2;
  EXPECT_EQ(troubleText(row), "2 checks failed: Coverage, Clutter");
  row.trouble = "the run failed";
  EXPECT_EQ(troubleText(row), "the run failed");
  row.group = QueueGroup::kDecided;
  row.review_status_text = "validated by Ada";
  EXPECT_EQ(troubleText(row), "validated by Ada");
  row.group = QueueGroup::kAwaits;
  EXPECT_EQ(troubleText(row), "a second person must approve");
  row = {};
  EXPECT_EQ(troubleText(row), "not run yet");
  row.margin = 0.25;
  EXPECT_EQ(troubleText(row),
            "not run in this session; in the results: error 75 % of the requirement");
}

TEST(QueueTable, HasEveryFigureInItsUnit) {
  const std::string text = queueText({rowWithFigures(), QueueRow()});
  EXPECT_THAT(text, testing::ContainsRegex(
                        "\na +converged +0 +20 +12 % +1\\.25 +2\\.50 +75 % +31 +7/9 *\n"));
  EXPECT_THAT(text, testing::ContainsRegex("\n +new +0 +0 +- +- +- +- +- +- *\n"));
  EXPECT_THAT(text, HasSubstr("\na: 20 checks passed, margin 12 %: Inliers\n"));
}

TEST(QueueTable, CsvHasAllDigits) {
  EXPECT_EQ(
      queueCsv({rowWithFigures(), QueueRow()}),
      "case,state,checks_failed,checks_passed,margin,margin_of,from_seed_mm,from_seed_mrad,"
      "from_seed_share,inliers,iterations,look_at_iteration,run,trouble\r\n"
      "a,converged,0,20,0.125,Inliers,1.25,2.5,0.75,31,9,7,0123,\"20 checks passed, margin 12 "
      "%: Inliers\"\r\n"
      ",new,0,0,,,,,,,0,,,not run yet\r\n");
  QueueRow first = rowWithFigures();
  first.opens_at = 0;
  EXPECT_THAT(queueCsv({first}), HasSubstr(",31,9,1,0123,"));
  EXPECT_THAT(queueText({first}), HasSubstr(" 1/9"));
}

TEST(QueueRowTest, RowKey_ChangesWithTheRunsOfTheRig) {
  Random random(8);
  test::JudgedCase judged(random);
  SessionCase session_case = *judged.session.findCase("a");
  session_case.rig = Rig{"rig", Pose()};
  judged.session = withCase(judged.session, session_case);
  session_case.id = "b";
  judged.session = withCase(judged.session, session_case);
  const std::string before = queueKey(judged.session, "a");
  EXPECT_NE(queueKey(judged.session, "b"), before);
  judged.session.runs.push_back(test::randomRun(random, "b"));
  const std::string with_run = queueKey(judged.session, "a");
  EXPECT_NE(with_run, before);
  judged.session.runs.back().digest = test::randomSha256(random);
  EXPECT_NE(queueKey(judged.session, "a"), with_run);
  judged.session.runs.back().together =
      TogetherRecord{{{"b", "converged"}, {"a", "converged"}}, ""};
  const std::string together = queueKey(judged.session, "a");
  judged.session.runs.back().digest = test::randomSha256(random);
  EXPECT_NE(queueKey(judged.session, "a"), together) << "its run is that of the row's case, too";
}

TEST(QueueRowTest, UnreadableCase_HasTheReasonAsTrouble) {
  Random random(9);
  test::JudgedCase judged(random);
  EXPECT_THROW((void)queueRow(judged.session, "none"), std::invalid_argument);
  const QueueRow unread = queueRow(judged.session, "a", nullptr, "it is locked");
  EXPECT_EQ(unread.group, QueueGroup::kNoPose);
  EXPECT_EQ(unread.run_digest, judged.subject.run->digest);
  EXPECT_EQ(troubleText(unread), "it is locked");
  EXPECT_FALSE(unread.subject);
  EXPECT_EQ(queueRow(judged.session, "a").group, QueueGroup::kNoPose) << "its image is not there";
  judged.session.runs.clear();
  EXPECT_EQ(queueRow(judged.session, "a").group, QueueGroup::kNotRun);
  EXPECT_EQ(troubleText(queueRow(judged.session, "a", nullptr, "it is locked")), "it is locked");
}

TEST(QueueRowTest, FaultInTheProgress_ReachesTheCaller) {
  Random random(10);
  test::JudgedCase judged(random);
  for (const int jobs : {-1, 0, 1, 3})
    EXPECT_THROW((void)queueRows(judged.session, jobs, {},
                                 [](const QueueRow&, std::size_t, std::size_t) {
                                   throw std::runtime_error("no room");
                                 }),
                 std::runtime_error);
  EXPECT_EQ(queueRows(judged.session, 0).size(), 1u);
  EXPECT_THAT(queueRows({}), IsEmpty());
}

/// The example's cases: one run as it is, one that cannot converge, one whose image is gone.
struct ExampleQueue {
  test::TemporaryFolder folder;
  Session session = makeSession(test::exampleFolder() / "dataset.json");

  ExampleQueue() {
    SessionCase lost = *session.cases[0];
    lost.id = "lost";
    run(session.cases[0]->id, session);
    Session strict = session;
    strict.options = {{"pnp.min_inliers", std::int64_t{100}}, {"refinement.enabled", false}};
    run(session.cases[1]->id, strict);
    session = withCase(session, lost);
    run("lost", session);
    lost.image.source.file = folder / "gone.png";
    session = withCase(session, lost);
    lost.id = "new";
    session = withCase(session, lost);
  }
  void run(const std::string& id, const Session& with) {
    const LocalizationTrace trace = runCase(with, id);
    session = withRun(session, storeRun(with, id, trace, folder / "s.boresight.json"));
  }
};

const Session& exampleQueue() {
  static const ExampleQueue queue;
  return queue.session;
}

const QueueRow& rowOf(const std::vector<QueueRow>& rows, const std::string& id) {
  return *std::find_if(rows.begin(), rows.end(),
                       [&](const QueueRow& row) { return row.case_id == id; });
}

/// The margin of a row is the least of its checks in this state.
void expectNearestMargin(const QueueRow& row, CheckState state) {
  ASSERT_TRUE(row.margin);
  bool found = false;
  for (const Check& check : row.checks) {
    const auto margin = checkMargin(check);
    if (check.state != state || !margin) continue;
    EXPECT_GE(*margin, *row.margin) << check.title;
    found |= *margin == *row.margin && check.title == row.margin_of;
  }
  EXPECT_TRUE(found) << row.margin_of;
}

TEST(QueueOfExample, ListsTroubleFirstWithItsReason) {
  const Session& session = exampleQueue();
  std::size_t told = 0;
  const auto rows =
      queueRows(session, 2, {}, [&](const QueueRow&, std::size_t done, std::size_t of) {
        EXPECT_EQ(done, ++told);
        EXPECT_EQ(of, 4u);
      });
  ASSERT_EQ(rows.size(), 4u);
  EXPECT_EQ(told, 4u);
  EXPECT_TRUE(std::is_sorted(rows.begin(), rows.end(), moreTrouble));
  EXPECT_EQ(rows.back().case_id, "new");
  EXPECT_EQ(rows[2].case_id, session.cases[0]->id) << "what converged comes after what did not";
  const QueueRow& failed = rowOf(rows, session.cases[1]->id);
  const LocalizationTrace trace = loadRun(*session.lastRunOf(failed.case_id));
  ASSERT_FALSE(trace.converged());
  EXPECT_EQ(failed.group, QueueGroup::kNoPose);
  EXPECT_THAT(troubleText(failed), HasSubstr("100"));
  ASSERT_GE(failed.opens_at, 0);
  EXPECT_NE(trace.iterations[static_cast<std::size_t>(failed.opens_at)]->status,
            LocalizationStatus::kRunning);
  EXPECT_FALSE(failed.from_seed) << "the seed stands in for a pose that there is not";
  EXPECT_THAT(troubleText(rowOf(rows, "lost")), HasSubstr("gone.png"));
  EXPECT_EQ(troubleText(rowOf(rows, "new")), "not run yet");
}

TEST(QueueOfExample, ARowSufficesToDecide) {
  const Session& session = exampleQueue();
  const std::string id = session.cases[0]->id;
  const QueueRow row = queueRow(session, id);
  EXPECT_EQ(row.failed + row.passed,
            std::count_if(row.checks.begin(), row.checks.end(), [](const Check& check) {
              return check.state != CheckState::kNotApplicable;
            }));
  ASSERT_EQ(row.failed, 0) << troubleText(row);
  EXPECT_THAT(troubleText(row), testing::MatchesRegex("[0-9]+ checks passed, margin [0-9]+ %: .*"));
  expectNearestMargin(row, CheckState::kPassed);
  const LocalizationTrace trace = loadRun(*session.lastRunOf(id));
  EXPECT_EQ(row.run_digest, trace.digest);
  EXPECT_EQ(row.iterations, static_cast<int>(trace.iterations.size()));
  EXPECT_EQ(row.opens_at, row.iterations - 1) << "the last one";
  EXPECT_GT(row.inliers, 12);
  ASSERT_TRUE(row.from_seed);
  EXPECT_GT(row.from_seed->share, 0.0);
  EXPECT_LT(row.from_seed->share, 1.0);
  EXPECT_THAT(row.subject->loaded->image.pixels, IsEmpty()) << "rows are kept without data";
  EXPECT_THAT(row.subject->run->iterations, IsEmpty());
  EXPECT_FALSE(row.subject->run->edges);
  const Session after = validated(session, *row.subject, row.checks, {}, {"Ada", "as drawn"});
  EXPECT_EQ(reviewStatusOf(after, id).state, ReviewState::kValidated);
  EXPECT_EQ(after.decisions.back().pose->camera_from_station,
            loadRun(*session.lastRunOf(id)).camera_from_station);
}

/// Of the failed checks, the margin of a row is that of the worst.
TEST(QueueOfExample, FailedChecks_GiveTheMarginAndAChangedSeedTheTrouble) {
  Session session = exampleQueue();
  const std::string id = session.cases[0]->id;
  session.review.limits = {{"check.coverage_percent", 100.0}, {"check.inlier_count", 9000.0}};
  const QueueRow row = queueRow(session, id);
  EXPECT_EQ(row.failed, 2);
  EXPECT_EQ(row.group, QueueGroup::kOpen);
  expectNearestMargin(row, CheckState::kFailed);
  EXPECT_LT(*row.margin, -0.9) << "of 9,000 inliers, that are not there";
  session = withChanged(session, id, [](SessionCase& item) {
    item.camera_from_station_seed.translation_m.x() += 1e-3;
  });
  const QueueRow stale = queueRow(session, id);
  EXPECT_EQ(stale.group, QueueGroup::kNoPose);
  EXPECT_THAT(troubleText(stale), HasSubstr("inputs have changed since the run"));
}

TEST(QueueOfExample, AStopLeavesOutWhatHasNotBegun) {
  std::stop_source stop;
  const auto rows =
      queueRows(exampleQueue(), 1, stop.get_token(),
                [&](const QueueRow&, std::size_t, std::size_t) { stop.request_stop(); });
  EXPECT_EQ(rows.size(), 1u);
}

TEST(QueueOfExample, TheCsvHasALinePerCaseWhateverItHolds) {
  QueueRow row;
  row.case_id = "a,\"b\"";
  const std::string text = queueCsv({row, row});
  EXPECT_EQ(std::count(text.begin(), text.end(), '\n'), 3);
  EXPECT_THAT(text, HasSubstr("\"a,\"\"b\"\"\",new,0,0,,,,,,,0,,,not run yet"));
}

/// Thumbnails of the example's first case, 144 x 108, with the station's edges at a pose.
class ThumbnailOfExample : public testing::Test {
 protected:
  ColorImage thumbnail(const Pose& camera_from_station) const {
    const OverlayLayer layer{"", camera_from_station, kResultColor, true};
    return stationPicture(loaded_->image.view(), loaded_->source.camera, loaded_->scene.view(),
                          {&camera_from_station, 1}, {&layer, 1}, 144, 108);
  }
  static bool isEdge(const ColorImage& image, std::size_t pixel) {
    const std::uint8_t* bgr = image.bgr.data() + 3 * pixel;
    return ColorBgr{bgr[0], bgr[1], bgr[2]} == kResultColor;
  }
  const std::shared_ptr<const LoadedCase> loaded_ = loadCase(*exampleQueue().cases[0]);
  const Pose truth_ = *loaded_->source.camera_from_station_truth;
};

TEST_F(ThumbnailOfExample, ShowsTheStationsEdgesWhereTheImageHasThem) {
  const ColorImage picture = thumbnail(truth_);
  EXPECT_LE(picture.width, 144);
  EXPECT_LE(picture.height, 108);
  EXPECT_TRUE(picture.width == 144 || picture.height == 108);
  int green = 0;
  for (std::size_t i = 0; i < picture.bgr.size() / 3; ++i) green += isEdge(picture, i);
  EXPECT_GT(green, picture.width) << "the station fills the picture";
  Pose behind = truth_;
  behind.translation_m.z() = -behind.translation_m.z();
  EXPECT_GT(thumbnail(behind).width, 0) << "the whole image";
}

TEST_F(ThumbnailOfExample, OfADistantStation_ShowsAllOfItButDoesNotEnlargeItToFill) {
  const auto heightFrom = [&](double times_as_far) {
    Pose far = truth_;
    far.translation_m *= times_as_far;
    const ColorImage whole = thumbnail(far);
    EXPECT_EQ(whole.width, 144);
    EXPECT_EQ(whole.height, 108);
    int highest = whole.height - 1, lowest = 0;
    for (int y = 0; y < whole.height; ++y)
      for (int x = 0; x < whole.width; ++x) {
        if (!isEdge(whole, static_cast<std::size_t>(whole.width * y + x))) continue;
        EXPECT_TRUE(x > 0 && x < whole.width - 1 && y > 0 && y < whole.height - 1)
            << x << " " << y << ": cut off";
        highest = std::min(highest, y);
        lowest = std::max(lowest, y);
      }
    return lowest - highest;
  };
  EXPECT_GT(heightFrom(3.0), 60) << "as large as fits";
  EXPECT_LT(heightFrom(60.0), 40)
      << "a station of a few pixels is not enlarged to fill the picture";
}

}  // namespace
}  // namespace boresight::sessions
