// SPDX-License-Identifier: Apache-2.0
#include "ui/panels/diagnose/iterations_panel.h"

#include <cmath>

#include <gtest/gtest.h>
#include <QtTest>
#include <QtWidgets>

#include "core/base/math.h"
#include "tests/support/example_run.h"
#include "tests/ui/models/tested_model.h"
#include "ui/plots/plots.h"
#include "ui/widgets/widgets.h"

namespace boresight::ui {
namespace {

class IterationsPanelTest : public testing::Test {
 protected:
  IterationsPanelTest() {
    panel_.resize(1100, 320);
    panel_.show();
    scrubber_.show();
    view_.setSnapshot(test::exampleRun());
  }

  template <class T>
  T* child(const char* name = nullptr) const {
    T* found = panel_.findChild<T*>(QString::fromLatin1(name));
    return found ? found : scrubber_.findChild<T*>(QString::fromLatin1(name));
  }
  void clickRow(int row) {
    auto* table = panel_.findChild<QTableView*>();
    const QRect place = table->visualRect(table->model()->index(row, 1));
    QTest::mouseClick(table->viewport(), Qt::LeftButton, Qt::NoModifier, place.center());
  }

  ViewState view_;
  IterationsPanel panel_{view_};
  RunScrubber scrubber_{view_};
  int last_ = static_cast<int>(test::exampleRun()->iterations.size()) - 1;
};

TEST_F(IterationsPanelTest, TableAndSliderFollowTheRunAndMoveTheCursor) {
  const auto* table = child<QTableView>("iterations");
  auto* slider = child<QSlider>("iterations");
  EXPECT_EQ(view_.cursor().iteration, last_);
  EXPECT_EQ(table->currentIndex().row(), last_ + 1);
  EXPECT_EQ(slider->value(), last_);
  clickRow(2);
  EXPECT_EQ(view_.cursor(), (RunCursor{1, Stage::kFinished}));
  EXPECT_EQ(slider->value(), 1);
  clickRow(0);
  EXPECT_EQ(view_.cursor().iteration, -1);
  view_.setCursor({0, Stage::kMatch});
  EXPECT_EQ(table->currentIndex().row(), 1);
  EXPECT_EQ(view_.cursor().stage, Stage::kMatch) << "showing the cursor must not move it";
  QTest::keyClick(slider, Qt::Key_Home);
  EXPECT_EQ(view_.cursor().iteration, -1);
  QTest::keyClick(slider, Qt::Key_Right);
  EXPECT_EQ(view_.cursor().iteration, 0);
}

/// Of a run that has just begun there is only the seed's row.
TEST_F(IterationsPanelTest, Hint_DuringTheFirstStageDoesNotAskToRun) {
  view_.setSnapshot(test::firstIterations(*test::exampleRun(), 0));
  auto* hint = child<EmptyHint>("emptyHint");
  EXPECT_TRUE(hint->isVisible());
  EXPECT_FALSE(hint->text().contains(QStringLiteral("F5"))) << hint->text().toStdString();
  const auto* table = child<QTableView>("iterations");
  EXPECT_GT(hint->y(), table->visualRect(table->model()->index(0, 0)).center().y());
}

TEST_F(IterationsPanelTest, ActionsAndStageButtonsWalkThroughTheRun) {
  using Step = RunScrubber::Step;
  EXPECT_FALSE(scrubber_.action(Step::kNext)->isEnabled());
  scrubber_.action(Step::kFirst)->trigger();
  EXPECT_EQ(view_.cursor().iteration, -1);
  EXPECT_FALSE(scrubber_.action(Step::kPrevious)->isEnabled());
  scrubber_.action(Step::kNextStage)->trigger();
  EXPECT_EQ(view_.cursor(), (RunCursor{0, Stage::kRender}));
  scrubber_.action(Step::kNext)->trigger();
  EXPECT_EQ(view_.cursor(), (RunCursor{1, Stage::kFinished}));
  scrubber_.action(Step::kPreviousStage)->trigger();
  EXPECT_EQ(view_.cursor().iteration, 1);
  EXPECT_NE(view_.cursor().stage, Stage::kFinished);
  scrubber_.action(Step::kLast)->trigger();
  EXPECT_EQ(view_.cursor().iteration, last_);
  view_.setCursor({0, Stage::kFinished});
  for (auto* button : scrubber_.findChildren<QToolButton*>())
    if (button->text() == QStringLiteral("Match")) QTest::mouseClick(button, Qt::LeftButton);
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
  for (int i = 0; i < RunScrubber::kStepCount; ++i)
    EXPECT_FALSE(scrubber_.action(static_cast<RunScrubber::Step>(i))->isEnabled());
}

TEST(StageSteps, WalkThroughARunAndBackAgain) {
  const auto run = test::exampleRun();
  std::size_t stages = 0;
  for (const auto& iteration : run->iterations)
    stages += iteration->kind == IterationKind::kMatch ? 4 : 2;
  std::vector<RunCursor> way = {{-1, Stage::kFinished}};
  while (true) {
    const RunCursor next = stageFrom(*run, way.back(), 1);
    if (next == way.back()) break;
    way.push_back(next);
    ASSERT_LE(way.size(), 1000u);
  }
  ASSERT_EQ(way.size(), stages + 1);
  std::size_t at = 0;
  for (const Stage stage : {Stage::kRender, Stage::kTemplates, Stage::kMatch, Stage::kFinished})
    EXPECT_EQ(way[++at], (RunCursor{0, stage}));
  for (std::size_t i = way.size() - 1; i > 0; --i)
    EXPECT_EQ(stageFrom(*run, way[i], -1), way[i - 1]) << i;
  EXPECT_EQ(stageFrom(*run, way[0], -1), way[0]);
}

TEST(StageSteps, EndWhereAnIterationUnderWayIs) {
  sessions::IterationTrace iteration = *test::exampleRun()->iterations.front();
  iteration.reached = Stage::kTemplates;
  EXPECT_EQ(stagesOf(iteration), (std::vector<Stage>{Stage::kRender, Stage::kTemplates}));
  EXPECT_EQ(shownStage(stagesOf(iteration), Stage::kFinished), 1);
  EXPECT_EQ(shownStage(stagesOf(iteration), Stage::kRender), 0);
}

class IterationsModelTest : public test::TestedModel<IterationsModel> {
 protected:
  using RunPtr = std::shared_ptr<const sessions::LocalizationTrace>;

  /// A copy of a run with one iteration changed.
  template <class Change>
  static std::shared_ptr<sessions::LocalizationTrace> edited(const RunPtr& run, std::size_t index,
                                                             Change change) {
    auto copy = std::make_shared<sessions::LocalizationTrace>(*run);
    test::editIteration(*copy, index, change);
    return copy;
  }

  RunPtr run_ = test::exampleRun();
};

TEST_F(IterationsModelTest, HasARowForTheSeedAndOneWithTheFiguresOfEachIteration) {
  EXPECT_EQ(model_.rowCount(), 0);
  model_.setSnapshot(run_);
  ASSERT_EQ(model_.rowCount(), static_cast<int>(run_->iterations.size()) + 1);
  EXPECT_EQ(text(0, IterationsModel::kNumber), QStringLiteral("seed"));
  EXPECT_EQ(text(1, IterationsModel::kNumber), QStringLiteral("1.1"));
  for (std::size_t i = 0; i < run_->iterations.size(); ++i) {
    const sessions::IterationTrace& iteration = *run_->iterations[i];
    const int index = static_cast<int>(i);
    EXPECT_EQ(model_.number(index, IterationsModel::kTranslation_mm),
              1e3 * iteration.correction_translation_m);
    EXPECT_DOUBLE_EQ(model_.number(index, IterationsModel::kRotation_deg),
                     iteration.correction_rotation_rad / kDegree_rad);
    EXPECT_EQ(model_.number(index, IterationsModel::kInliers), iteration.support());
    EXPECT_EQ(model_.number(index, IterationsModel::kRms_px), iteration.rms_px());
    const bool matches = iteration.kind == IterationKind::kMatch;
    EXPECT_EQ(text(index + 1, IterationsModel::kKind),
              matches ? QStringLiteral("match") : QStringLiteral("refine"));
    EXPECT_EQ(std::isnan(model_.number(index, IterationsModel::kBestScore)), !matches);
    EXPECT_EQ(text(index + 1, IterationsModel::kThreshold_px).toDouble(),
              std::round(10.0 * iteration.threshold_px) / 10.0);
  }
  EXPECT_EQ(text(model_.rowCount() - 1, IterationsModel::kStatus), QStringLiteral("converged"));
  EXPECT_EQ(text(1, IterationsModel::kStatus), QStringLiteral("continued"));
}

TEST_F(IterationsModelTest, SaysWhichHypothesisAnIterationWentOnWith) {
  model_.setSnapshot(edited(run_, 0, [](sessions::IterationTrace& rolled) {
    rolled.hypotheses.assign(2, HypothesisSummary{});
    rolled.hypotheses[1].roll_rad = -40.0 * kDegree_rad;
    rolled.hypotheses[1].solved = true;
    rolled.chosen_hypothesis = 1;
  }));
  const QModelIndex hypothesis = model_.index(1, IterationsModel::kHypothesis);
  EXPECT_EQ(hypothesis.data().toString(), QStringLiteral("-40.0 deg (of 2)"));
  const QStringList lines = hypothesis.data(Qt::ToolTipRole).toString().split(QLatin1Char('\n'));
  ASSERT_EQ(lines.size(), 2);
  EXPECT_TRUE(lines[0].contains(QStringLiteral("no pose")));
  EXPECT_TRUE(lines[1].endsWith(QStringLiteral("(chosen)")));
}

TEST_F(IterationsModelTest, AppendsWhatARunAddsAndKeepsSelections) {
  model_.setSnapshot(test::firstIterations(*run_, 1));
  const QPersistentModelIndex first = model_.index(1, 0);
  QSignalSpy resets(&model_, &QAbstractItemModel::modelReset);
  QSignalSpy inserts(&model_, &QAbstractItemModel::rowsInserted);
  EXPECT_EQ(text(1, IterationsModel::kStatus), QStringLiteral("halted"));
  model_.setSnapshot(test::firstIterations(*run_, 2));
  EXPECT_EQ(text(1, IterationsModel::kStatus), QStringLiteral("continued"));
  model_.setSnapshot(run_);
  EXPECT_EQ(resets.count(), 0);
  EXPECT_EQ(inserts.count(), 2);
  EXPECT_TRUE(first.isValid());
  EXPECT_EQ(model_.rowCount(), static_cast<int>(run_->iterations.size()) + 1);
  model_.setSnapshot(test::firstIterations(*run_, 2));  // another run: shorter
  EXPECT_EQ(resets.count(), 1);
  model_.setSnapshot(nullptr);
  EXPECT_EQ(model_.rowCount(), 0);
}

TEST_F(IterationsModelTest, TheIterationUnderWayChangesInPlace) {
  const auto halted = edited(test::firstIterations(*run_, 2), 1,
                             [](auto& iteration) { iteration.reached = Stage::kRender; });
  halted->last_under_way = true;
  model_.setSnapshot(halted);
  EXPECT_EQ(text(2, IterationsModel::kInliers), QString());
  QSignalSpy resets(&model_, &QAbstractItemModel::modelReset);
  model_.setSnapshot(test::firstIterations(*run_, 2));
  EXPECT_EQ(resets.count(), 0);
  EXPECT_NE(text(2, IterationsModel::kInliers), QString());
}

TEST_F(IterationsModelTest, MissingValues_AreBlank) {
  const auto run = edited(test::firstIterations(*run_, 1), 0,
                          [](auto& iteration) { iteration.reached = Stage::kTemplates; });
  run->last_under_way = true;
  model_.setSnapshot(run);
  EXPECT_EQ(text(1, IterationsModel::kTemplates),
            QString::number(run->iterations.front()->template_count));
  for (const int column :
       {IterationsModel::kMatches, IterationsModel::kInliers, IterationsModel::kTranslation_mm,
        IterationsModel::kBestScore, IterationsModel::kRms_px})
    EXPECT_EQ(text(1, column), QString()) << column;
  EXPECT_EQ(text(1, IterationsModel::kStatus), QStringLiteral("templates done"));
}

TEST_F(IterationsModelTest, CountsIterationsWithinTheirAttempt) {
  auto run = std::make_shared<sessions::LocalizationTrace>(*run_);
  for (std::size_t i = 1; i < run->iterations.size(); ++i)
    test::editIteration(*run, i, [](auto& iteration) { iteration.attempt = 1; });
  model_.setSnapshot(run);
  EXPECT_EQ(model_.iterationName(0), QStringLiteral("1.1"));
  EXPECT_EQ(model_.iterationName(1), QStringLiteral("2.1"));
  EXPECT_EQ(model_.iterationName(2), QStringLiteral("2.2"));
}

}  // namespace
}  // namespace boresight::ui
