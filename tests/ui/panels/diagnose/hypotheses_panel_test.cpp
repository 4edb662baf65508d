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
    run_ = test::runWithHypotheses();
    view_.setSnapshot(run_);
    last_ = static_cast<int>(run_->iterations.size()) - 1;
  }
  QTableView& table() const { return *panel_.findChild<QTableView*>(QStringLiteral("hypotheses")); }
  void clickRow(int row) {
    const QRect place = table().visualRect(panel_.model().index(row, 0));
    QTest::mouseClick(table().viewport(), Qt::LeftButton, Qt::NoModifier, place.center());
  }

  ViewState view_;
  HypothesesPanel panel_{view_};
  std::shared_ptr<const sessions::LocalizationTrace> run_;
  int last_ = 0;
};

TEST_F(HypothesesPanelTest, NothingIsChosenAtFirst) {
  EXPECT_EQ(panel_.model().rowCount(), 4);
  EXPECT_FALSE(view_.alternative());
  EXPECT_FALSE(table().currentIndex().isValid());
}

TEST_F(HypothesesPanelTest, ACompetingPoseIsShownWithTheResult) {
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

class AlternativesModelTest : public testing::Test {
 protected:
  AlternativesModelTest() {
    model_.setRows(sessions::alternativesOf(*test::runWithHypotheses()), false);
  }
  QString text(int row, int column) const { return model_.index(row, column).data().toString(); }

  AlternativesModel model_;
  Tester tester_{&model_, Tester::FailureReportingMode::Fatal};
};

TEST_F(AlternativesModelTest, ListsCompetingPosesThenComparedPoses) {
  ASSERT_EQ(model_.rowCount(), 4);
  EXPECT_EQ(text(0, AlternativesModel::kPose), QStringLiteral("Competing pose 1"));
  EXPECT_EQ(text(1, AlternativesModel::kPose), QStringLiteral("Competing pose 2"));
  EXPECT_EQ(text(2, AlternativesModel::kPose), QStringLiteral("Candidate 2")) << "the competitor";
  EXPECT_EQ(text(3, AlternativesModel::kPose), QStringLiteral("Candidate 1"));
  EXPECT_EQ(text(0, AlternativesModel::kIteration), QStringLiteral("result"));
  EXPECT_EQ(model_.firstRowOf(1), -1);
  EXPECT_EQ(model_.firstRowOf(-1), -1) << "competing poses are of no iteration";
}

TEST_F(AlternativesModelTest, TellsHowEachEndedAndByHowMuch) {
  EXPECT_EQ(text(0, AlternativesModel::kEnded), QStringLiteral("not chosen"));
  EXPECT_EQ(text(0, AlternativesModel::kMargin_nats), QStringLiteral("more than 1000 times"));
  EXPECT_EQ(text(0, AlternativesModel::kSimilarity), QStringLiteral("0.45"));
  EXPECT_EQ(text(0, AlternativesModel::kApart_mm), QStringLiteral("22.00"));
  EXPECT_EQ(text(0, AlternativesModel::kInliers), QString());
  EXPECT_EQ(text(3, AlternativesModel::kEnded), QStringLiteral("chosen"));
  EXPECT_EQ(text(3, AlternativesModel::kScore), QStringLiteral("9.00"));
  EXPECT_EQ(text(3, AlternativesModel::kProbability), QStringLiteral("90.0 %"));
  EXPECT_TRUE(model_.index(3, 0).data(Qt::FontRole).value<QFont>().bold());
  EXPECT_FALSE(model_.index(2, 0).data(Qt::FontRole).isValid());
  EXPECT_EQ(text(2, AlternativesModel::kEnded), QStringLiteral("not chosen"));
  EXPECT_EQ(text(2, AlternativesModel::kApart_deg), QStringLiteral("17.19"));
}

}  // namespace
}  // namespace boresight::ui
