// SPDX-License-Identifier: Apache-2.0
#include "ui/panels/hypotheses_panel.h"

#include <gtest/gtest.h>
#include <QTableView>
#include <QtTest/QTest>

#include "tests/support/hypotheses_run.h"

namespace boresight::ui {
namespace {

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

TEST_F(HypothesesPanelTest, ACandidateIsShownWithTheFirst) {
  clickRow(kCompeting + 1);
  ASSERT_TRUE(view_.alternative());
  EXPECT_EQ(view_.alternative()->camera_from_station, run_->candidates[1].camera_from_station);
  EXPECT_EQ(view_.alternative()->camera_from_station_chosen,
            run_->candidates[0].camera_from_station);
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
  // Competing poses of the result, and candidates of the search.
  const auto run = test::exampleRun();
  EXPECT_EQ(panel_.model().rowCount(),
            static_cast<int>(run->competing_poses.size() + run->candidates.size()));
}

}  // namespace
}  // namespace boresight::ui
