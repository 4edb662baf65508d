// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <memory>

#include <QMainWindow>

class QLineEdit;
class QTextBrowser;
class QUrl;

#include "ui_manual_window.h"

namespace boresight::ui {

/// The manual's folder: share/boresight/manual next to an installed program or in the build tree of
/// one that was not installed. "" when there is none.
QString manualFolder();

/// Files of the pages in the order of index.md, the index itself first; empty when it cannot be
/// read.
QStringList manualPages(const QString& folder);
/// Text of a file in UTF-8; "" when it cannot be read.
QString manualText(const QString& file);

/// The manual in a separate window: its pages, and a search field that continues on the next page
/// with a match. Without a manual it shows a sentence.
class ManualWindow : public QMainWindow {
  Q_OBJECT

 public:
  /// `folder`: of the manual; "" when there is none.
  explicit ManualWindow(const QString& folder, QWidget* parent = nullptr);

  /// Shows a page, "annotate.md" or "window.md#queue", and comes to the front.
  void showPage(const QString& page);
  QTextBrowser& browser() { return *browser_; }

 private:
  void goTo(const QString& page);
  void follow(const QUrl& address);
  void dress(const QUrl& address);
  void find(bool backward);

  QString folder_;
  QTextBrowser* browser_;
  QLineEdit* find_;
  Ui::ManualWindow ui_;
};

/// Opens the manual at the section of the panel that has the focus.
class ManualHelp : public QObject {
  Q_OBJECT

 public:
  explicit ManualHelp(QMainWindow& window);

  /// Shows the section of the panel with the focus, else the contents.
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
