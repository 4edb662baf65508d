// SPDX-License-Identifier: Apache-2.0
#include <gtest/gtest.h>
#include <QtTest>
#include <QtWidgets>

#include "ui/panels/warning_bar.h"
#include "ui/panels/widgets.h"

namespace boresight::ui {
namespace {

TEST(EmptyHint, ShowsWhileTheListIsEmpty) {
  QStringListModel model;
  QListView view;
  view.setModel(&model);
  auto* hint = new EmptyHint(view);
  view.show();
  EXPECT_TRUE(hint->isVisible());
  model.setStringList({QStringLiteral("one")});
  EXPECT_FALSE(hint->isVisible());
  model.removeRows(0, 1);
  EXPECT_TRUE(hint->isVisible());
}

TEST(EmptyHint, KeepsToTheViewport) {
  QStringListModel model;
  QListView view;
  view.setModel(&model);
  auto* hint = new EmptyHint(view);
  view.resize(200, 100);
  view.show();
  view.resize(420, 310);
  EXPECT_EQ(hint->size(), view.viewport()->size());
}

TEST(EmptyHint, MayLeaveARowThatIsAlwaysThere) {
  QStringListModel model({QStringLiteral("seed")});
  QListView view;
  view.setModel(&model);
  auto* hint = new EmptyHint(view, 1);
  view.show();
  EXPECT_TRUE(hint->isVisible());
  model.setStringList({QStringLiteral("seed"), QStringLiteral("1.1")});
  EXPECT_FALSE(hint->isVisible());
}

TEST(WarningBar, HidesWhenThereIsNothingToSay) {
  QWidget window;
  WarningBar bar(QStringLiteral("Inputs"), QStringLiteral("Show them"), &window);
  window.show();
  EXPECT_FALSE(bar.isVisible());
  bar.setSentences({QStringLiteral("the mesh is 1000 times too big")});
  EXPECT_TRUE(bar.isVisible());
  EXPECT_TRUE(bar.text().startsWith(QStringLiteral("⚠"))) << "a sign besides the colour";
  bar.setSentences({});
  EXPECT_FALSE(bar.isVisible());
}

TEST(WarningBar, CountsWhatItDoesNotShow) {
  WarningBar bar(QStringLiteral("Inputs"), QStringLiteral("Show them"));
  bar.setSentences(
      {QStringLiteral("a"), QStringLiteral("b"), QStringLiteral("c"), QStringLiteral("d")});
  EXPECT_EQ(bar.text(), QStringLiteral("⚠ a\n⚠ b\nand 2 more"));
  QSignalSpy asked(&bar, &WarningBar::actionRequested);
  QTest::mouseClick(bar.findChild<QToolButton*>(), Qt::LeftButton);
  EXPECT_EQ(asked.count(), 1);
}

}  // namespace
}  // namespace boresight::ui
