// SPDX-License-Identifier: Apache-2.0
#include "ui/window/case_details.h"

#include <gtest/gtest.h>

#include <QtTest/QTest>

#include "sessions/session/case_run.h"
#include "tests/ui/window_test.h"
#include "ui/run/task_runner.h"

namespace boresight::ui {
namespace {

using test::kPatienceMs;

class CaseDetailsTest : public ::testing::Test {
 protected:
  void read() {
    details_.setSession(session_);
    ASSERT_TRUE(QTest::qWaitFor([this] { return !tasks_.isBusy(); }, kPatienceMs));
  }
  /// Stores a run of the first case in the session.
  void run() { session_ = test::withRunOfSeed(session_, folder_.path() / "one.boresight.json"); }
  std::vector<CaseRow> rows() const {
    std::vector<CaseRow> case_rows;
    for (const auto& session_case : session_.cases) {
      case_rows.push_back(caseRow(session_, session_case->id, stale_runs_));
      details_.fill(case_rows.back());
    }
    return case_rows;
  }

  mutable sessions::StaleRuns stale_runs_;
  TaskRunner tasks_;
  CaseDetails details_{tasks_};
  sessions::Session session_ = test::withoutSearch(test::exampleSession());
  test::TemporaryFolder folder_;
};

TEST_F(CaseDetailsTest, EveryCaseGetsASmallPicture_ButThatWhoseImageIsMissing) {
  EXPECT_TRUE(rows()[0].thumbnail.isNull());
  read();
  for (const CaseRow& row : rows()) {
    EXPECT_FALSE(row.thumbnail.isNull()) << row.id.toStdString();
    EXPECT_LE(row.thumbnail.width(), 256);
  }
  sessions::SessionCase gone = *session_.cases[0];
  gone.image.source.file = folder_.path() / "gone.png";
  gone.image.source.sha256 = std::string(64, '0');
  session_ = sessions::withCase(session_, gone);
  read();
  EXPECT_TRUE(rows()[0].thumbnail.isNull());
  EXPECT_FALSE(rows()[1].thumbnail.isNull());
}

/// A seed that is called the truth, and a truth moved by a known length, tell what the error is.
TEST_F(CaseDetailsTest, ErrorsAreThoseOfTheLatestRunAgainstTheTruth) {
  run();
  const sessions::LocalizationTrace trace = sessions::loadRun(session_.runs[0]);
  ASSERT_TRUE(trace.converged());
  sessions::SessionCase session_case = *session_.cases[0];
  session_case.camera_from_station_truth = trace.camera_from_station;
  session_case.camera_from_station_truth->translation_m.z() += 2e-3;
  session_ = sessions::withCase(session_, session_case);
  read();
  const CaseRow row = rows()[0];
  ASSERT_TRUE(row.normal_mm && row.lateral_mm && row.rotation_deg);
  EXPECT_NEAR(*row.normal_mm, 2.0, 1e-9);
  EXPECT_NEAR(*row.lateral_mm, 0.0, 1e-9);
  EXPECT_NEAR(*row.rotation_deg, 0.0, 1e-6);
  EXPECT_FALSE(rows()[1].normal_mm.has_value()) << "nothing has run";
  session_case.camera_from_station_truth.reset();
  session_ = sessions::withCase(session_, session_case);
  read();
  EXPECT_FALSE(rows()[0].normal_mm.has_value()) << "without a truth";
  EXPECT_EQ(rows()[0].state, CaseState::kConverged);
}

TEST_F(CaseDetailsTest, ARunOfOtherInputsOrOptionsIsStale) {
  run();
  EXPECT_FALSE(rows()[0].stale);
  const sessions::Session before = session_;
  sessions::SessionCase session_case = *session_.cases[0];
  session_case.camera_from_station_seed.translation_m.x() += 0.001;
  session_ = sessions::withCase(session_, session_case);
  EXPECT_TRUE(rows()[0].stale);
  EXPECT_FALSE(rows()[1].stale) << "nothing has run";
  LocalizerOptions options = sessions::sessionOptions(before, {});
  options.pnp.seed += 1;
  session_ = sessions::withOptions(before, before.profile, options);
  EXPECT_TRUE(rows()[0].stale);
}

}  // namespace
}  // namespace boresight::ui
