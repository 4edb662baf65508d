// SPDX-License-Identifier: Apache-2.0
#include "ui/manual/manual_window.h"

#include <gtest/gtest.h>

#include <QtTest/QTest>
#include <QtWidgets>

#include "tests/support/temporary_folder.h"
#include "ui/window/main_window.h"
#include "ui/window/shortcut_sheet.h"
#include "ui/workspaces/workspaces.h"

namespace boresight::ui {
namespace {

void trigger(const QObject& parent, const char* text) {
  for (QAction* action : parent.findChildren<QAction*>())
    if (action->text().remove(QLatin1Char('&')) == QLatin1String(text)) return action->trigger();
  ADD_FAILURE() << "there is no action " << text;
}

/// A small manual of its own.
class ManualWindowTest : public ::testing::Test {
 protected:
  ManualWindowTest() {
    folder_.write("index.md",
                  "# All\n\n## First part\n\n- [One thing](one.md): it\n\n## Second\n\n"
                  "- [Another](two.md)\n");
    folder_.write("one.md",
                  "# One\n\nSee [the other](two.md#far-below).\n\n![p](pictures/wide.png)\n\n"
                  "| a | b |\n|---|---|\n| 1 | zebra |\n");
    std::string far = "# Two\n\nzebra zebra unicorn\n\n";
    for (int i = 0; i < 200; ++i) far += "line\n\n";
    folder_.write("two.md", far + "## Far below?\n\nend\n" + far);
    std::filesystem::create_directories(folder_ / "pictures");
    QImage(2000, 500, QImage::Format_RGB32)
        .save(QString::fromStdString((folder_ / "pictures/wide.png").string()));
  }

  QString shown() { return browser_.source().fileName(); }
  QString place() { return shown() + QString::number(browser_.textCursor().selectionStart()); }
  void find(const char* words) {
    find_.setText(QLatin1String(words));
    QTest::keyClick(&find_, Qt::Key_Return);
  }

  test::TemporaryFolder folder_;
  ManualWindow window_{QString::fromStdString(folder_.path().string())};
  QTextBrowser& browser_ = window_.browser();
  QLineEdit& find_ = *window_.findChild<QLineEdit*>(QStringLiteral("manualFind"));
};

TEST_F(ManualWindowTest, GoesWhereLinksLeadAndBack) {
  window_.showPage(QStringLiteral("one.md"));
  Q_EMIT browser_.anchorClicked(
      browser_.source().resolved(QUrl(QStringLiteral("two.md#far-below"))));
  EXPECT_EQ(shown(), QStringLiteral("two.md"));
  QCoreApplication::processEvents();
  EXPECT_GT(browser_.verticalScrollBar()->value(), 0);
  EXPECT_EQ(browser_.textCursor().block().text(), QStringLiteral("Far below?"));
  trigger(window_, "Back");
  EXPECT_EQ(shown(), QStringLiteral("one.md"));
  trigger(window_, "Forward");
  EXPECT_EQ(shown(), QStringLiteral("two.md"));
  trigger(window_, "Contents");
  EXPECT_EQ(shown(), QStringLiteral("index.md"));
}

TEST_F(ManualWindowTest, FindsOnThePageThenOnTheNextOneAndStartsOver) {
  window_.showPage(QStringLiteral("two.md"));
  QStringList found;
  for (int i = 0; i < 6; ++i) {
    find("ZEBRA");
    EXPECT_EQ(browser_.textCursor().selectedText().toLower(), QStringLiteral("zebra"));
    found << place();
  }
  EXPECT_EQ(QSet<QString>(found.begin(), found.begin() + 5).size(), 5) << "four here, one before";
  EXPECT_TRUE(found[4].startsWith(QStringLiteral("one.md")));
  EXPECT_EQ(found[5], found[0]);
  trigger(window_, "Previous");
  EXPECT_EQ(place(), found[4]);
  find("giraffe");
  EXPECT_EQ(window_.statusBar()->currentMessage(), QStringLiteral("Not in the manual: giraffe"));
}

TEST_F(ManualWindowTest, PicturesAreAsWideAsTheWindowAtMost_TablesHaveLines) {
  window_.resize(900, 500);
  window_.showPage(QStringLiteral("one.md"));
  for (const int width : {900, 1300, 700}) {
    window_.resize(width, 500);
    QCoreApplication::processEvents();
    EXPECT_EQ(browser_.horizontalScrollBar()->maximum(), 0) << width;
    const QVariant picture = browser_.document()->resource(
        QTextDocument::ImageResource,
        browser_.source().resolved(QUrl(QStringLiteral("pictures/wide.png"))));
    const QImage image = picture.value<QImage>();
    const int shown_width = static_cast<int>(image.width() / image.devicePixelRatio());
    EXPECT_LE(shown_width, browser_.viewport()->width()) << width;
    EXPECT_GT(shown_width, browser_.viewport()->width() - 60) << width;
  }
  const auto tables = browser_.document()->findChildren<QTextTable*>();
  ASSERT_EQ(tables.size(), 1);
  EXPECT_GT(tables[0]->format().border(), 0.0);
  EXPECT_GE(tables[0]->format().cellPadding(), 3.0);
}

TEST(ManualWindow, WithoutPages_ReportsTheMissingManual) {
  ManualWindow window{QString()};
  window.showPage(QStringLiteral("index.md"));
  EXPECT_TRUE(window.browser().toPlainText().startsWith(QStringLiteral("The manual is missing")));
  auto* find = window.findChild<QLineEdit*>(QStringLiteral("manualFind"));
  find->setText(QStringLiteral("x"));
  QTest::keyClick(find, Qt::Key_Return);
}

TEST(Manual, Folder_IsFoundByTheProgram) {
  ASSERT_FALSE(manualFolder().isEmpty());
  const auto pages = manualPages(manualFolder());
  EXPECT_GT(pages.size(), 20);
  ManualWindow window(manualFolder());
  for (const QString& page : pages) {
    window.showPage(page);
    EXPECT_EQ(window.browser().document()->begin().blockFormat().headingLevel(), 1)
        << page.toStdString();
  }
}

TEST(Manual, HasASectionForEveryPanel_AndOpensAtThatWithTheFocus) {
  QStandardPaths::setTestModeEnabled(true);
  MainWindow window;
  const QString page = manualText(manualFolder() + QStringLiteral("/window.md"));
  const auto docks = window.findChildren<QDockWidget*>();
  EXPECT_GT(docks.size(), 10);
  for (const QDockWidget* dock : docks)
    EXPECT_TRUE(page.contains(QStringLiteral("\n## %1\n").arg(dock->windowTitle())))
        << dock->windowTitle().toStdString();

  window.show();
  auto* help = window.findChild<ManualHelp*>(QStringLiteral("manualHelp"));
  ASSERT_NE(help, nullptr);
  window.workspaces().reveal(QStringLiteral("configuration"));
  QCoreApplication::processEvents();
  auto* field = window.dock(QStringLiteral("configuration"))->findChild<QLineEdit*>();
  ASSERT_NE(field, nullptr);
  field->setFocus();
  EXPECT_EQ(help->pageHere(), QStringLiteral("window.md#configuration"));
  trigger(window, "Manual");
  ASSERT_NE(help->manual(), nullptr);
  EXPECT_TRUE(help->manual()->isVisible());
  EXPECT_EQ(help->manual()->browser().textCursor().block().text(), QStringLiteral("Configuration"));

  ShortcutSheet sheet(window);
  QSignalSpy requested(&sheet, &ShortcutSheet::manualRequested);
  for (QPushButton* button : sheet.findChildren<QPushButton*>())
    if (button->shortcut() == QKeySequence(Qt::Key_F1)) button->click();
  EXPECT_GE(requested.count(), 1);
}

}  // namespace
}  // namespace boresight::ui
