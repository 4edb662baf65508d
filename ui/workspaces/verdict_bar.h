// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <QFrame>
#include <QStringList>

#include "ui_verdict_bar.h"

#include "ui/workspaces/verdict.h"

class QMenu;

namespace boresight::ui {

/// Bar above every workspace: the status of the shown case in a sentence, and the next step. A
/// badge counts the warnings on the inputs; a click lists them over the workspace below it.
class VerdictBar : public QFrame {
  Q_OBJECT

 public:
  explicit VerdictBar(QWidget* parent = nullptr);

  void setVerdict(const Verdict& verdict);
  const Verdict& verdict() const { return verdict_; }
  /// Sentences; empty hides the badge.
  void setWarnings(const QStringList& sentences);
  /// Head and sentence, for screen readers.
  QString text() const;
  /// The action's button; hidden without one.
  QPushButton& action() { return *ui_.verdictAction; }

 Q_SIGNALS:
  void stepRequested(boresight::ui::Step step);

 protected:
  void resizeEvent(QResizeEvent* event) override;
  bool eventFilter(QObject* watched, QEvent* event) override;

 private:
  void showVerdict();
  void showOthers();
  void showWarnings();
  void elide();

  Verdict verdict_;
  QStringList warnings_;
  Ui::VerdictBar ui_;
  QMenu* more_menu_;
};

}  // namespace boresight::ui
