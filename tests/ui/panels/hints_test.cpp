// SPDX-License-Identifier: Apache-2.0
#include <gtest/gtest.h>
#include <QtTest>
#include <QtWidgets>

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

TEST(Banner, HidesWithoutWarnings) {
  QWidget window;
  Banner banner(&window);
  window.show();
  banner.showWarnings({QStringLiteral("the mesh is 1000 times too big")});
  EXPECT_TRUE(banner.isVisible());
  banner.showWarnings({});
  EXPECT_FALSE(banner.isVisible());
}

TEST(Banner, CountsTheWarningsThatItDoesNotShow) {
  Banner banner;
  banner.setAction(QStringLiteral("Inputs"), QStringLiteral("Show them"));
  banner.showWarnings(
      {QStringLiteral("a"), QStringLiteral("b"), QStringLiteral("c"), QStringLiteral("d")});
  EXPECT_EQ(banner.text(), QStringLiteral("a\nb\nand 2 more"));
  EXPECT_EQ(banner.findChild<QLabel*>()->text(), QString::fromUtf8("⚠"))
      << "a sign in addition to the colour";
  QSignalSpy asked(&banner, &Banner::actionRequested);
  QTest::mouseClick(banner.findChild<QToolButton*>(), Qt::LeftButton);
  EXPECT_EQ(asked.count(), 1);
}

}  // namespace
}  // namespace boresight::ui
