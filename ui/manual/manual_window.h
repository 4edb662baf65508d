// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <QMainWindow>

class QAction;
class QLabel;
class QLineEdit;
class QListWidget;
class QStackedWidget;
class QTreeWidget;
class QUrl;

namespace boresight::ui {

class ManualBrowser;

/// The manual in a window of its own: contents and search at the side, a page beside them, what is
/// looked for in the page below. Without a manual one sentence says so.
class ManualWindow : public QMainWindow {
  Q_OBJECT

 public:
  /// `folder`: of the manual, "" where there is none.
  explicit ManualWindow(const QString& folder, QWidget* parent = nullptr);

  /// Shows a page, "annotate.md" or "window.md#queue", and comes to the front.
  void showPage(const QString& page);
  ManualBrowser& browser() { return *browser_; }

 private:
  void buildSide();
  void buildToolBar();
  void buildFindBar();
  QAction* action(const QString& text, const QKeySequence& keys, const QString& tip);
  void fillContents();
  void goTo(const QString& page);
  void search(const QString& words);
  void find(bool backward);
  void showPlace(const QUrl& address);

  QString folder_;
  ManualBrowser* browser_;
  QTreeWidget* contents_;
  QLineEdit* search_;
  QListWidget* hits_;
  QStackedWidget* side_;
  QLineEdit* find_;
  QLabel* found_;
};

}  // namespace boresight::ui
