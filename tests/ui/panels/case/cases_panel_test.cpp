// SPDX-License-Identifier: Apache-2.0
#include "ui/panels/case/cases_panel.h"

#include <algorithm>

#include <gtest/gtest.h>
#include <QSet>
#include <QtTest>
#include <QtWidgets>

#include "tests/ui/models/tested_model.h"
#include "ui/style/theme.h"

namespace boresight::ui {
namespace {

CaseRow rowNamed(const char* id, CaseState state, std::optional<double> normal_mm = {}) {
  CaseRow row;
  row.id = QString::fromLatin1(id);
  row.station = row.id.left(2);
  row.state = state;
  row.normal_mm = normal_mm;
  return row;
}

class CasesPanelTest : public testing::Test {
 protected:
  CasesPanelTest() {
    panel_.resize(500, 400);
    panel_.show();
    panel_.setRows({rowNamed("os-2", CaseState::kNew), rowNamed("bc-1", CaseState::kFailed),
                    rowNamed("os-1", CaseState::kNew)});
  }
  QPushButton* button(const char* name) const {
    return panel_.findChild<QPushButton*>(QString::fromLatin1(name));
  }
  void clickRow(int row) {
    QTest::mouseClick(table_->viewport(), Qt::LeftButton, Qt::NoModifier,
                      table_->visualRect(table_->model()->index(row, 0)).center());
  }

  CasesPanel panel_;
  QTableView* table_ = panel_.findChild<QTableView*>();
};

TEST_F(CasesPanelTest, AClickAsksForACase) {
  QSignalSpy opened(&panel_, &CasesPanel::openRequested);
  EXPECT_FALSE(button("run")->isEnabled());
  clickRow(1);
  ASSERT_EQ(opened.count(), 1);
  EXPECT_EQ(opened.at(0).at(0).toString(), QStringLiteral("os-1"));
  QSignalSpy ran(&panel_, &CasesPanel::runRequested);
  QTest::mouseClick(button("run"), Qt::LeftButton);
  ASSERT_EQ(ran.count(), 1);
  EXPECT_EQ(ran.at(0).at(0).toString(), QStringLiteral("os-1"));
}

TEST_F(CasesPanelTest, OpenCaseAndChangedStates_AreShownWithoutAskingForACase) {
  clickRow(0);
  QSignalSpy opened(&panel_, &CasesPanel::openRequested);
  panel_.setRows({rowNamed("os-2", CaseState::kRunning), rowNamed("bc-1", CaseState::kFailed),
                  rowNamed("os-1", CaseState::kNew)});
  EXPECT_EQ(table_->currentIndex().row(), 0);
  panel_.setCurrent(QStringLiteral("os-2"));
  EXPECT_EQ(table_->currentIndex().row(), 2);
  EXPECT_EQ(opened.count(), 0);
}

/// Each iteration of a batch scrolled to the shown case and fitted the columns.
TEST_F(CasesPanelTest, ChangedStates_LeaveScrollingAndWidths) {
  std::vector<CaseRow> rows;
  for (int i = 0; i < 100; ++i) {
    rows.push_back(rowNamed("os", CaseState::kNew));
    rows.back().id += QString::number(1000 + i);
  }
  panel_.setRows(rows);
  panel_.setCurrent(rows[0].id);
  QScrollBar& bar = *table_->verticalScrollBar();
  bar.setValue(bar.maximum());
  const int place = bar.value();
  ASSERT_GT(place, 0);
  table_->setColumnWidth(CasesModel::kNormal_mm, 123);
  rows[5].state = CaseState::kRunning;
  panel_.setRows(rows);
  EXPECT_EQ(bar.value(), place);
  EXPECT_EQ(table_->columnWidth(CasesModel::kNormal_mm), 123);
  panel_.setCurrent(rows[1].id);
  EXPECT_LT(bar.value(), place) << "another case is scrolled to";
}

TEST_F(CasesPanelTest, RunAll_RunsTheListedCases_ThoseOfAWordOrOfAState) {
  QTest::keyClicks(panel_.findChild<QLineEdit*>(), QStringLiteral("os"));
  QSignalSpy ran(&panel_, &CasesPanel::runAllRequested);
  QTest::mouseClick(button("runAll"), Qt::LeftButton);
  ASSERT_EQ(ran.count(), 1);
  EXPECT_EQ(ran.at(0).at(0).toStringList().join(QLatin1Char(' ')), QStringLiteral("os-1 os-2"));
  panel_.setRunnable(false);
  EXPECT_FALSE(button("runAll")->isEnabled());
  panel_.findChild<QLineEdit*>()->clear();
  panel_.findChild<QComboBox*>()->setCurrentIndex(1 + static_cast<int>(CaseState::kFailed));
  EXPECT_EQ(panel_.listed(), QStringList{QStringLiteral("bc-1")});
}

TEST_F(CasesPanelTest, NameStateAndTheFirstErrorAreInSightInANarrowList) {
  applyTheme(*qApp, ThemeName::kLight);  // for its font
  std::vector<CaseRow> rows(1);
  rows[0].id = QString(60, QLatin1Char('w'));
  rows[0].state = CaseState::kAnnotated;
  rows[0].normal_mm = -0.123;
  rows[0].lateral_mm = 10.456;
  panel_.resize(252, 400);  // of a window 1280 wide
  panel_.setRows(rows);
  const auto right = [this](int column) {
    return table_->columnViewportPosition(column) + table_->columnWidth(column);
  };
  EXPECT_LE(right(CasesModel::kNormal_mm), table_->viewport()->width());
  const QImage annotated = table_->viewport()->grab().toImage();
  rows[0].state = CaseState::kFailed;
  panel_.setRows(rows);
  EXPECT_NE(table_->viewport()->grab(QRect(0, 0, right(CasesModel::kCase), 44)).toImage(),
            annotated.copy(0, 0, right(CasesModel::kCase), 44))
      << "the state is shown next to the name";
}

TEST_F(CasesPanelTest, TheEndOfALongNameIsSeenInANarrowList_MoreOfItInAWiderOne) {
  panel_.resize(252, 400);
  std::vector<CaseRow> rows(1);
  const auto painted = [&](int number) {
    rows[0].id = QStringLiteral("a_dataset_of_a_long_name-s%1").arg(number);
    panel_.setRows(rows);
    return table_->viewport()->grab().toImage();
  };
  EXPECT_NE(painted(1), painted(4)) << "the end is what tells a case from the next";
  const int narrow = table_->columnWidth(CasesModel::kCase);
  panel_.resize(600, 400);
  EXPECT_GT(table_->columnWidth(CasesModel::kCase), narrow);
}

TEST_F(CasesPanelTest, TheWholeStateIsSeenInTheNarrowestList) {
  std::vector<CaseRow> rows(1);
  rows[0].id = QStringLiteral("x");
  rows[0].thumbnail = QImage(64, 64, QImage::Format_Grayscale8);
  rows[0].thumbnail.fill(Qt::gray);
  int needed = 0;
  for (int i = 0; i < kCaseStateCount; ++i) {
    rows[0].state = static_cast<CaseState>(i);
    panel_.setRows(rows);
    table_->resizeColumnToContents(CasesModel::kCase);
    needed = std::max(needed, table_->columnWidth(CasesModel::kCase));
  }
  panel_.resize(panel_.minimumSizeHint().width(), 400);
  rows[0].id = QString(60, QLatin1Char('w'));
  panel_.setRows(rows);
  EXPECT_GE(table_->columnWidth(CasesModel::kCase), needed);
}

std::vector<CaseRow> someRows() {
  return {rowNamed("bc-2", CaseState::kConverged, 0.25), rowNamed("os-1", CaseState::kNew),
          rowNamed("bc-1", CaseState::kFailed, 9.5)};
}

class CasesModelTest : public test::TestedModel<CasesModel> {
 protected:
  CasesModelTest() { model_.setRows(someRows()); }

  QString sorted(CasesModel::Column column, Qt::SortOrder order) {
    filter_.sort(column, order);
    QString ids;
    for (int row = 0; row < filter_.rowCount(); ++row)
      ids += filter_.index(row, 0).data().toString();
    return ids;
  }
};

TEST_F(CasesModelTest, ShowsStateAndErrorsAndThatARunIsOutdated) {
  EXPECT_EQ(text(0, CasesModel::kNormal_mm), QStringLiteral("0.250"));
  EXPECT_EQ(text(1, CasesModel::kNormal_mm), QString());
  EXPECT_EQ(text(0, CasesModel::kState), QStringLiteral("✓ converged"));
  EXPECT_EQ(model_.rowOf(QStringLiteral("bc-1")), 2);
  EXPECT_EQ(model_.rowOf(QStringLiteral("none")), -1);
  std::vector<CaseRow> rows = someRows();
  rows[0].stale = true;
  model_.setRows(rows);
  EXPECT_EQ(text(0, CasesModel::kState), QStringLiteral("✓ converged, outdated"));
  const QString tip = model_.index(0, 0).data(Qt::ToolTipRole).toString();
  EXPECT_TRUE(
      tip.contains(QStringLiteral("Outdated: the run was made with other inputs or options")));
}

TEST_F(CasesModelTest, States_HaveDistinctSigns) {
  QSet<QChar> signs;
  for (int i = 0; i < kCaseStateCount; ++i)
    signs.insert(CasesModel::stateText(static_cast<CaseState>(i)).at(0));
  EXPECT_EQ(signs.size(), kCaseStateCount);
}

TEST_F(CasesModelTest, EqualCases_UpdateRowsInPlace) {
  QSignalSpy resets(&model_, &QAbstractItemModel::modelReset);
  QSignalSpy changes(&model_, &QAbstractItemModel::dataChanged);
  std::vector<CaseRow> rows = someRows();
  rows[1].state = CaseState::kRunning;
  model_.setRows(rows);
  EXPECT_EQ(changes.count(), 1);
  EXPECT_EQ(resets.count(), 0);
  rows.pop_back();
  model_.setRows(rows);
  EXPECT_EQ(resets.count(), 1);
}

TEST_F(CasesModelTest, UnknownValues_SortLast) {
  model_.setRows({rowNamed("a", CaseState::kNew), rowNamed("b", CaseState::kConverged, 10.0),
                  rowNamed("c", CaseState::kNew), rowNamed("d", CaseState::kConverged, 9.0),
                  rowNamed("e", CaseState::kConverged, 11.0)});
  EXPECT_EQ(sorted(CasesModel::kNormal_mm, Qt::DescendingOrder).left(3), QStringLiteral("ebd"));
  EXPECT_EQ(sorted(CasesModel::kNormal_mm, Qt::AscendingOrder).left(3), QStringLiteral("dbe"));
  EXPECT_EQ(sorted(CasesModel::kCase, Qt::DescendingOrder), QStringLiteral("edcba"));
}

}  // namespace
}  // namespace boresight::ui
