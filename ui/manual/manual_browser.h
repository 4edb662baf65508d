// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <QTextBrowser>

namespace boresight::ui {

/// Shows pages of Markdown: pictures as wide as the window at most, tables with lines, headings
/// that links lead to. Links to other programs' addresses are opened by the desktop.
class ManualBrowser : public QTextBrowser {
  Q_OBJECT

 public:
  explicit ManualBrowser(QWidget* parent = nullptr);

  /// A page by its address, with or without "#heading".
  void open(const QUrl& address);
  QVariant loadResource(int type, const QUrl& name) override;

 protected:
  void resizeEvent(QResizeEvent* event) override;

 private:
  void followLink(const QUrl& address);
  void dress();
  void dressTables();
  void dressCode();
  void fitPictures();
  void goToHeading(const QString& anchor);
  int roomForPictures() const;

  int fitted_width_ = 0;  ///< that pictures were fitted to
};

}  // namespace boresight::ui
