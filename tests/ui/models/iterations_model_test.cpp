// SPDX-License-Identifier: Apache-2.0
#include "ui/models/iterations_model.h"

#include <cmath>

#include <gtest/gtest.h>
#include <QtTest>

#include "core/base/math.h"
#include "tests/support/example_run.h"

namespace boresight::ui {
namespace {

using Tester = QAbstractItemModelTester;

class IterationsModelTest : public testing::Test {
 protected:
  QString text(int row, int column) const { return model_.index(row, column).data().toString(); }

  IterationsModel model_;
  Tester tester_{&model_, Tester::FailureReportingMode::Fatal};
  std::shared_ptr<const sessions::LocalizationTrace> run_ = test::exampleRun();
};

TEST_F(IterationsModelTest, HasARowForTheSeedAndOnePerIteration) {
  EXPECT_EQ(model_.rowCount(), 0);
  model_.setSnapshot(run_);
  ASSERT_EQ(model_.rowCount(), static_cast<int>(run_->iterations.size()) + 1);
  EXPECT_EQ(text(0, IterationsModel::kNumber), QStringLiteral("seed"));
  EXPECT_EQ(text(1, IterationsModel::kNumber), QStringLiteral("1.1"));
}

TEST_F(IterationsModelTest, ShowsTheFiguresOfTheRun) {
  model_.setSnapshot(run_);
  for (std::size_t i = 0; i < run_->iterations.size(); ++i) {
    const sessions::IterationTrace& one = *run_->iterations[i];
    const int index = static_cast<int>(i);
    EXPECT_EQ(model_.number(index, IterationsModel::kTranslation_mm),
              1e3 * one.correction_translation_m);
    EXPECT_DOUBLE_EQ(model_.number(index, IterationsModel::kRotation_deg),
                     one.correction_rotation_rad / kDegree_rad);
    EXPECT_EQ(model_.number(index, IterationsModel::kInliers), one.support());
    EXPECT_EQ(model_.number(index, IterationsModel::kRms_px), one.rms_px());
    const bool matches = one.kind == IterationKind::kMatch;
    EXPECT_EQ(text(index + 1, IterationsModel::kKind),
              matches ? QStringLiteral("match") : QStringLiteral("refine"));
    EXPECT_EQ(std::isnan(model_.number(index, IterationsModel::kBestScore)), !matches);
    EXPECT_EQ(text(index + 1, IterationsModel::kThreshold_px).toDouble(),
              std::round(10.0 * one.threshold_px) / 10.0);
  }
  const int last = model_.rowCount() - 1;
  EXPECT_EQ(text(last, IterationsModel::kStatus), QStringLiteral("converged"));
  EXPECT_EQ(text(1, IterationsModel::kStatus), QStringLiteral("went on"));
}

TEST_F(IterationsModelTest, SaysWhichHypothesisAnIterationWentOnWith) {
  auto snapshot = std::make_shared<sessions::LocalizationTrace>(*run_);
  auto rolled = std::make_shared<sessions::IterationTrace>(*snapshot->iterations.front());
  rolled->hypotheses.assign(2, HypothesisSummary{});
  rolled->hypotheses[1].roll_rad = -40.0 * kDegree_rad;
  rolled->hypotheses[1].solved = true;
  rolled->chosen_hypothesis = 1;
  snapshot->iterations.front() = rolled;
  model_.setSnapshot(snapshot);
  EXPECT_EQ(text(1, IterationsModel::kHypothesis), QStringLiteral("-40.0 deg (of 2)"));
  const QStringList lines = model_.index(1, IterationsModel::kHypothesis)
                                .data(Qt::ToolTipRole)
                                .toString()
                                .split(QLatin1Char('\n'));
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
  EXPECT_EQ(text(1, IterationsModel::kStatus), QStringLiteral("went on"));
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
  auto halted = std::make_shared<sessions::LocalizationTrace>(*test::firstIterations(*run_, 2));
  auto early = std::make_shared<sessions::IterationTrace>(*halted->iterations.back());
  early->reached = Stage::kRender;
  halted->iterations.back() = early;
  halted->last_under_way = true;
  model_.setSnapshot(halted);
  EXPECT_EQ(text(2, IterationsModel::kInliers), QString());
  QSignalSpy resets(&model_, &QAbstractItemModel::modelReset);
  model_.setSnapshot(test::firstIterations(*run_, 2));
  EXPECT_EQ(resets.count(), 0);
  EXPECT_NE(text(2, IterationsModel::kInliers), QString());
}

TEST_F(IterationsModelTest, LeavesBlankWhatIsNotThereYet) {
  auto run = std::make_shared<sessions::LocalizationTrace>(*test::firstIterations(*run_, 1));
  auto early = std::make_shared<sessions::IterationTrace>(*run->iterations.front());
  early->reached = Stage::kTemplates;
  run->iterations.front() = early;
  run->last_under_way = true;
  model_.setSnapshot(run);
  EXPECT_EQ(text(1, IterationsModel::kTemplates), QString::number(early->template_count));
  for (const int column :
       {IterationsModel::kMatches, IterationsModel::kInliers, IterationsModel::kTranslation_mm,
        IterationsModel::kBestScore, IterationsModel::kRms_px})
    EXPECT_EQ(text(1, column), QString()) << column;
  EXPECT_EQ(text(1, IterationsModel::kStatus), QStringLiteral("templates done"));
}

TEST_F(IterationsModelTest, CountsIterationsWithinTheirAttempt) {
  auto run = std::make_shared<sessions::LocalizationTrace>(*run_);
  for (std::size_t i = 1; i < run->iterations.size(); ++i) {
    auto second = std::make_shared<sessions::IterationTrace>(*run->iterations[i]);
    second->attempt = 1;
    run->iterations[i] = second;
  }
  model_.setSnapshot(run);
  EXPECT_EQ(model_.iterationName(0), QStringLiteral("1.1"));
  EXPECT_EQ(model_.iterationName(1), QStringLiteral("2.1"));
  EXPECT_EQ(model_.iterationName(2), QStringLiteral("2.2"));
}

}  // namespace
}  // namespace boresight::ui
