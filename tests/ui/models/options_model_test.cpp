// SPDX-License-Identifier: Apache-2.0
#include "ui/models/options_model.h"

#include <gtest/gtest.h>
#include <QFont>
#include <QtTest>

#include "core/localizer/localizer_options.h"

namespace boresight::ui {
namespace {

class OptionsModelTest : public testing::Test {
 protected:
  OptionsModelTest() {
    show({});
    QObject::connect(&model_, &OptionsModel::edited, &model_,
                     [this](const std::string& name, const std::string& value) {
                       edits_.emplace_back(name, value);
                     });
  }

  void show(const LocalizerOptions& options) {
    model_.setOptions(sessions::listOptions(options), sessions::listOptions(LocalizerOptions()));
  }

  QModelIndex find(const char* name, OptionsModel::Column column = OptionsModel::kValue) const {
    const auto is_named = [name](const OptionRow& row) { return row.now.name == name; };
    return model_.index(model_.firstRow(is_named), column);
  }

  OptionsModel model_;
  std::vector<std::pair<std::string, std::string>> edits_;
  QAbstractItemModelTester tester_{&model_, QAbstractItemModelTester::FailureReportingMode::Fatal};
};

TEST_F(OptionsModelTest, HasARowForEveryOptionOfARun) {
  const auto all = sessions::listOptions(LocalizerOptions());
  ASSERT_EQ(model_.rowCount(), static_cast<int>(all.size()));
  for (const auto& option : all) {
    const QModelIndex value = find(option.name.c_str());
    ASSERT_TRUE(value.isValid()) << option.name;
    EXPECT_EQ(value.siblingAtColumn(OptionsModel::kUnit).data().toString().toStdString(),
              option.unit);
    EXPECT_TRUE(
        value.data(Qt::ToolTipRole).toString().contains(QString::fromStdString(option.help)));
    EXPECT_FALSE(value.siblingAtColumn(OptionsModel::kRange).data().toString().isEmpty());
  }
  EXPECT_EQ(model_.changedCount(), 0);
}

TEST_F(OptionsModelTest, ReportsValuesOfEveryKindAndKeepsItsOwn) {
  EXPECT_TRUE(model_.setData(find("loop.max_iterations"), QStringLiteral("7")));
  EXPECT_TRUE(model_.setData(find("loop.inlier_threshold_px"), QStringLiteral(" 2.5 ")));
  EXPECT_TRUE(model_.setData(find("refinement.enabled"), Qt::Unchecked, Qt::CheckStateRole));
  using Edits = decltype(edits_);
  EXPECT_EQ(edits_, (Edits{{"loop.max_iterations", "7"},
                           {"loop.inlier_threshold_px", "2.5"},
                           {"refinement.enabled", "false"}}));
  EXPECT_EQ(model_.changedCount(), 0);
  const QString before = find("loop.max_iterations").data().toString();
  EXPECT_TRUE(model_.setData(find("loop.max_iterations"), before));
  EXPECT_EQ(edits_.size(), 3u) << "the same value is no edit";
}

TEST_F(OptionsModelTest, MarksAndResetsWhatDiffersFromTheDefault) {
  LocalizerOptions options;
  options.loop.max_iterations = 7;
  show(options);
  EXPECT_EQ(model_.changedCount(), 1);
  EXPECT_TRUE(find("loop.max_iterations").data(Qt::FontRole).value<QFont>().bold());
  EXPECT_FALSE(find("loop.max_attempts").data(Qt::FontRole).value<QFont>().bold());
  const QModelIndex reset = find("loop.max_iterations", OptionsModel::kReset);
  EXPECT_FALSE(reset.data().toString().isEmpty());
  model_.reset(find("loop.max_attempts").row());
  EXPECT_TRUE(edits_.empty());
  model_.reset(reset.row());
  ASSERT_EQ(edits_.size(), 1u);
  EXPECT_EQ(edits_[0].second, std::to_string(LoopOptions().max_iterations));
  show({});
  EXPECT_TRUE(reset.data().toString().isEmpty());
}

}  // namespace
}  // namespace boresight::ui
