// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <memory>

#include <QObject>

class QMainWindow;

namespace boresight::ui {

class ManualWindow;

/// Opens the manual at what somebody is at: the section of the panel that has the focus.
class ManualHelp : public QObject {
  Q_OBJECT

 public:
  explicit ManualHelp(QMainWindow& window);
  ~ManualHelp() override;

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
