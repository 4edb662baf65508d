// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <filesystem>
#include <vector>

#include <QObject>
#include <QString>
#include <QStringList>

#include "sessions/session/session.h"
#include "ui/window/dropped_files.h"
#include "ui/window/window_parts.h"

class QWidget;

namespace boresight::ui {

/// Sessions that were opened or saved last, the newest first, as absolute paths. Kept in the
/// program's settings; files that are gone are left out.
QStringList recentFiles();
void noteRecentFile(const std::filesystem::path& file);

/// Sessions and what they are made of, from and to files: opening, making, saving, recovering. Asks
/// a person where it must, in front of the window.
class SessionFiles : public QObject {
  Q_OBJECT

 public:
  SessionFiles(QWidget& window, const WindowParts& parts);

  /// False, with a message, when it cannot be opened.
  bool open(const std::filesystem::path& file);
  /// Another session, a dataset, results, or what makes a case; parts of a case are kept until it
  /// is whole.
  void take(const std::vector<std::filesystem::path>& files);
  /// Whether the open session may be left; asks when it has changes.
  bool mayLeave();
  /// Offers the edits of a program that was killed, if there are any.
  void offerRecovery();
  /// Offers the newest session without a name that a program has left and that nobody has open.
  void offerUntitled();

 public Q_SLOTS:
  void askForSession();
  void askForFiles();
  bool save();
  bool saveAs();
  /// Says why nothing can be written where the session lies, and offers to save it elsewhere.
  void offerSavingElsewhere(const QString& reason);

 Q_SIGNALS:
  /// Something could not be done; one sentence.
  void failed(const QString& message);
  /// What happened, for the status bar.
  void noted(const QString& message);
  /// The session that has just been made is one to go through in the queue.
  void queueWanted();

 private:
  void makeFrom(const std::filesystem::path& file, bool results);
  void addCase(const QString& kept);
  void takeCase(sessions::SessionCase made);
  bool askForUnits();
  bool mayLoseRuns();

  QWidget& window_;
  WindowParts parts_;
  DroppedFiles collected_;  ///< of a case that is not complete yet
};

}  // namespace boresight::ui
