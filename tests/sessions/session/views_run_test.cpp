// SPDX-License-Identifier: Apache-2.0
#include "sessions/session/views_run.h"

#include <algorithm>
#include <map>

#include <gtest/gtest.h>

#include "sessions/checks/review_subject.h"
#include "sessions/io/files/errors.h"
#include "sessions/review/validated_pose_file.h"
#include "sessions/run/runner.h"
#include "sessions/session/session_file.h"
#include "sessions/trace/run_text.h"
#include "tests/sessions/session/example_session.h"
#include "tests/support/matchers.h"
#include "tests/support/turned_view.h"

namespace boresight::test {
namespace {

using namespace sessions;

/// Two views that run without a search.
const Session& twoViews() {
  static const TemporaryFolder folder;
  static Session views = sessionOfTwoViews(folder.path());
  views.options = {{"search.enabled", false}};
  return views;
}

/// What their runs give: run once for each leader.
const std::vector<LocalizationTrace>& runOfTwoViews(const std::string& leader) {
  static std::map<std::string, std::vector<LocalizationTrace>> runs;
  if (!runs.contains(leader)) runs[leader] = runViews(twoViews(), leader);
  return runs[leader];
}

class ViewsRunTest : public testing::Test {
 protected:
  const std::string& first() const { return session_.cases[0]->id; }
  const std::string& second() const { return session_.cases[1]->id; }
  std::filesystem::path file() const { return folder_ / "s.boresight.json"; }

  /// Run and noted.
  void run(const std::string& leader) { note(runOfTwoViews(leader)); }
  void note(const std::vector<LocalizationTrace>& views) {
    views_ = views;
    for (const RunRecord& item : storeViews(session_, views_, file()))
      session_ = withRun(session_, item);
  }

  TemporaryFolder folder_;
  Session session_ = twoViews();
  std::vector<LocalizationTrace> views_;
};

TEST_F(ViewsRunTest, IsWhatTheCoreMakesOfBothImages) {
  const SessionCase& session_case = *session_.cases[0];
  const SessionCase& other = *session_.cases[1];
  const ExampleCase& example = osExample();
  const GrayImage turned = readImage(other.image.source.file);
  std::array<View, 2> images;
  images[0].image = example.image.view();
  images[0].camera = example.camera;
  images[1].image = turned.view();
  images[1].camera = other.camera;
  images[1].camera_from_rig = halfTurn();
  images[0].mesh = images[1].mesh = example.scene.view();
  ViewsProblem problem;
  problem.views = images;
  problem.rig_from_station_seed = example.seed.camera_from_station;
  problem.uncertainty = example.problem().uncertainty;
  LocalizerOptions options = defaultProfile();
  options.templates.feature_size_m = session_case.feature_size_m.value();
  options.search.enabled = false;
  Runner core(problem, options, {first(), second()});  // RunnerViewsTest
  core.advance(StepUntil::kEnd);

  views_ = runOfTwoViews(first());
  ASSERT_EQ(views_.size(), 2u);
  for (std::size_t v = 0; v < 2; ++v) {
    EXPECT_EQ(views_[v].digest, core.traces()[v].digest);
    EXPECT_TRUE(views_[v].converged());
    const Pose& truth = *session_.cases[v]->camera_from_station_truth;
    const Vector6d error = perturbationBetween(truth, views_[v].camera_from_station);
    EXPECT_LT(error.tail<3>().norm(), 1e-3);
  }
  EXPECT_EQ(views_[0].covariance, core.joint().result.covariance) << "the rig is its camera";
}

TEST_F(ViewsRunTest, EachCaseGetsARunThatNamesTheOthersAndIsReadAgain) {
  run(first());
  ASSERT_EQ(session_.runs.size(), 2u);
  writeSessionFile(file(), session_);
  const Session reread = readSessionFile(file()).session;
  EXPECT_EQ(reread, session_);
  for (std::size_t v = 0; v < 2; ++v) {
    const RunRecord& record = reread.runs[v];
    EXPECT_EQ(record.case_id, session_.cases[v]->id);
    EXPECT_EQ(record.status, "converged");
    ASSERT_TRUE(record.together.has_value());
    EXPECT_EQ(casesOf(*record.together), (std::vector<std::string>{first(), second()}));
    const LocalizationTrace snapshot = loadSnapshot(record);
    EXPECT_EQ(snapshot.views, views_[v].views);
    EXPECT_EQ(snapshot.own_view, v);
    EXPECT_EQ(snapshot.digest, views_[v].digest);
    EXPECT_FALSE(stalenessOf(record, reread, file()).stale());
  }
  const LocalizationTrace alone = runCase(session_, first());
  EXPECT_NE(alone.digest, session_.runs[0].digest);
}

TEST_F(ViewsRunTest, ARunIsRepeatedWithTheOthersUnlessItsOutcomesAreStatedOtherwise) {
  run(second());
  for (const RunRecord& record : session_.runs)
    EXPECT_EQ(repeatRun(record, session_, file()).digest, record.digest);
  EXPECT_EQ(session_.runs[0].together->views[0].case_id, second()) << "it led";
  RunRecord forged = session_.runs[0];
  forged.together->views[1].status = "pnp_failed";
  EXPECT_THROW((void)repeatRun(forged, session_, file()), InputError);
}

TEST_F(ViewsRunTest, WhatAnotherViewDependsOnMakesItStale) {
  run(first());
  const auto stale = [this](const Session& next) {
    return stalenessOf(session_.runs[0], next, file()).inputs_changed;
  };
  const auto changed = [this](void (*change)(SessionCase&)) {
    return withChanged(session_, second(), change);
  };
  const Session masked = changed([](SessionCase& view) { view.ignore_strokes.push_back({}); });
  EXPECT_TRUE(stale(
      changed([](SessionCase& view) { view.rig->camera_from_rig.translation_m.x() += 1e-6; })));
  EXPECT_TRUE(stale(masked));
  EXPECT_TRUE(stale(withoutCase(session_, second())));
  EXPECT_FALSE(stale(changed([](SessionCase& view) {
    view.camera_from_station_seed.translation_m.x() += 1e-6;
  }))) << "the first view's seed alone counts";
  EXPECT_THAT(folder_.message([&] { (void)repeatRun(session_.runs[0], masked, file()); }),
              HasSubstr("one of these views has changed or is missing"));
}

TEST_F(ViewsRunTest, ABlackViewIsLeftOutAndSaysWhy) {
  session_ = withBlackSecond(session_, folder_.path());
  note(runViews(session_, first()));
  EXPECT_EQ(session_.runs[1].status, "too_few_matches");
  EXPECT_THAT(togetherText(session_.runs[0].together->views, first()),
              HasSubstr("left out: too few of its templates match edges"));
}

TEST_F(ViewsRunTest, FileWithoutViews_IsRead) {
  run(first());
  for (RunRecord& item : session_.runs) item.together.reset();
  writeSessionFile(file(), session_);
  EXPECT_THAT(folder_.read("s.boresight.json"), Not(HasSubstr("\"together\"")));
  const Session old = readSessionFile(file()).session;
  EXPECT_EQ(old, session_);
  EXPECT_TRUE(loadSnapshot(old.runs[0]).views.empty());
  // A record without a reviewer is refused.
  session_.runs[0].together = TogetherRecord{{{first(), "converged"}}, std::string(64, 'a')};
  writeSessionFile(file(), session_);
  EXPECT_THAT(folder_.message([&] { (void)readSessionFile(file()); }),
              HasSubstr("views: has fewer than two"));
}

TEST_F(ViewsRunTest, SaysWhyACaseStandsAlone) {
  EXPECT_THAT(whyAlone(session_, first()), IsEmpty());
  EXPECT_THAT(whyAlone(withoutRigLink(session_, second()), first()), HasSubstr("has no rig"));
  EXPECT_THAT(whyAlone(withoutCase(session_, second()), first()),
              HasSubstr("no other view of rig"));
  SessionCase other = *session_.cases[1];
  other.parts[0].source.mesh = "/copy/of/the.ply";
  EXPECT_THAT(whyAlone(withCase(session_, other), first()), IsEmpty());
  other.parts[0].sha256 = std::string(64, 'a');
  EXPECT_THAT(whyAlone(withCase(session_, other), first()), HasSubstr("has another station"));
  Session many = session_;
  for (int i = 0; i < 7; ++i) {
    SessionCase session_case = *session_.cases[1];
    session_case.id += std::to_string(i);
    many = withCase(many, session_case);
  }
  EXPECT_THAT(whyAlone(many, first()), HasSubstr("has 9 views; at most 8"));
}

TEST_F(ViewsRunTest, AStopLeavesItUnderWay) {
  std::stop_source stopped;
  stopped.request_stop();
  const auto views = runViews(session_, first(), stopped.get_token());
  for (const LocalizationTrace& view : views) EXPECT_EQ(view.status, LocalizationStatus::kRunning);
  EXPECT_THROW((void)storeViews(session_, views, file()), std::logic_error);
}

TEST_F(ViewsRunTest, AHandedPoseOfItIsVerifiedByRunningAllViewsAgain) {
  run(first());
  const std::filesystem::path handed = folder_ / "pose.json";
  writeValidatedPose(handed, session_, first());
  EXPECT_THAT(folder_.read("pose.json"), HasSubstr("together with " + second()));
  const VerifyReport report = verifyPose(handed, true);
  EXPECT_TRUE(report.good());
  EXPECT_TRUE(std::ranges::any_of(report.findings, [&](const auto& finding) {
    return finding.text == "the run together with " + second() + " gives the same digest";
  }));
}

TEST_F(ViewsRunTest, AHandedPoseTakesTheRunOfTheOtherCameraAlong) {
  for (const std::string& id : {second(), first()})
    session_ = withRun(session_, storeRun(session_, id, runCase(session_, id), file()));
  const std::filesystem::path handed = folder_ / "pose.json";
  writeValidatedPose(handed, session_, first());
  std::filesystem::remove_all(folder_ / "s.boresight.runs");
  const VerifyReport report = verifyPose(handed, true);
  for (const auto& finding : report.findings)
    EXPECT_TRUE(finding.good) << finding.what << ": " << finding.text;
  EXPECT_THAT(folder_.read("pose.json"), HasSubstr("The pose and " + second() + " differ by"));
}

/// Poses that were solved for as one say nothing of each other.
TEST_F(ViewsRunTest, OtherCamera_IsComparedOnlyByItsOwnRun) {
  run(first());
  const auto witnesses = [this] {
    return reviewSubject(session_, loadCase(*session_.cases[0]), PoseSource::kRun)
        .other_cameras.size();
  };
  EXPECT_EQ(witnesses(), 0u);
  const LocalizationTrace alone = runCase(session_, second());
  session_ = withRun(session_, storeRun(session_, second(), alone, file()));
  EXPECT_EQ(witnesses(), 1u);
  run(first());
  EXPECT_EQ(witnesses(), 1u) << "a later run of both takes nothing away";
}

}  // namespace
}  // namespace boresight::test
