// SPDX-License-Identifier: Apache-2.0
#include "ui/panels/diagnose/hypotheses_panel.h"

#include <gtest/gtest.h>
#include <QAbstractItemModelTester>
#include <QFont>
#include <QTableView>
#include <QtTest/QTest>

#include "tests/support/hypotheses_run.h"

namespace boresight::ui {
namespace {

using Tester = QAbstractItemModelTester;

constexpr int kCompeting = 2;

class HypothesesPanelTest : public testing::Test {
 protected:
  HypothesesPanelTest() {
    panel_.resize(900, 260);
    panel_.show();
    view_.setSnapshot(run_);
  }
  QTableView& table() const { return *panel_.findChild<QTableView*>(QStringLiteral("hypotheses")); }
  void clickRow(int row) {
    const QRect place = table().visualRect(panel_.model().index(row, 0));
    QTest::mouseClick(table().viewport(), Qt::LeftButton, Qt::NoModifier, place.center());
  }

  ViewState view_;
  HypothesesPanel panel_{view_};
  std::shared_ptr<const sessions::LocalizationTrace> run_ = test::runWithHypotheses();
  int last_ = static_cast<int>(run_->iterations.size()) - 1;
};

TEST_F(HypothesesPanelTest, NothingIsChosenAtFirst_ACompetingPoseIsShownWithTheResult) {
  EXPECT_EQ(panel_.model().rowCount(), 4);
  EXPECT_FALSE(view_.alternative());
  EXPECT_FALSE(table().currentIndex().isValid());
  clickRow(1);
  ASSERT_TRUE(view_.alternative());
  EXPECT_EQ(view_.alternative()->camera_from_station, run_->competing_poses[1].camera_from_station);
  EXPECT_EQ(view_.cursor().iteration, last_);
}

TEST_F(HypothesesPanelTest, AComparedPoseIsShownWithTheBest) {
  clickRow(kCompeting + 1);
  ASSERT_TRUE(view_.alternative());
  EXPECT_EQ(view_.alternative()->camera_from_station, run_->hypotheses[0].camera_from_station);
  EXPECT_EQ(view_.alternative()->camera_from_station_chosen,
            run_->hypotheses[0].camera_from_station);
  EXPECT_EQ(view_.cursor().iteration, last_);
  EXPECT_EQ(table().currentIndex().row(), kCompeting + 1) << "and stays chosen";
}

TEST_F(HypothesesPanelTest, GoingElsewhereTakesItAway) {
  clickRow(kCompeting + 1);
  view_.setCursor({1, Stage::kFinished});
  EXPECT_FALSE(view_.alternative());
  EXPECT_FALSE(table().currentIndex().isValid());
  clickRow(kCompeting + 1);
  EXPECT_TRUE(view_.alternative());
  view_.setSnapshot(test::exampleRun());
  EXPECT_FALSE(view_.alternative());
  // Competing poses of the result, and poses that were compared.
  const auto run = test::exampleRun();
  EXPECT_EQ(panel_.model().rowCount(),
            static_cast<int>(run->competing_poses.size() + run->hypotheses.size()));
}

TEST(AlternativesModel, ListsCompetingThenComparedPosesAndHowEachEnded) {
  using Model = AlternativesModel;
  Model model;
  const Tester tester(&model, Tester::FailureReportingMode::Fatal);
  model.setRows(sessions::alternativesOf(*test::runWithHypotheses()), false);
  ASSERT_EQ(model.rowCount(), 4);
  const struct {
    int row;
    int column;
    const char* text;
  } cells[] = {{0, Model::kPose, "Competing pose 1"},
               {0, Model::kIteration, "result"},
               {0, Model::kEnded, "not chosen"},
               {0, Model::kMargin_nats, "more than 1000 times"},
               {0, Model::kSimilarity, "0.45"},
               {0, Model::kApart_mm, "22.00"},
               {0, Model::kInliers, ""},
               {1, Model::kPose, "Competing pose 2"},
               {2, Model::kPose, "Candidate 2"},  // the competitor
               {2, Model::kEnded, "not chosen"},
               {2, Model::kApart_deg, "17.19"},
               {3, Model::kPose, "Candidate 1"},
               {3, Model::kEnded, "chosen"},
               {3, Model::kScore, "9.00"},
               {3, Model::kProbability, "90.0 %"}};
  for (const auto& [row, column, text] : cells)
    EXPECT_EQ(model.index(row, column).data().toString().toStdString(), text) << row << column;
  EXPECT_TRUE(model.index(3, 0).data(Qt::FontRole).value<QFont>().bold());
  EXPECT_FALSE(model.index(2, 0).data(Qt::FontRole).isValid());
  EXPECT_EQ(model.firstRowOf(1), -1);
  EXPECT_EQ(model.firstRowOf(-1), -1) << "competing poses are of no iteration";
}

}  // namespace
}  // namespace boresight::ui
