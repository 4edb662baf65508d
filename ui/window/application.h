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

/// Before the QApplication is made: the platform (offscreen where no display is wanted; VTK here is
/// X11, so xcb also under Wayland), scaling, and the surface that VTK draws on. What the
/// environment says (QT_QPA_PLATFORM) holds.
void prepareApplication(bool without_display);

/// Name, organisation and style, which also say where settings are kept.
void nameApplication(QApplication& application);

/// Tests the installed program on the example that ships, without a display: one line per test,
/// then "N passed, N failed". Returns how many failed.
int runSelfTest(std::ostream& output);

/// What a picture of the program shows.
struct ScreenshotOrder {
  std::filesystem::path out;
  QString view;  ///< object name of a dock, "image", or "" for the whole window
  QSize size = QSize(1600, 1000);
  QString annotation;  ///< id of an annotation that the operator works on, in the middle of the
                       ///< image; "": none
  int iteration = -2;  ///< index to show; -1: the seed; -2: the last
  int hypothesis = 0;  ///< row under Hypotheses to show, from 1; 0: none
  std::optional<Workspace> workspace = {};  ///< nothing: the one that the session opens in
  double* share = nullptr;  ///< takes the part of the window that shows the image
};

/// Shows a session and what was not saved of it, without writing anything next to it: it goes on in
/// `folder`, which must outlive the window's document. Returns "" or why it could not.
QString openForPictures(MainWindow& window, const std::filesystem::path& session,
                        const std::filesystem::path& folder);

/// Waits until the window has nothing left to do: files, runs, checks, renders. False when it takes
/// too long.
bool waitUntilResting(MainWindow& window);

/// Waits until the session's chosen case is shown, runs it when it has no run yet, and writes a PNG
/// of the window or of one view; an empty window is shown as it is. Returns "" or why it could not.
QString takeScreenshot(MainWindow& window, const ScreenshotOrder& order);

}  // namespace boresight::ui
