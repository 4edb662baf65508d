// SPDX-License-Identifier: Apache-2.0
#include "ui/panels/input_sheet_panel.h"

#include <gtest/gtest.h>
#include <QApplication>
#include <QClipboard>
#include <QLabel>
#include <QTableWidget>
#include <QtTest/QTest>

namespace boresight::ui {
namespace {

sessions::InputSheet someSheet() {
  sessions::InputSheet sheet;
  sheet.lines = {{"image", "1280 x 1024 px, 8 bit"}, {"seed distance", "0.412 m"}};
  return sheet;
}

class InputSheetPanelTest : public testing::Test {
 protected:
  InputSheetPanelTest() { panel_.show(); }
  QString flags() const { return panel_.findChild<QLabel*>(QStringLiteral("flags"))->text(); }

  InputSheetPanel panel_;
};

TEST_F(InputSheetPanelTest, ShowsTheLinesOfASheet) {
  EXPECT_EQ(flags(), QStringLiteral("No case is open."));
  panel_.setSheet(someSheet());
  auto* table = panel_.findChild<QTableWidget*>();
  ASSERT_EQ(table->rowCount(), 2);
  EXPECT_EQ(table->item(1, 0)->text(), QStringLiteral("seed distance"));
  EXPECT_EQ(table->item(1, 1)->text(), QStringLiteral("0.412 m"));
  EXPECT_TRUE(flags().startsWith(QStringLiteral("✓")));
  panel_.setSheet(std::nullopt);
  EXPECT_EQ(table->rowCount(), 0);
}

TEST_F(InputSheetPanelTest, RedFlagsComeFirstInPlainSentences) {
  sessions::InputSheet sheet = someSheet();
  sheet.flags = {{"station_size", "the station is 1000 times too large"}, {"other", "also this"}};
  panel_.setSheet(sheet);
  EXPECT_EQ(flags(), QStringLiteral("⚠ the station is 1000 times too large\n⚠ also this"));
  EXPECT_TRUE(panel_.text().startsWith(flags()));
}

TEST_F(InputSheetPanelTest, CopiesWhatIsChosen) {
  panel_.setSheet(someSheet());
  auto* table = panel_.findChild<QTableWidget*>();
  panel_.activateWindow();
  ASSERT_TRUE(QTest::qWaitForWindowActive(&panel_));
  table->selectRow(1);
  table->setFocus();
  QTest::keyClick(table, Qt::Key_C, Qt::ControlModifier);
  EXPECT_EQ(QApplication::clipboard()->text(), QStringLiteral("seed distance\t0.412 m\n"));
}

}  // namespace
}  // namespace boresight::ui
