// SPDX-License-Identifier: Apache-2.0
#include "ui/models/alternatives_model.h"

#include <gtest/gtest.h>
#include <QAbstractItemModelTester>
#include <QFont>

#include "tests/support/hypotheses_run.h"

namespace boresight::ui {
namespace {

using Tester = QAbstractItemModelTester;

class AlternativesModelTest : public testing::Test {
 protected:
  AlternativesModelTest() {
    model_.setAlternatives(sessions::alternativesOf(*test::runWithHypotheses()));
  }
  QString text(int row, int column) const { return model_.index(row, column).data().toString(); }

  AlternativesModel model_;
  Tester tester_{&model_, Tester::FailureReportingMode::Fatal};
};

TEST_F(AlternativesModelTest, ListsCompetingPosesThenCandidates) {
  ASSERT_EQ(model_.rowCount(), 4);
  EXPECT_EQ(text(0, AlternativesModel::kPose), QStringLiteral("Competing pose 1"));
  EXPECT_EQ(text(1, AlternativesModel::kPose), QStringLiteral("Competing pose 2"));
  EXPECT_EQ(text(3, AlternativesModel::kPose), QStringLiteral("Candidate 2"));
  EXPECT_EQ(text(0, AlternativesModel::kIteration), QStringLiteral("result"));
  EXPECT_EQ(model_.firstRowOf(1), -1);
  EXPECT_EQ(model_.firstRowOf(-1), -1) << "competing poses are of no iteration";
}

TEST_F(AlternativesModelTest, TellsHowEachEndedAndByHowMuch) {
  EXPECT_EQ(text(0, AlternativesModel::kEnded), QStringLiteral("not chosen"));
  EXPECT_EQ(text(0, AlternativesModel::kMargin_nats), QStringLiteral("395"));
  EXPECT_EQ(text(0, AlternativesModel::kSimilarity), QStringLiteral("0.45"));
  EXPECT_EQ(text(0, AlternativesModel::kApart_mm), QStringLiteral("22.00"));
  EXPECT_EQ(text(0, AlternativesModel::kInliers), QString());
  EXPECT_EQ(text(2, AlternativesModel::kEnded), QStringLiteral("chosen"));
  EXPECT_EQ(text(2, AlternativesModel::kEvidence_nats), QStringLiteral("0.90"));
  EXPECT_TRUE(model_.index(2, 0).data(Qt::FontRole).value<QFont>().bold());
  EXPECT_FALSE(model_.index(3, 0).data(Qt::FontRole).isValid());
  EXPECT_EQ(text(3, AlternativesModel::kEnded), QStringLiteral("not chosen"));
  EXPECT_EQ(text(3, AlternativesModel::kApart_deg), QStringLiteral("17.19"));
}

}  // namespace
}  // namespace boresight::ui
