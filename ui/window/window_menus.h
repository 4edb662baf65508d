// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <QList>
#include <QObject>

#include "sessions/session/session.h"
#include "ui/annotation/annotation_controller.h"
#include "ui/window/window_parts.h"

class QAction;
class QKeySequence;
class QMainWindow;
class QMenu;

namespace boresight::ui {

class SessionFiles;
class WindowDocks;

/// Menus, tool bar and keys: what a person can ask of the window, and when. Every action is in a
/// menu, so that the sheet of keys can list it.
class WindowMenus : public QObject {
  Q_OBJECT

 public:
  WindowMenus(QMainWindow& window, const WindowParts& parts, const WindowDocks& docks,
              SessionFiles& files);

  /// Enables what can be done now.
  void update();

 private:
  void buildFileMenu();
  void buildEditMenu();
  void buildMaskMenu(QMenu& menu);
  void buildAnnotateMenu();
  void addMode(QMenu& menu, const QString& text, const QKeySequence& keys, const QString& tip,
               PlaceMode mode);
  void buildRunMenu();
  void buildOnboardMenu(QMenu& menu);
  void buildGoMenu();
  void buildViewMenu();
  void buildLayersMenu(QMenu& menu);
  void buildHelpMenu();
  /// Of an edit of another case than the shown one: that case is shown, and said to be.
  void undo();
  void redo();
  void showChange(const sessions::Session& before, const QString& told);
  void updateTogether(bool idle);
  void showRecent();
  void showAbout();

  QMainWindow& window_;
  WindowParts parts_;
  const WindowDocks& docks_;
  SessionFiles& files_;
  QAction* save_ = nullptr;
  QAction* save_as_ = nullptr;
  QAction* undo_ = nullptr;
  QAction* redo_ = nullptr;
  QAction* run_to_end_ = nullptr;
  QAction* step_stage_ = nullptr;
  QAction* step_iteration_ = nullptr;
  QAction* stop_ = nullptr;
  QAction* reset_ = nullptr;
  QAction* rerun_ = nullptr;
  QAction* run_together_ = nullptr;
  QAction* run_all_ = nullptr;
  QAction* load_record_ = nullptr;
  QAction* show_other_run_ = nullptr;
  QAction* rerun_record_ = nullptr;
  QAction* first_difference_ = nullptr;
  QMenu* recent_menu_ = nullptr;
  QString shown_change_;  ///< what the status bar says of the last undo or redo
  QList<QAction*> mask_actions_;
  QList<QAction*> annotation_actions_;
};

}  // namespace boresight::ui
