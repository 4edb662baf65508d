// SPDX-License-Identifier: Apache-2.0
#include "ui/models/options_model.h"

#include <gtest/gtest.h>
#include <QFont>
#include <QtTest>

namespace boresight::ui {
namespace {

using Tester = QAbstractItemModelTester;

class OptionsModelTest : public testing::Test {
 protected:
  OptionsModelTest() { filter_.setSourceModel(&model_); }

  QModelIndex find(const char* name, OptionsModel::Column column = OptionsModel::kValue) const {
    for (int branch = 0; branch < model_.rowCount(); ++branch) {
      const QModelIndex parent = model_.index(branch, 0);
      for (int row = 0; row < model_.rowCount(parent); ++row)
        if (model_.option(model_.index(row, 0, parent))->name == name)
          return model_.index(row, column, parent);
    }
    return {};
  }
  int leaves(const QAbstractItemModel& model) const {
    int count = 0;
    for (int branch = 0; branch < model.rowCount(); ++branch)
      count += model.rowCount(model.index(branch, 0));
    return count;
  }

  OptionsModel model_;
  OptionsFilter filter_;
  Tester model_tester_{&model_, Tester::FailureReportingMode::Fatal};
  Tester filter_tester_{&filter_, Tester::FailureReportingMode::Fatal};
};

TEST_F(OptionsModelTest, HasALeafForEveryOptionOfARun) {
  const auto all = sessions::listOptions(LocalizerOptions());
  EXPECT_EQ(leaves(model_), static_cast<int>(all.size()));
  for (const auto& option : all) {
    const QModelIndex value = find(option.name.c_str());
    ASSERT_TRUE(value.isValid()) << option.name;
    EXPECT_EQ(value.siblingAtColumn(OptionsModel::kUnit).data().toString().toStdString(),
              option.unit);
    EXPECT_TRUE(
        value.data(Qt::ToolTipRole).toString().contains(QString::fromStdString(option.help)));
    EXPECT_FALSE(value.siblingAtColumn(OptionsModel::kRange).data().toString().isEmpty());
    EXPECT_FALSE(model_.isChanged(value));
  }
}

TEST_F(OptionsModelTest, TakesValuesOfEveryKind) {
  QSignalSpy edits(&model_, &OptionsModel::edited);
  EXPECT_TRUE(model_.setData(find("loop.max_iterations"), QStringLiteral("7")));
  EXPECT_TRUE(model_.setData(find("loop.inlier_threshold_px"), QStringLiteral(" 2.5 ")));
  EXPECT_TRUE(model_.setData(find("loop.correction_point"), QStringLiteral("camera")));
  EXPECT_TRUE(model_.setData(find("refinement.enabled"), Qt::Unchecked, Qt::CheckStateRole));
  EXPECT_EQ(model_.options().loop.max_iterations, 7);
  EXPECT_EQ(model_.options().loop.inlier_threshold_px, 2.5);
  EXPECT_EQ(model_.options().loop.correction_point, CorrectionPoint::kCamera);
  EXPECT_FALSE(model_.options().refinement.enabled);
  EXPECT_EQ(edits.count(), 4);
  EXPECT_EQ(model_.changedCount(), 4);
  EXPECT_TRUE(find("loop.max_iterations").data(Qt::FontRole).value<QFont>().bold());
  EXPECT_FALSE(find("loop.max_attempts").data(Qt::FontRole).value<QFont>().bold());
}

TEST_F(OptionsModelTest, RefusesWhatIsOutOfRangeAndTellsTheRange) {
  QSignalSpy refusals(&model_, &OptionsModel::refused);
  QSignalSpy edits(&model_, &OptionsModel::edited);
  const LocalizerOptions before = model_.options();
  EXPECT_FALSE(model_.setData(find("loop.max_iterations"), QStringLiteral("51")));
  EXPECT_FALSE(model_.setData(find("loop.max_iterations"), QStringLiteral("many")));
  EXPECT_FALSE(model_.setData(find("loop.inlier_threshold_px"), QStringLiteral("0,5")));
  EXPECT_EQ(refusals.count(), 3);
  EXPECT_EQ(edits.count(), 0);
  const QString message = refusals.at(0).at(0).toString();
  EXPECT_TRUE(message.contains(QStringLiteral("loop.max_iterations"))) << message.toStdString();
  EXPECT_TRUE(message.contains(QStringLiteral("1 .. 50"))) << message.toStdString();
  EXPECT_TRUE(sessions::changedOptions(model_.options(), before).empty());
}

TEST_F(OptionsModelTest, GoesBackToTheProfile) {
  model_.setData(find("loop.max_iterations"), QStringLiteral("7"));
  const QModelIndex reset = find("loop.max_iterations", OptionsModel::kReset);
  EXPECT_FALSE(reset.data().toString().isEmpty());
  model_.reset(reset);
  EXPECT_TRUE(reset.data().toString().isEmpty());
  EXPECT_EQ(model_.options().loop.max_iterations, LoopOptions().max_iterations);
  model_.setData(find("loop.max_iterations"), QStringLiteral("7"));
  model_.resetAll();
  EXPECT_EQ(model_.changedCount(), 0);
}

TEST_F(OptionsModelTest, ComparesWithTheChosenProfile) {
  ASSERT_TRUE(OptionsModel::profiles().contains(QStringLiteral("paper")));
  model_.setProfile(QStringLiteral("paper"));
  EXPECT_TRUE(sessions::changedOptions(model_.options(), paperProfile()).empty());
  EXPECT_EQ(model_.changedCount(), 0);
  model_.setOptions(QStringLiteral("paper"), defaultProfile());
  EXPECT_EQ(model_.changedCount(),
            static_cast<int>(sessions::changedOptions(defaultProfile(), paperProfile()).size()));
  EXPECT_GT(model_.changedCount(), 0);
}

TEST_F(OptionsModelTest, FindsOptionsByTheirWords) {
  filter_.setWords(QStringLiteral("RANSAC threshold first"));
  ASSERT_EQ(leaves(filter_), 1);
  const QModelIndex found = filter_.mapToSource(filter_.index(0, 0, filter_.index(0, 0)));
  EXPECT_EQ(model_.option(found)->name, "loop.inlier_threshold_px");
  filter_.setWords(QString());
  EXPECT_EQ(leaves(filter_), leaves(model_));
  filter_.setChangedOnly(true);
  EXPECT_EQ(filter_.rowCount(), 0);
  model_.setData(find("loop.max_iterations"), QStringLiteral("7"));
  filter_.setChangedOnly(true);
  EXPECT_EQ(leaves(filter_), 1);
}

}  // namespace
}  // namespace boresight::ui
