// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <filesystem>
#include <vector>

#include <QMainWindow>

#include "ui/run/run_controller.h"
#include "ui/run/task_runner.h"
#include "ui/state/document.h"
#include "ui/state/view_state.h"
#include "ui/window/case_controller.h"
#include "ui/window/dropped_files.h"

class QAction;
class QDockWidget;
class QLabel;

namespace boresight::ui {

class CasesPanel;
class ConfigurationPanel;
class ImagePanel;
class InputSheetPanel;
class PosePanel;
class PoseRenderer;

/// The window: docks round the image, menus, keys. It only connects what lies beside it.
class MainWindow : public QMainWindow {
  Q_OBJECT

 public:
  explicit MainWindow(QWidget* parent = nullptr);
  ~MainWindow() override;

  /// Opens a session; false, with a message, when it cannot.
  bool openSession(const std::filesystem::path& file);
  /// A session of its own from files: another session, a dataset, or what makes a case.
  void takeFiles(const std::vector<std::filesystem::path>& files);

  /// Messages are kept instead of shown, for pictures and tests.
  void setQuiet(bool quiet) { quiet_ = quiet; }
  const QString& lastMessage() const { return last_message_; }

  Document& document() { return document_; }
  ViewState& state() { return state_; }
  RunController& run() { return run_; }
  TaskRunner& tasks() { return tasks_; }
  CaseController& cases() { return cases_; }
  ImagePanel& image() { return *image_; }
  /// The dock of this object name, or nullptr.
  QDockWidget* dock(const QString& name) const;

 protected:
  void closeEvent(QCloseEvent* event) override;
  void dragEnterEvent(QDragEnterEvent* event) override;
  void dropEvent(QDropEvent* event) override;

 private:
  void buildDocks();
  void connectCases();
  void connectConfiguration();
  void connectPoses();
  void showCases();
  void showConfiguration();
  void showInputs();
  void buildMenus();
  void buildFileMenu();
  void buildEditMenu();
  void buildRunMenu();
  void buildViewMenu();
  void buildHelpMenu();
  void buildStatusBar();
  QDockWidget* addDock(const QString& name, const QString& title, QWidget* widget,
                       Qt::DockWidgetArea area);
  QAction* action(const QString& text, const QKeySequence& keys, const QString& tip);

  void askForSession();
  void askForFiles();
  bool saveSession();
  bool saveSessionAs();
  bool mayClose();
  void showDocument();
  void offerRecovery();
  void showRunState();
  void updateActions();
  void showMessage(const QString& message);
  void noteRecent(const std::filesystem::path& file);
  void showRecent();
  bool askForUnits(sessions::CaseFiles& files);

  Document document_;
  ViewState state_;
  TaskRunner tasks_;
  RunController run_;
  CaseController cases_;
  ImagePanel* image_ = nullptr;
  CasesPanel* cases_panel_ = nullptr;
  ConfigurationPanel* configuration_ = nullptr;
  InputSheetPanel* inputs_ = nullptr;
  PosePanel* poses_ = nullptr;
  PoseRenderer* nudged_ = nullptr;
  bool quiet_ = false;
  QString last_message_;
  DroppedFiles collected_;  ///< of a case that is not complete yet

  QAction* save_ = nullptr;
  QAction* save_as_ = nullptr;
  QAction* undo_ = nullptr;
  QAction* redo_ = nullptr;
  QAction* run_to_end_ = nullptr;
  QAction* step_stage_ = nullptr;
  QAction* step_iteration_ = nullptr;
  QAction* stop_ = nullptr;
  QAction* reset_ = nullptr;
  QAction* run_all_ = nullptr;
  QMenu* recent_menu_ = nullptr;
  QMenu* view_menu_ = nullptr;
  QLabel* place_label_ = nullptr;
  QLabel* run_label_ = nullptr;
};

}  // namespace boresight::ui
