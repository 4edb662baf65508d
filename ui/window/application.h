// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <filesystem>
#include <iosfwd>
#include <optional>

#include <QSize>
#include <QString>

#include "ui/workspaces/workspace.h"

class QApplication;

namespace boresight::ui {

class MainWindow;

/// Call before the QApplication is created. Sets the platform (offscreen without a display; VTK
/// here needs X11, so xcb also under Wayland), scaling, and VTK's surface format. The environment
/// (QT_QPA_PLATFORM) has precedence.
void prepareApplication(bool without_display);

/// Sets name, organisation and style, and that numbers have a point in every locale; name and
/// organisation determine where settings are stored.
void nameApplication(QApplication& application);

/// Tests the installed program on the included example, without a display: one line per test, then
/// "N passed, N failed". Returns the number of failed tests.
int runSelfTest(std::ostream& output);

/// Content of a picture of the program.
struct ScreenshotOrder {
  std::filesystem::path out;
  QString view;  ///< object name of a dock, "image", or "" for the whole window
  QSize size = QSize(1600, 1000);
  QString annotation;  ///< id of an annotation that the operator works on, in the middle of the
                       ///< image; "": none
  int iteration = -2;  ///< index to show; -1: the seed; -2: the last
  int hypothesis = 0;  ///< row under Hypotheses to show, from 1; 0: none
  std::optional<Workspace> workspace = {};  ///< empty: the one in which the session opens
  double* share = nullptr;  ///< receives the share of the window that shows the image
};

/// After the window was closed: ends the program's tasks. What is being read or written is waited
/// for, which a box reports when it takes long. False: the operator does not wait; threads still
/// run, so that the program may only be left by std::_Exit.
bool endTasks();

/// Share of the window's area, 0 .. 1, that shows the image.
double imageShare(MainWindow& window);

/// Shows a session with its unsaved edits without writing next to it: it is copied to `folder`,
/// which must outlive the window's document. Returns "" or the reason of a failure.
QString openForPictures(MainWindow& window, const std::filesystem::path& session,
                        const std::filesystem::path& folder);

/// Waits until all files, runs, checks and renders of the window are done. False on a timeout.
bool waitUntilResting(MainWindow& window);

/// Waits until the session's chosen case is shown, runs it when it has no run yet, and writes a PNG
/// of the window or of one view; an empty window is shown unchanged. Returns "" or the reason of a
/// failure.
QString takeScreenshot(MainWindow& window, const ScreenshotOrder& order);

}  // namespace boresight::ui
