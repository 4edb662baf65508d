// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <memory>
#include <vector>

#include <QMainWindow>

class QLineEdit;
class QTextBrowser;
class QUrl;

namespace boresight::ui {

/// A page as the manual's index lists it.
struct ManualPage {
  QString title;
  QString file;  ///< name in the manual's folder: "annotate.md"
};

/// The manual's folder: share/boresight/manual beside an installed program or in the build tree of
/// one that was not installed. "" when there is none.
QString manualFolder();

/// The pages in the order of index.md, the index itself first; empty when it cannot be read.
std::vector<ManualPage> manualPages(const QString& folder);

/// Text of a file in UTF-8; "" when it cannot be read.
QString manualText(const QString& file);

/// A page in Markdown that links the pages which hold all words of `query`, whatever their case:
/// first those whose title does, then those that hold them most often.
QString searchManual(const QString& folder, const QString& query);

/// The manual in a window of its own: its pages, and a field that finds words on the page or in all
/// pages. Without a manual one sentence says so.
class ManualWindow : public QMainWindow {
  Q_OBJECT

 public:
  /// `folder`: of the manual, "" where there is none.
  explicit ManualWindow(const QString& folder, QWidget* parent = nullptr);

  /// Shows a page, "annotate.md" or "window.md#queue", and comes to the front.
  void showPage(const QString& page);
  QTextBrowser& browser() { return *browser_; }

 private:
  void goTo(const QString& page);
  void follow(const QUrl& address);
  void dress(const QUrl& address);
  void find(bool backward);
  void searchAllPages();

  QString folder_;
  QTextBrowser* browser_;
  QLineEdit* find_;
};

/// Opens the manual at what an operator works at: the section of the panel that has the focus.
class ManualHelp : public QObject {
  Q_OBJECT

 public:
  explicit ManualHelp(QMainWindow& window);

  /// The section of the panel with the focus, else the contents.
  void showHere();
  /// nullptr until it was shown.
  ManualWindow* manual() { return manual_.get(); }
  /// "window.md#queue", or "index.md".
  QString pageHere() const;

 private:
  QMainWindow& window_;
  std::unique_ptr<ManualWindow> manual_;
};

}  // namespace boresight::ui
