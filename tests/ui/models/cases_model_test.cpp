// SPDX-License-Identifier: Apache-2.0
#include "ui/models/cases_model.h"

#include <gtest/gtest.h>
#include <QSet>
#include <QtTest>

namespace boresight::ui {
namespace {

using Tester = QAbstractItemModelTester;

CaseRow rowNamed(const char* id, CaseState state, std::optional<double> normal_mm = {}) {
  CaseRow row;
  row.id = QString::fromLatin1(id);
  row.station = row.id.left(2);
  row.state = state;
  row.normal_mm = normal_mm;
  return row;
}

std::vector<CaseRow> someRows() {
  return {rowNamed("bc-2", CaseState::kConverged, 0.25), rowNamed("os-1", CaseState::kNew),
          rowNamed("bc-1", CaseState::kFailed, 9.5)};
}

class CasesModelTest : public testing::Test {
 protected:
  CasesModelTest() {
    filter_.setSourceModel(&model_);
    model_.setRows(someRows());
  }

  QStringList listed() const {
    QStringList ids;
    for (int row = 0; row < filter_.rowCount(); ++row)
      ids.append(filter_.index(row, 0).data().toString());
    return ids;
  }

  CasesModel model_;
  RowsFilter filter_;
  Tester model_tester_{&model_, Tester::FailureReportingMode::Fatal};
  Tester filter_tester_{&filter_, Tester::FailureReportingMode::Fatal};
};

TEST_F(CasesModelTest, ShowsStateAndErrors) {
  EXPECT_EQ(model_.index(0, CasesModel::kNormal_mm).data().toString(), QStringLiteral("0.250"));
  EXPECT_EQ(model_.index(1, CasesModel::kNormal_mm).data().toString(), QString());
  EXPECT_EQ(model_.index(0, CasesModel::kState).data().toString(), QStringLiteral("✓ converged"));
  EXPECT_EQ(model_.rowOf(QStringLiteral("bc-1")), 2);
  EXPECT_EQ(model_.rowOf(QStringLiteral("none")), -1);
}

TEST_F(CasesModelTest, SaysThatARunIsStale) {
  std::vector<CaseRow> rows = someRows();
  rows[0].stale = true;
  model_.setRows(rows);
  EXPECT_EQ(model_.index(0, CasesModel::kState).data().toString(),
            QStringLiteral("✓ converged, stale"));
  EXPECT_TRUE(model_.index(0, 0)
                  .data(Qt::ToolTipRole)
                  .toString()
                  .contains(QStringLiteral("Stale: the inputs or options have changed")));
}

TEST_F(CasesModelTest, EveryStateHasASignOfItsOwn) {
  QSet<QChar> signs;
  for (int i = 0; i < kCaseStateCount; ++i)
    signs.insert(CasesModel::stateText(static_cast<CaseState>(i)).at(0));
  EXPECT_EQ(signs.size(), kCaseStateCount);
}

TEST_F(CasesModelTest, ChangesInPlaceWhileTheCasesStay) {
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

TEST_F(CasesModelTest, TheUnknownIsLastWhereverItCameFrom) {
  model_.setRows({rowNamed("a", CaseState::kNew), rowNamed("b", CaseState::kConverged, 10.0),
                  rowNamed("c", CaseState::kNew), rowNamed("d", CaseState::kConverged, 9.0),
                  rowNamed("e", CaseState::kConverged, 11.0)});
  filter_.sort(CasesModel::kNormal_mm, Qt::DescendingOrder);
  EXPECT_EQ(listed().mid(0, 3).join(QLatin1Char(' ')), QStringLiteral("e b d"));
  filter_.sort(CasesModel::kNormal_mm, Qt::AscendingOrder);
  EXPECT_EQ(listed().mid(0, 3).join(QLatin1Char(' ')), QStringLiteral("d b e"));
}

TEST_F(CasesModelTest, SortsErrorsAsNumbersAndTheUnknownLast) {
  filter_.sort(CasesModel::kNormal_mm, Qt::AscendingOrder);
  EXPECT_EQ(listed().join(QLatin1Char(' ')), QStringLiteral("bc-2 bc-1 os-1"));
  filter_.sort(CasesModel::kNormal_mm, Qt::DescendingOrder);
  EXPECT_EQ(listed().join(QLatin1Char(' ')), QStringLiteral("bc-1 bc-2 os-1"));
  filter_.sort(CasesModel::kCase, Qt::AscendingOrder);
  EXPECT_EQ(listed().join(QLatin1Char(' ')), QStringLiteral("bc-1 bc-2 os-1"));
}

}  // namespace
}  // namespace boresight::ui
