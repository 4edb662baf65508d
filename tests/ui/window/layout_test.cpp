// SPDX-License-Identifier: Apache-2.0
// Where the panels lie, what is remembered of it, and what pictures leave behind.
#include <gtest/gtest.h>

#include <algorithm>
#include <string>
#include <vector>

#include <QtTest/QTest>
#include <QtWidgets>

#include "sessions/session/session_document.h"
#include "sessions/session/session_maker.h"
#include "tests/support/example_case.h"
#include "tests/ui/window_test.h"
#include "ui/views/image_panel.h"
#include "ui/window/application.h"
#include "ui/window/main_window.h"
#include "ui/window/session_files.h"
#include "ui/workspaces/workspaces.h"

namespace boresight::ui {
namespace {

class LayoutTest : public ::testing::Test {
 protected:
  test::TemporaryFolder folder_;
  test::OwnSettings settings_{folder_.path()};
};

TEST_F(LayoutTest, EachWorkspaceIsRememberedByTheNextWindow) {
  {
    MainWindow window;
    window.rememberLayout();
    window.resize(1700, 900);
    window.show();
    QApplication::processEvents();
    window.workspaces().show(Workspace::kRun);
    window.dock(QStringLiteral("scene"))->hide();
    window.dock(QStringLiteral("pose"))->show();
    window.workspaces().show(Workspace::kAnnotate);
    EXPECT_FALSE(window.dock(QStringLiteral("scene"))->isHidden()) << "that was of another one";
    window.close();
  }
  MainWindow next;
  next.rememberLayout();
  next.show();
  next.workspaces().show(Workspace::kRun);
  EXPECT_TRUE(next.dock(QStringLiteral("scene"))->isHidden());
  EXPECT_FALSE(next.dock(QStringLiteral("pose"))->isHidden()) << "an added panel";
  EXPECT_FALSE(next.dock(QStringLiteral("result"))->isHidden());
}

TEST_F(LayoutTest, PicturesAndTests_NeitherReadNorStoreALayout) {
  {
    MainWindow window;
    window.show();
    window.dock(QStringLiteral("scene"))->hide();
    window.close();
  }
  EXPECT_TRUE(QSettings().allKeys().isEmpty());
}

TEST_F(LayoutTest, ArrangePanels_RestoresTheWorkspace) {
  MainWindow window;
  window.resize(1700, 1000);
  window.show();
  QApplication::processEvents();
  window.workspaces().show(Workspace::kRun);
  window.dock(QStringLiteral("scene"))->hide();
  window.dock(QStringLiteral("result"))->setFloating(true);
  window.findChild<QAction*>(QStringLiteral("arrange"))->trigger();
  QApplication::processEvents();
  EXPECT_FALSE(window.dock(QStringLiteral("scene"))->isHidden());
  EXPECT_FALSE(window.dock(QStringLiteral("result"))->isFloating());
  EXPECT_GT(window.image().width(), 800) << "the image has the most room";
}

/// As many panels as the first window had opened at once did not fit.
TEST_F(LayoutTest, FirstStart_FitsTheScreen) {
  MainWindow window;
  window.rememberLayout();
  window.show();
  QApplication::processEvents();
  const QSize screen = QGuiApplication::primaryScreen()->availableSize();
  EXPECT_LE(window.width(), screen.width());
  EXPECT_LE(window.height(), screen.height());
}

TEST_F(LayoutTest, RecentFilesAreTheNewestFirstWithoutThoseThatAreGone) {
  for (const char* name : {"a", "b", "a", "c"}) noteRecentFile(folder_.write(name, "{}"));
  std::filesystem::remove(folder_.path() / "b");
  const QStringList files = recentFiles();
  ASSERT_EQ(files.size(), 2);
  EXPECT_TRUE(files[0].endsWith(QLatin1String("/c")));
  EXPECT_TRUE(files[1].endsWith(QLatin1String("/a")));
  for (int i = 0; i < 20; ++i) noteRecentFile(folder_.write(std::to_string(i), "{}"));
  EXPECT_EQ(recentFiles().size(), 10);
}

/// The session's folder is read-only, and what waits in its journal is shown too.
TEST_F(LayoutTest, Picture_ShowsJournalledEditsAndWritesNothingElse) {
  const std::filesystem::path file = folder_.path() / "one.boresight.json";
  const sessions::Session session = test::withoutSearch(test::exampleSession());
  {
    auto document = sessions::SessionDocument::create(file, session);
    document.apply(sessions::withoutCase(session, session.cases[0]->id), "Remove a case");
  }
  const auto listed = [this] {
    std::vector<std::string> names;
    for (const auto& entry : std::filesystem::recursive_directory_iterator(folder_.path()))
      names.push_back(entry.path().filename().string());
    std::sort(names.begin(), names.end());
    return names;
  };
  const auto before = listed();
  const test::TemporaryFolder copies;
  MainWindow window;
  window.setQuiet(true);
  EXPECT_EQ(openForPictures(window, file, copies.path()).toStdString(), "");
  EXPECT_EQ(window.document().session().cases.size(), session.cases.size() - 1);
  ScreenshotOrder order;
  order.out = copies.path() / "picture.png";
  order.size = QSize(1280, 800);
  EXPECT_EQ(takeScreenshot(window, order).toStdString(), "");
  EXPECT_TRUE(std::filesystem::exists(order.out));
  EXPECT_EQ(window.document().session().runs.size(), 1u) << "a case without a run is run";
  EXPECT_EQ(listed(), before);
}

TEST_F(LayoutTest, APictureOfAFileThatIsNoSessionSaysWhy) {
  MainWindow window;
  window.setQuiet(true);
  const auto file = folder_.write("no.json", "{");
  EXPECT_TRUE(test::has(openForPictures(window, file, folder_.path()), "no.json"));
}

}  // namespace
}  // namespace boresight::ui
