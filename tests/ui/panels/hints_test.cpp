// SPDX-License-Identifier: Apache-2.0
#include <gtest/gtest.h>
#include <QtTest>
#include <QtWidgets>

#include "tests/ui/window_test.h"
#include "ui/widgets/column_fitter.h"
#include "ui/widgets/widgets.h"

namespace boresight::ui {
namespace {

struct EmptyHintTest : testing::Test {
  EmptyHintTest() { view.setModel(&model); }

  QStringListModel model;
  QListView view;
};

TEST_F(EmptyHintTest, ShowsWhileTheListIsEmptyAndKeepsToTheViewport) {
  auto* hint = new EmptyHint(view);
  view.resize(200, 100);
  view.show();
  EXPECT_TRUE(hint->isVisible());
  view.resize(420, 310);
  EXPECT_EQ(hint->size(), view.viewport()->size());
  model.setStringList({QStringLiteral("one")});
  EXPECT_FALSE(hint->isVisible());
  model.removeRows(0, 1);
  EXPECT_TRUE(hint->isVisible());
}

TEST_F(EmptyHintTest, MayLeaveARowThatIsAlwaysThere) {
  model.setStringList({QStringLiteral("seed")});
  auto* hint = new EmptyHint(view, 1);
  view.show();
  EXPECT_TRUE(hint->isVisible());
  model.setStringList({QStringLiteral("seed"), QStringLiteral("1.1")});
  EXPECT_FALSE(hint->isVisible());
}

/// Whatever its height, also after scrolling.
TEST(TableRows, ATableEndsWithAWholeRow) {
  QStandardItemModel model(30, 1);
  QTableView table;
  setUpTable(table, model);
  table.show();
  const auto* cover = table.findChild<QWidget*>(QStringLiteral("rowCover"));
  const int row = table.rowHeight(0);
  for (const int height : {200, 207, 213, 219}) {
    table.resize(160, height);
    table.verticalScrollBar()->setValue(height % 5);
    table.grab();
    const int room = table.viewport()->height();
    const int cut = room % row;
    EXPECT_EQ(cover->isVisible(), cut > 0) << height;
    if (cut == 0) continue;
    EXPECT_EQ(cover->geometry(), QRect(0, room - cut, table.viewport()->width(), cut)) << height;
  }
  table.resize(160, 207);
  table.verticalScrollBar()->setValue(table.verticalScrollBar()->maximum());
  table.grab();
  EXPECT_EQ(cover->geometry().top(), 0) << "Qt shows the last row whole and cuts the first one";
  EXPECT_EQ(cover->height(), table.viewport()->height() % row);
  table.resize(160, 8 * row + table.horizontalHeader()->height() + 2 * table.frameWidth());
  model.setRowCount(2);
  table.grab();
  EXPECT_FALSE(cover->isVisible()) << "all rows are whole";
}

struct TableColumns : testing::Test {
  TableColumns() { table.setObjectName(QStringLiteral("table")); }
  /// A table of columns 100 px wide.
  void fill(int columns) {
    model.setColumnCount(columns);
    model.setRowCount(3);
    setUpTable(table, model);
    for (int column = 0; column < columns; ++column) table.setColumnWidth(column, 100);
  }

  test::TemporaryFolder folder;
  test::OwnSettings settings{folder.path()};
  QStandardItemModel model;
  QTableView table;
};

TEST_F(TableColumns, HiddenOnesAreRemembered) {
  fill(3);
  table.show();
  QTimer::singleShot(0, &table, [] {
    auto* menu = qobject_cast<QMenu*>(QApplication::activePopupWidget());
    ASSERT_NE(menu, nullptr);
    menu->actions()[1]->trigger();
    menu->close();
  });
  Q_EMIT table.horizontalHeader()->customContextMenuRequested({5, 5});
  EXPECT_TRUE(table.isColumnHidden(1));
  QTableView again;
  again.setObjectName(table.objectName());
  setUpTable(again, model);
  again.setColumnHidden(2, true);  // what this panel hides at first
  QApplication::processEvents();
  EXPECT_TRUE(again.isColumnHidden(1));
  EXPECT_FALSE(again.isColumnHidden(2)) << "the operator's choice counts";
}

TEST_F(TableColumns, Fitter_HidesWhatCanBeDoneWithoutUntilAllFitsAndBringsItBack) {
  fill(5);
  new ColumnFitter(table, {4, 2, 3});
  table.resize(600, 200);
  table.show();
  const auto hidden = [this] {
    std::vector<int> columns;
    for (int column = 0; column < 5; ++column)
      if (table.isColumnHidden(column)) columns.push_back(column);
    return columns;
  };
  EXPECT_EQ(hidden(), std::vector<int>{});
  table.resize(450, 200);
  EXPECT_EQ(hidden(), std::vector<int>{4});
  table.resize(350, 200);
  EXPECT_EQ(hidden(), (std::vector<int>{2, 4}));
  table.resize(120, 200);
  EXPECT_EQ(hidden(), (std::vector<int>{2, 3, 4})) << "0 and 1 always stay";
  table.resizeColumnToContents(4);
  table.resize(600, 200);
  EXPECT_EQ(hidden(), std::vector<int>{});
  EXPECT_EQ(table.columnWidth(4), 100);
}

TEST_F(TableColumns, Fitter_CountsOfTheStretchedLastColumnWhatItNeeds) {
  fill(3);
  table.horizontalHeader()->setStretchLastSection(true);
  new ColumnFitter(table, {1});
  table.resize(600, 200);
  table.show();
  EXPECT_FALSE(table.isColumnHidden(1)) << "there is room, though the last column takes it";
  table.resize(160, 200);
  EXPECT_TRUE(table.isColumnHidden(1));
  table.resize(600, 200);
  EXPECT_FALSE(table.isColumnHidden(1));
}

TEST(Banner, CountsTheWarningsThatItDoesNotShowAndHidesWithoutAny) {
  Banner banner;
  banner.setAction(QStringLiteral("Inputs"), QStringLiteral("Show them"));
  banner.showWarnings(
      {QStringLiteral("a"), QStringLiteral("b"), QStringLiteral("c"), QStringLiteral("d")});
  EXPECT_TRUE(banner.isVisible());
  EXPECT_EQ(banner.text(), QStringLiteral("a\nb\nand 2 more"));
  EXPECT_EQ(banner.findChild<QLabel*>()->text(), QString::fromUtf8("⚠"))
      << "a sign in addition to the colour";
  QSignalSpy asked(&banner, &Banner::actionRequested);
  QTest::mouseClick(banner.findChild<QToolButton*>(), Qt::LeftButton);
  EXPECT_EQ(asked.count(), 1);
  banner.showWarnings({});
  EXPECT_FALSE(banner.isVisible());
}

}  // namespace
}  // namespace boresight::ui
