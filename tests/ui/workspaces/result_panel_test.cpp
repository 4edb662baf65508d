// SPDX-License-Identifier: Apache-2.0
#include "ui/workspaces/result_panel.h"

#include <gtest/gtest.h>

#include "tests/support/example_run.h"
#include "tests/ui/window_test.h"
#include "ui/models/text.h"
#include "ui/review/quality_controller.h"
#include "ui/run/task_runner.h"
#include "ui/state/document.h"

namespace boresight::ui {
namespace {

/// The example's case with a run of it, whatever that ended with.
class ResultPanelTest : public ::testing::Test {
 protected:
  ResultPanelTest() {
    EXPECT_TRUE(document_.create(folder_.path() / "one.boresight.json", session_));
    for (const auto& each : session_.cases)
      if (each->station == "os") state_.setCase(sessions::loadCase(*each));  // which ran
    panel_.show();
  }
  void show(LocalizationStatus status) {
    auto trace = std::make_shared<sessions::LocalizationTrace>(*test::exampleRun());
    trace->status = status;
    trace->finished = true;
    state_.setSnapshot(std::move(trace));
    state_.setCursor(
        {static_cast<int>(state_.snapshot()->iterations.size()) - 1, Stage::kFinished});
    EXPECT_TRUE(QTest::qWaitFor([this] { return !tasks_.isBusy(); }, 60'000));
  }
  bool says(const QString& text) const {
    const auto labels = panel_.findChildren<QLabel*>();
    return std::any_of(labels.begin(), labels.end(), [&text](const QLabel* each) {
      return each->isVisible() && each->text().contains(text);
    });
  }
  QTableWidget& pose() { return *panel_.findChild<QTableWidget*>(QStringLiteral("resultPose")); }

  test::TemporaryFolder folder_;
  test::OwnSettings settings_{folder_.path()};
  sessions::Session session_ = test::exampleSession();
  Document document_;
  ViewState state_;
  TaskRunner tasks_;
  QualityController quality_{document_, state_, tasks_};
  ResultPanel panel_{state_, quality_};
};

TEST_F(ResultPanelTest, ConvergedRun_HasItsQualityAgainstTheRequirement_OtherLimitsMeasureAgain) {
  show(LocalizationStatus::kConverged);
  ASSERT_TRUE(quality_.quality().has_value());
  const sessions::PrecisionFigure* worst = quality_.quality()->worst();
  ASSERT_NE(worst, nullptr);
  EXPECT_TRUE(says(fromText(worst->text())));
  EXPECT_TRUE(says(QStringLiteral("3 sigma")));
  EXPECT_TRUE(pose().isEnabled());
  EXPECT_FALSE(says(QStringLiteral("Rejected")));
  const double before = *worst->found;
  sessions::Session changed = document_.session();
  changed.review.limits = {{"check.sigmas", 1.5}};
  ASSERT_TRUE(document_.edit(changed, QStringLiteral("limits")));
  EXPECT_FALSE(quality_.quality().has_value()) << "outdated at once";
  ASSERT_TRUE(QTest::qWaitFor([this] { return quality_.quality().has_value(); }, 60'000));
  EXPECT_NEAR(*quality_.quality()->worst()->found, 0.5 * before, 1e-12);
}

TEST_F(ResultPanelTest, RunOfFormerInputs_HasNoQuality) {
  show(LocalizationStatus::kConverged);
  sessions::Session changed = document_.session();
  const std::string other(64, '0');
  changed.runs.push_back({state_.currentCase()->source.id, state_.snapshot()->digest,
                          folder_ / "a.trace", "converged", "1.0.0", "2026-01-31T23:59:59Z", other,
                          other});
  ASSERT_TRUE(document_.edit(changed, QStringLiteral("Another camera")));
  EXPECT_FALSE(quality_.quality().has_value());
}

TEST_F(ResultPanelTest, RejectedPose_IsCalledSoAndCannotBeCopied) {
  show(LocalizationStatus::kNotSupported);
  EXPECT_FALSE(quality_.quality().has_value());
  EXPECT_TRUE(says(QStringLiteral("Rejected: this pose is not a result.")));
  EXPECT_FALSE(pose().isEnabled());
}

}  // namespace
}  // namespace boresight::ui
