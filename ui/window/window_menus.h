// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <QList>
#include <QObject>

#include "ui_window_menus.h"

#include "sessions/session/session.h"
#include "ui/annotation/annotation_controller.h"
#include "ui/window/window_parts.h"
#include "ui/workspaces/workspace.h"

namespace boresight::ui {

class PoseExport;
class RunBar;
class SequenceDialog;
class SessionFiles;
class WindowDocks;
class Workspaces;

/// Menus and keys: the actions of the window, and when they are enabled. Every action is in a menu,
/// so that the sheet of keys can list it.
class WindowMenus : public QObject {
  Q_OBJECT

 public:
  WindowMenus(QMainWindow& window, WindowParts& parts, const WindowDocks& docks,
              Workspaces& workspaces, RunBar& run_bar, SessionFiles& files);

  /// Enables the actions that are possible now.
  void update();
  PoseExport& poses() { return *poses_; }

 protected:
  bool eventFilter(QObject* watched, QEvent* event) override;

 Q_SIGNALS:
  /// The verdict bar's action was requested by its key.
  void verdictStepRequested();
  void stopRequested();

 private:
  void connectFile();
  void connectEdit();
  void connectAnnotate();
  void connectMode(QAction* action, PlaceMode mode);
  void endTools(Workspace now);
  void connectImageAnnotation();
  void connectRun();
  void connectOnboard();
  void fillGoMenu();
  void fillWorkspaces();
  void showCase(int steps);
  void connectView();
  void connectQueue();
  void fillLayersMenu();
  void connectHelp();
  /// An edit of a case other than the shown one also shows that case, with a message.
  void undo();
  void redo();
  void stepHistory(bool (Document::*undo_or_redo)(), const QString& message);
  void updateTogether(bool idle);
  void showSequence();
  void showRecent();
  void showAbout();

  QMainWindow& window_;
  WindowParts& parts_;
  const WindowDocks& docks_;
  Workspaces& workspaces_;
  RunBar& run_bar_;
  SessionFiles& files_;
  Ui::WindowMenus ui_;
  PoseExport* poses_ = nullptr;
  SequenceDialog* sequence_ = nullptr;  ///< nullptr until it is requested
  QList<QAction*> annotation_edits_;
  Workspace workspace_ = Workspace::kStart;
  QString run_tip_;       ///< of "Run"
  QString together_tip_;  ///< of "Run with the other views"
  QString shown_change_;  ///< text in the status bar on the last undo or redo
};

}  // namespace boresight::ui
