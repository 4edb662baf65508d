// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <filesystem>
#include <memory>
#include <vector>

#include <QMainWindow>

#include "ui/window/window_parts.h"

class QDockWidget;

namespace boresight::ui {

class ImagePanel;
class InputFindings;
class SessionFiles;
class WindowDocks;
class WindowFrame;
class WindowMenus;
class VerdictController;
class Workspaces;

/// The window: workspaces round the image, menus, keys. It only connects the other parts.
class MainWindow : public QMainWindow {
  Q_OBJECT

 public:
  explicit MainWindow(QWidget* parent = nullptr);
  ~MainWindow() override;

  /// Opens a session; false, with a message, when it cannot.
  bool openSession(const std::filesystem::path& file);
  /// Makes a session from files: another session, a dataset, or the files of a case.
  void takeFiles(const std::vector<std::filesystem::path>& files);

  /// Messages are stored instead of shown, for pictures and tests.
  void setQuiet(bool quiet) { quiet_ = quiet; }
  const QString& lastMessage() const { return last_message_; }

  /// Restores position, size and panels of the window from its last session, and stores them when
  /// it closes. Without this call the window is as at the first start.
  void rememberLayout();

  WindowParts& parts() { return parts_; }
  Document& document() { return parts_.document; }
  ViewState& state() { return parts_.state; }
  RunController& run() { return parts_.run; }
  TaskRunner& tasks() { return parts_.tasks; }
  CaseController& cases() { return parts_.cases; }
  RunStore& store() { return parts_.store; }
  AnnotationController& annotation() { return parts_.annotation; }
  OnboardController& onboard() { return parts_.onboard; }
  ImagePanel& image();
  ExportRunner& exports() { return parts_.exports; }
  InputFindings& findings() { return *findings_; }
  Workspaces& workspaces() { return *workspaces_; }
  WindowFrame& frame() { return *frame_; }
  /// The dock of this object name, or nullptr.
  QDockWidget* dock(const QString& name) const;

 protected:
  void showEvent(QShowEvent* event) override;
  void resizeEvent(QResizeEvent* event) override;
  void closeEvent(QCloseEvent* event) override;
  void dragEnterEvent(QDragEnterEvent* event) override;
  void dropEvent(QDropEvent* event) override;

 private:
  void resizeToScreen();
  void showFittingWorkspace();
  void connectAll();
  void connectDecisions(VerdictController& verdicts);
  void showDocument();
  void showState();
  void showHint();
  void showMessage(const QString& message);
  QStringList jobsUnderWay() const;
  bool mayEndJobs();

  WindowParts parts_;
  QMainWindow* body_ = nullptr;  ///< holds the docks
  std::unique_ptr<WindowDocks> docks_;
  Workspaces* workspaces_ = nullptr;
  SessionFiles* files_ = nullptr;
  WindowFrame* frame_ = nullptr;
  WindowMenus* menus_ = nullptr;
  InputFindings* findings_ = nullptr;
  bool quiet_ = false;
  bool remembers_layout_ = false;
  QString last_message_;
};

}  // namespace boresight::ui
