// SPDX-License-Identifier: Apache-2.0
#include "ui/panels/diagnose/configuration_panel.h"

#include <gtest/gtest.h>
#include <QFont>
#include <QtTest>
#include <QtWidgets>

#include "core/localizer/localizer_options.h"
#include "tests/support/example_run.h"
#include "tests/ui/models/tested_model.h"
#include "ui/panels/diagnose/options_table.h"
#include "ui/widgets/widgets.h"

namespace boresight::ui {
namespace {

LocalizerOptions sevenIterations() {
  LocalizerOptions options;
  options.loop.max_iterations = 7;
  return options;
}

class ConfigurationPanelTest : public testing::Test {
 protected:
  ConfigurationPanelTest() {
    panel_.resize(900, 700);
    panel_.show();
    table_ = panel_.findChild<OptionsTable*>(QStringLiteral("options"));
    stale_ = panel_.findChild<Banner*>(QStringLiteral("stale"));
    QObject::connect(&panel_, &ConfigurationPanel::optionsEdited, &panel_,
                     [this](const QString& profile, const LocalizerOptions& options) {
                       ++edits_;
                       profile_ = profile;
                       options_ = options;
                     });
  }

  /// The row of the one option that the words find.
  QModelIndex find(const QString& words, int column = OptionsModel::kValue) {
    auto* line = panel_.findChild<QLineEdit*>();
    line->clear();
    QTest::keyClicks(line, words);
    const QAbstractItemModel& model = *table_->model();
    EXPECT_EQ(model.rowCount(), 1) << words.toStdString();
    return model.index(0, column);
  }
  /// Opens the editor as a person does, with F2.
  template <class Editor>
  Editor* edit(const QString& words) {
    table_->setCurrentIndex(find(words));
    table_->setFocus();
    QTest::keyClick(table_, Qt::Key_F2);
    return table_->viewport()->findChild<Editor*>();
  }
  /// The editor commits when the event loop comes round.
  static void enter(QWidget* editor) {
    QTest::keyClick(editor, Qt::Key_Return);
    QApplication::processEvents();
  }
  template <class Editor>
  void type(const QString& words, const QString& text) {
    auto* editor = edit<Editor>(words);
    ASSERT_NE(editor, nullptr);
    editor->selectAll();
    QTest::keyClicks(editor, text);
    enter(editor);
  }
  QString help() const { return panel_.findChild<QLabel*>(QStringLiteral("help"))->text(); }

  ViewState view_;
  ConfigurationPanel panel_{view_};
  OptionsTable* table_ = nullptr;
  Banner* stale_ = nullptr;
  int edits_ = 0;
  QString profile_;
  LocalizerOptions options_;
};

TEST_F(ConfigurationPanelTest, AnIntegerIsEditedInASpinBox) {
  type<QSpinBox>(QStringLiteral("loop.max_iterations"), QStringLiteral("12"));
  EXPECT_EQ(edits_, 1);
  EXPECT_EQ(options_.loop.max_iterations, 12);
  EXPECT_TRUE(help().contains(QStringLiteral("loop.max_iterations")));
}

TEST_F(ConfigurationPanelTest, AValueOutOfRangeIsRefusedWithItsRange) {
  type<QSpinBox>(QStringLiteral("loop.max_iterations"), QStringLiteral("99"));
  EXPECT_EQ(edits_, 0);
  EXPECT_TRUE(help().contains(QStringLiteral("99 is outside 1 .. 50"))) << help().toStdString();
  EXPECT_EQ(panel_.options().loop.max_iterations, LoopOptions().max_iterations);
}

TEST_F(ConfigurationPanelTest, EditThatTheSessionRefuses_DoesNotStayInThePanel) {
  type<QSpinBox>(QStringLiteral("loop.max_iterations"), QStringLiteral("12"));
  EXPECT_EQ(edits_, 1) << "it is not taken yet";
  EXPECT_EQ(panel_.options().loop.max_iterations, LoopOptions().max_iterations);
  EXPECT_EQ(find(QStringLiteral("loop.max_iterations")).data().toInt(),
            LoopOptions().max_iterations);
}

TEST_F(ConfigurationPanelTest, ANumberIsTypedInFull) {
  type<QLineEdit>(QStringLiteral("converged_rotation"), QStringLiteral("0.0123456789"));
  EXPECT_EQ(options_.loop.converged_rotation_rad, 0.0123456789);
}

TEST_F(ConfigurationPanelTest, AChoiceIsChosenFromAList) {
  auto* box = edit<QComboBox>(QStringLiteral("correction_point"));
  ASSERT_NE(box, nullptr);
  EXPECT_EQ(box->count(), 3);
  QTest::keyClick(box, Qt::Key_Up);
  enter(box);
  EXPECT_EQ(options_.loop.correction_point, CorrectionPoint::kCamera);
}

TEST_F(ConfigurationPanelTest, SpaceTogglesASwitch) {
  table_->setCurrentIndex(find(QStringLiteral("refinement.enabled")));
  table_->setFocus();
  QTest::keyClick(table_, Qt::Key_Space);
  EXPECT_FALSE(options_.refinement.enabled);
  EXPECT_EQ(edits_, 1);
}

TEST_F(ConfigurationPanelTest, FindsOptionsByTheirWordsAndByChange) {
  find(QStringLiteral("RANSAC threshold first"));
  panel_.findChild<QLineEdit*>()->clear();
  EXPECT_EQ(table_->model()->rowCount(), table_->options().rowCount());
  panel_.findChild<QCheckBox*>()->setChecked(true);
  EXPECT_EQ(table_->model()->rowCount(), 0);
  panel_.setOptions(QStringLiteral("default"), sevenIterations());
  EXPECT_EQ(table_->model()->rowCount(), 1);
}

TEST_F(ConfigurationPanelTest, ComparesWithTheChosenProfile_WhichSetsEverything) {
  panel_.setOptions(QStringLiteral("paper"), defaultProfile());
  EXPECT_EQ(table_->options().changedCount(),
            static_cast<int>(sessions::changedOptions(defaultProfile(), paperProfile()).size()));
  EXPECT_GT(table_->options().changedCount(), 0);
  panel_.setOptions(QStringLiteral("default"), defaultProfile());
  auto* box = panel_.findChild<QComboBox*>();
  box->setFocus();
  QTest::keyClicks(box, QStringLiteral("paper"));
  EXPECT_GE(edits_, 1);
  EXPECT_EQ(profile_, QStringLiteral("paper"));
  EXPECT_TRUE(sessions::changedOptions(options_, paperProfile()).empty());
}

TEST_F(ConfigurationPanelTest, AClickResetsARow) {
  panel_.setOptions(QStringLiteral("default"), sevenIterations());
  EXPECT_EQ(edits_, 0) << "the document is no person";
  const QModelIndex reset = find(QStringLiteral("loop.max_iterations"), OptionsModel::kReset);
  table_->scrollTo(reset);
  QTest::mouseClick(table_->viewport(), Qt::LeftButton, Qt::NoModifier,
                    table_->visualRect(reset).center());
  EXPECT_EQ(edits_, 1);
  EXPECT_EQ(options_.loop.max_iterations, LoopOptions().max_iterations);
}

TEST_F(ConfigurationPanelTest, SaysThatTheShownRunIsStale_NotForTheCasesFeatureSize) {
  EXPECT_FALSE(stale_->isVisible());
  view_.setSnapshot(test::exampleRun());
  EXPECT_FALSE(stale_->isVisible());
  panel_.setOptions(QStringLiteral("default"), sevenIterations());
  EXPECT_TRUE(stale_->isVisible());
  EXPECT_EQ(panel_.differences(),
            QStringList{QStringLiteral("loop.max_iterations (was 10, now 7)")});
  QSignalSpy asked(&panel_, &ConfigurationPanel::runAgainRequested);
  QTest::mouseClick(panel_.findChild<QToolButton*>(QStringLiteral("bannerAction")), Qt::LeftButton);
  EXPECT_EQ(asked.count(), 1);
  panel_.setOptions(QStringLiteral("default"), defaultProfile());
  EXPECT_FALSE(stale_->isVisible());
  auto run = std::make_shared<sessions::LocalizationTrace>(*test::exampleRun());
  run->options.templates.feature_size_m = 0.015;
  view_.setSnapshot(run);
  EXPECT_TRUE(stale_->isVisible());
  panel_.setCaseFeatureSize(0.015);
  EXPECT_FALSE(stale_->isVisible());
}

class OptionsModelTest : public test::TestedModel<OptionsModel> {
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

  std::vector<std::pair<std::string, std::string>> edits_;
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

TEST_F(OptionsModelTest, LongValues_AreRoundedForReadingAndWholeForEditing) {
  LocalizerOptions options;
  options.loop.inlier_threshold_px = 1.23456789012;
  show(options);
  const QModelIndex value = find("loop.inlier_threshold_px");
  EXPECT_EQ(value.data().toString(), QStringLiteral("1.23457"));
  EXPECT_EQ(value.data(Qt::EditRole).toString(), QStringLiteral("1.23456789012"));
  EXPECT_TRUE(value.data(Qt::ToolTipRole).toString().contains(QStringLiteral("1.23456789012")));
  EXPECT_TRUE(model_.setData(value, value.data(Qt::EditRole)));
  EXPECT_TRUE(edits_.empty()) << "an editor that is opened and closed changes nothing";
}

TEST_F(OptionsModelTest, ReportsTrimmedValuesAndKeepsItsOwn) {
  EXPECT_TRUE(model_.setData(find("loop.inlier_threshold_px"), QStringLiteral(" 2.5 ")));
  EXPECT_TRUE(model_.setData(find("refinement.enabled"), Qt::Unchecked, Qt::CheckStateRole));
  using Edits = decltype(edits_);
  EXPECT_EQ(edits_, (Edits{{"loop.inlier_threshold_px", "2.5"}, {"refinement.enabled", "false"}}));
  EXPECT_EQ(model_.changedCount(), 0);
}

TEST_F(OptionsModelTest, MarksAndResetsWhatDiffersFromTheDefault) {
  show(sevenIterations());
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
