// SPDX-License-Identifier: Apache-2.0
#include "ui/panels/iterations_panel.h"

#include <gtest/gtest.h>
#include <QtTest/QTest>
#include <QtWidgets>

#include "tests/support/example_run.h"
#include "ui/panels/banner.h"
#include "ui/plots/double_plot.h"

namespace boresight::ui {
namespace {

class IterationsPanelTest : public testing::Test {
 protected:
  IterationsPanelTest() {
    panel_.resize(1100, 320);
    panel_.show();
    view_.setSnapshot(test::exampleRun());
    last_ = static_cast<int>(test::exampleRun()->iterations.size()) - 1;
  }

  template <class T>
  T* child(const char* name = nullptr) const {
    return panel_.findChild<T*>(QString::fromLatin1(name));
  }
  void clickRow(int row) {
    auto* table = panel_.findChild<QTableView*>();
    const QRect place = table->visualRect(table->model()->index(row, 1));
    QTest::mouseClick(table->viewport(), Qt::LeftButton, Qt::NoModifier, place.center());
  }

  ViewState view_;
  IterationsPanel panel_{view_};
  int last_ = 0;
};

TEST_F(IterationsPanelTest, FollowsTheRunToItsEnd) {
  EXPECT_EQ(view_.cursor().iteration, last_);
  EXPECT_EQ(child<QTableView>("iterations")->currentIndex().row(), last_ + 1);
  EXPECT_EQ(child<QSlider>("iterations")->value(), last_);
  EXPECT_TRUE(child<Banner>("runStatus")->text().startsWith(QStringLiteral("Converged in")));
}

TEST_F(IterationsPanelTest, AClickOnARowMovesTheCursor) {
  clickRow(2);
  EXPECT_EQ(view_.cursor(), (RunCursor{1, Stage::kFinished}));
  EXPECT_EQ(child<QSlider>("iterations")->value(), 1);
  clickRow(0);
  EXPECT_EQ(view_.cursor().iteration, -1);
}

TEST_F(IterationsPanelTest, TheTableFollowsTheCursor) {
  view_.setCursor({0, Stage::kMatch});
  EXPECT_EQ(child<QTableView>("iterations")->currentIndex().row(), 1);
  EXPECT_EQ(view_.cursor().stage, Stage::kMatch) << "showing the cursor must not move it";
}

TEST_F(IterationsPanelTest, KeysMoveTheSlider) {
  auto* slider = child<QSlider>("iterations");
  QTest::keyClick(slider, Qt::Key_Home);
  EXPECT_EQ(view_.cursor().iteration, -1);
  QTest::keyClick(slider, Qt::Key_Right);
  EXPECT_EQ(view_.cursor().iteration, 0);
}

TEST_F(IterationsPanelTest, ActionsWalkThroughTheRun) {
  RunScrubber& scrubber = panel_.scrubber();
  using Step = RunScrubber::Step;
  EXPECT_FALSE(scrubber.action(Step::kNext)->isEnabled());
  scrubber.action(Step::kFirst)->trigger();
  EXPECT_EQ(view_.cursor().iteration, -1);
  EXPECT_FALSE(scrubber.action(Step::kPrevious)->isEnabled());
  scrubber.action(Step::kNextStage)->trigger();
  EXPECT_EQ(view_.cursor(), (RunCursor{0, Stage::kRender}));
  scrubber.action(Step::kNext)->trigger();
  EXPECT_EQ(view_.cursor(), (RunCursor{1, Stage::kFinished}));
  scrubber.action(Step::kPreviousStage)->trigger();
  EXPECT_EQ(view_.cursor().iteration, 1);
  EXPECT_NE(view_.cursor().stage, Stage::kFinished);
  scrubber.action(Step::kLast)->trigger();
  EXPECT_EQ(view_.cursor().iteration, last_);
}

TEST_F(IterationsPanelTest, AStageButtonShowsThatStage) {
  view_.setCursor({0, Stage::kFinished});
  for (auto* button : panel_.findChildren<QToolButton*>()) {
    if (button->text() != QStringLiteral("Match")) continue;
    QTest::mouseClick(button, Qt::LeftButton);
  }
  EXPECT_EQ(view_.cursor(), (RunCursor{0, Stage::kMatch}));
}

TEST_F(IterationsPanelTest, AClickOnAPlotMovesTheCursor) {
  const auto plots = panel_.findChildren<DoublePlot*>();
  ASSERT_EQ(plots.size(), 2);
  for (DoublePlot* plot : plots) {
    EXPECT_EQ(plot->leftCount(), last_ + 1);
    for (const int iteration : {0, 2}) {
      QTest::mouseClick(plot->canvas(), Qt::LeftButton, Qt::NoModifier,
                        plot->canvasPoint(iteration));
      EXPECT_EQ(view_.cursor().iteration, iteration);
    }
  }
}

TEST_F(IterationsPanelTest, ShowsNothingOfACaseThatHasNotRun) {
  view_.setCase(nullptr);
  EXPECT_EQ(panel_.model().rowCount(), 0);
  EXPECT_FALSE(child<QSlider>("iterations")->isEnabled());
  EXPECT_EQ(child<Banner>("runStatus")->text(), QStringLiteral("Nothing has run yet."));
  for (int i = 0; i < RunScrubber::kStepCount; ++i)
    EXPECT_FALSE(panel_.scrubber().action(static_cast<RunScrubber::Step>(i))->isEnabled());
}

TEST_F(IterationsPanelTest, SaysWhyARunFailed) {
  auto failed = std::make_shared<sessions::LocalizationTrace>(*test::exampleRun());
  failed->status = LocalizationStatus::kIterationLimit;
  view_.setSnapshot(failed);
  EXPECT_TRUE(
      child<Banner>("runStatus")->text().startsWith(QStringLiteral("Did not converge. After")));
}

}  // namespace
}  // namespace boresight::ui
