// SPDX-License-Identifier: Apache-2.0
#include "ui/window/shortcut_sheet.h"

#include <gtest/gtest.h>

#include <QtWidgets>

#include "ui/window/main_window.h"

namespace boresight::ui {
namespace {

QStringList textsOf(const ShortcutSheet& sheet) {
  QStringList texts;
  for (const QLabel* label : sheet.findChildren<QLabel*>()) texts << label->text();
  return texts;
}

TEST(ShortcutSheet, ListsEveryKeyOfTheWindow) {
  QStandardPaths::setTestModeEnabled(true);
  MainWindow window;
  const ShortcutSheet sheet(window);
  const QString all = textsOf(sheet).join(QLatin1Char('\n'));
  int keys = 0;
  for (const QAction* action : window.findChildren<QAction*>()) {
    const bool of_menu = qobject_cast<QMenu*>(action->parent()) || action->parent() == &window;
    if (action->shortcut().isEmpty() || !of_menu) continue;
    ++keys;
    EXPECT_TRUE(all.contains(action->shortcut().toString(QKeySequence::NativeText).toHtmlEscaped()))
        << action->text().toStdString();
  }
  EXPECT_GT(keys, 20);
}

/// Two actions of one key: Qt would do neither.
TEST(ShortcutSheet, NoKeyOfTheWindowMeansTwoThings) {
  QStandardPaths::setTestModeEnabled(true);
  MainWindow window;
  QMap<QString, QString> owner;
  for (const QAction* action : window.findChildren<QAction*>()) {
    if (action->shortcut().isEmpty() || action->shortcutContext() != Qt::WindowShortcut) continue;
    const QString key = action->shortcut().toString();
    EXPECT_FALSE(owner.contains(key)) << key.toStdString() << ": " << action->text().toStdString()
                                      << " and " << owner[key].toStdString();
    owner[key] = action->text();
  }
}

TEST(ShortcutSheet, NamesTheKeysOfImageSceneAndNudging) {
  QStandardPaths::setTestModeEnabled(true);
  MainWindow window;
  const QString all = textsOf(ShortcutSheet(window)).join(QLatin1Char('\n'));
  for (const char* place : {"Image:", "Scene:", "Nudging:", "Configuration:"})
    EXPECT_TRUE(all.contains(QLatin1String(place))) << place;
}

}  // namespace
}  // namespace boresight::ui
