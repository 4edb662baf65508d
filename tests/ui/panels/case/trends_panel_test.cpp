// SPDX-License-Identifier: Apache-2.0
#include "ui/panels/case/trends_panel.h"

#include "sessions/session/session_file.h"
#include "tests/ui/window_test.h"
#include "ui/plots/plots.h"

namespace boresight::ui {
namespace {

class TrendsPanelTest : public test::WindowTest {
 protected:
  TrendsPanel& panel() { return *window_.findChild<TrendsPanel*>(); }
  QString note() { return find<QLabel>("trendNote").text(); }
  bool shows(int rows) {
    return wait([&] { return !panel().isBusy() && panel().model().rowCount() == rows; });
  }
};

TEST_F(TrendsPanelTest, ListsTheConvergedRunsOfThisAndEarlierSessions_NamesAnUnreadableOne) {
  openExample();
  window_.dock(QStringLiteral("trends"))->show();
  ASSERT_TRUE(shows(0));
  EXPECT_EQ(note(), QStringLiteral("No converged run yet."));
  ASSERT_TRUE(runToTheEnd(1));
  ASSERT_TRUE(shows(1)) << note().toStdString();
  EXPECT_TRUE(test::has(note(), "1 case(s) without a converged run"));
  const sessions::TrendPoint& point = panel().model().at(0);
  EXPECT_EQ(point.case_id, window_.cases().caseId().toStdString());
  EXPECT_GT(point.figures[6], 0.0) << "the residual";
  EXPECT_EQ(panel().findChild<DoublePlot*>()->leftCount(), 1);
  ASSERT_TRUE(window_.document().saveAs(folder_.path() / "renamed.boresight.json"));
  ASSERT_TRUE(shows(1));
  EXPECT_EQ(panel().model().at(0).session, window_.document().file()) << "a double click opens it";
  const auto earlier = folder_.path() / "sol11.boresight.json";
  sessions::writeSessionFile(earlier, window_.document().session());
  panel().setEarlier({earlier});
  ASSERT_TRUE(shows(2));
  EXPECT_EQ(panel().model().at(0).session, earlier) << "in the order of time";
  EXPECT_EQ(panel().findChild<DoublePlot*>()->leftCount(), 2);
  EXPECT_TRUE(test::has(note(), "0 of 2 runs stand out"));
  panel().setEarlier({folder_.path() / "missing.boresight.json"});
  ASSERT_TRUE(shows(0));
  EXPECT_TRUE(test::has(note(), "missing.boresight.json"));
  std::filesystem::copy_file(earlier, folder_.path() / "missing.boresight.json");
  panel().setEarlier({folder_.path() / "missing.boresight.json"});
  EXPECT_TRUE(shows(2)) << "it is read again";
}

TEST(TrendsModel, MarksWhatStandsOut) {
  sessions::TrendPoint point;
  point.figures[2] = 1.25;
  point.outlier[2] = true;
  TrendsModel model;
  model.setRows({point}, false);
  const QModelIndex z = model.index(0, TrendsModel::kFirstFigure + 2);
  EXPECT_EQ(z.data().toString(), QStringLiteral("1.250 !"));
  EXPECT_TRUE(z.data(Qt::FontRole).value<QFont>().bold());
  EXPECT_EQ(z.siblingAtColumn(TrendsModel::kFirstFigure).data().toString(),
            QStringLiteral("0.000"));
}

}  // namespace
}  // namespace boresight::ui
