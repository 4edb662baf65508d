// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <QObject>

#include "ui/window/window_parts.h"

class QMainWindow;
class QStackedWidget;
class QWidget;

namespace boresight::ui {

class CaseStrip;
class DrawerBar;
class JobStrip;
class RunBar;
class SessionFiles;
class StartPage;
class TopBar;
class VerdictBar;
class WindowDocks;
class Workspaces;

/// The widgets round the panels in every workspace: the strip of cases, the verdict bar, the canvas
/// with the bar of the run, the job strip; takeMenus() adds the top bar.
class WindowFrame : public QObject {
  Q_OBJECT

 public:
  WindowFrame(QMainWindow& window, QMainWindow& body, WindowParts& parts, const WindowDocks& docks,
              Workspaces& workspaces, SessionFiles& files);

  VerdictBar& verdict() { return *verdict_; }
  JobStrip& jobs() { return *jobs_; }
  RunBar& runBar() { return *run_bar_; }
  CaseStrip& cases() { return *cases_; }
  StartPage& start() { return *start_; }
  /// Creates the top bar with the menus.
  void takeMenus();
  /// Arranges the parts by the size of the window, the workspace, and the source of the shown run.
  void arrange();

 private:
  void build();
  void connectAll();
  void switchTheme();
  void putOnboardBeside(bool wanted);
  void showTitle();

  QMainWindow& window_;
  QMainWindow& body_;
  WindowParts& parts_;
  const WindowDocks& docks_;
  Workspaces& workspaces_;
  SessionFiles& files_;
  TopBar* top_bar_ = nullptr;
  CaseStrip* cases_ = nullptr;
  VerdictBar* verdict_ = nullptr;
  QStackedWidget* stack_ = nullptr;
  StartPage* start_ = nullptr;
  QWidget* canvas_column_ = nullptr;
  RunBar* run_bar_ = nullptr;
  DrawerBar* drawers_ = nullptr;
  JobStrip* jobs_ = nullptr;
  bool onboard_beside_ = false;
};

}  // namespace boresight::ui
