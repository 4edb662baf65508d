// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <filesystem>
#include <optional>
#include <set>
#include <string>
#include <vector>

#include <QImage>
#include <QObject>
#include <QString>
#include <QStringList>

#include "sessions/session/session.h"
#include "ui/state/document.h"
#include "ui/window/dropped_files.h"
#include "ui/window/window_parts.h"
#include "ui/workspaces/verdict.h"

class QWidget;

namespace boresight::ui {

/// Sessions that were opened or saved last, the newest first, as absolute paths. Kept in the
/// program's settings; files that no longer exist are left out.
QStringList recentFiles();
void noteRecentFile(const std::filesystem::path& file);

/// A session's file name with the suffix of sessions: "sol" becomes "sol.boresight.json".
std::filesystem::path sessionFileName(std::filesystem::path file);

/// Units of a mesh, the likely ones first.
inline constexpr std::array<const char*, 5> kMeshUnits = {"m", "mm", "cm", "in", "ft"};
/// "m: 412 mm across"; the unit alone when the extent is not known.
QString meshUnitText(const char* unit, const std::optional<double>& extent);

/// Opens, creates, saves and recovers sessions, and collects the files of new cases. Asks the
/// operator in dialogs of the window.
class SessionFiles : public QObject {
  Q_OBJECT

 public:
  SessionFiles(QWidget& window, WindowParts& parts);

  /// False, with a message, when it cannot be opened.
  bool open(const std::filesystem::path& file, Former former = Former::kKeep);
  /// Takes another session, a dataset, results, or files of a case; the latter are collected until
  /// the case is complete.
  void take(const std::vector<std::filesystem::path>& files);
  /// Asks when the open session has changes, and saves them where that is the answer. Returns what
  /// the caller passes on to Document, which discards them once the next session is open; empty:
  /// the session may not be left.
  std::optional<Former> mayLeave();
  /// Leaves the open session for another, unless the operator keeps it open.
  void leaveFor(const std::filesystem::path& file);
  /// Offers the edits of a program that was killed, if there are any; `notices` are shown with
  /// them.
  void offerRecovery(const QString& notices = {});

  /// Files of a case that is not complete yet.
  const DroppedFiles& collected() const { return collected_; }
  FilesSituation situation() const;
  /// Largest extent of the collected mesh in the file's own numbers; empty until it is measured.
  const std::optional<double>& meshExtent() const { return mesh_extent_; }
  /// Description of the collected files, and why some cannot be used; empty until they are read.
  const sessions::JudgedFiles& judged() const { return judged_; }
  /// The collected image, small; null until it is read.
  const QImage& picture() const { return picture_; }
  /// Sets the unit; the case is created when nothing else is needed.
  void setMeshUnit(const std::string& unit);
  void askForFile(InputKind kind);
  /// Asks for the file that cannot be used, else for the first missing one; when all are present,
  /// the case is created.
  void askForNext();
  void removeFile(InputKind kind);
  /// Creates a case without a seed.
  void makeSeedless();
  void forgetCollected();
  /// Opens an example session under a new name and runs it.
  void openExample(const std::filesystem::path& file);
  /// Opens an untitled session left by a program that ended.
  void recoverUntitled(const std::filesystem::path& file);

 public Q_SLOTS:
  void askForSession();
  void askForFiles();
  /// Closes the session; asks when it has changes.
  void closeSession();
  bool save();
  bool saveAs();
  /// Reports why nothing can be written in the session's folder, and offers to save it elsewhere.
  void offerSavingElsewhere(const QString& reason);
  /// Reports that another program has changed the session's file, and offers to save under another
  /// name or to read the file again.
  void offerReadingAgain(const QString& reason);

 Q_SIGNALS:
  /// An action failed; one sentence.
  void failed(const QString& message);
  /// The result, for the status bar.
  void noted(const QString& message);
  /// Files of a case were added or removed.
  void collectedChanged();
  /// The collected files have become a case of the open session.
  void caseAdded();
  /// The new session should be reviewed in the queue.
  void queueWanted();

 private:
  /// The collected files as they are when a case of them is requested.
  struct Request {
    DroppedFiles files;
    int collection = 0;
    QString kept;  ///< names of files of earlier drops
  };

  /// Other files of a new case, or an amendment, which withdraws the request of those before.
  void collect(const DroppedFiles& files, bool amends = true);
  /// Whether a case of these files is still wanted.
  bool isRequested(const Request& request) const { return requested_.contains(request.collection); }
  void makeFrom(const std::filesystem::path& file, bool results);
  [[nodiscard]] bool addCase(Request request);
  void makeCase(const Request& request);
  [[nodiscard]] bool takeCase(sessions::SessionCase session_case);
  [[nodiscard]] bool askForId(sessions::SessionCase& session_case);
  bool isStillOpen(int opening);
  static ResultName newCaseName();
  void makeCollected();
  void judgeCollected();
  std::optional<InputKind> nextKind() const;
  void measureMesh();
  bool askForUnits(DroppedFiles& files);
  void finishStoring();
  bool mayLoseRuns();

  QWidget& window_;
  WindowParts& parts_;
  DroppedFiles collected_;   ///< of a case that is not complete yet
  int collection_ = 0;       ///< another number after each change of the collected files
  std::set<int> requested_;  ///< collections of which a case is being made
  sessions::JudgedFiles judged_;
  QImage picture_;
  QString kept_;  ///< names of the files from an earlier drop
  std::optional<double> mesh_extent_;
  bool recovers_ = false;  ///< without a question
  TaskKind judging_;
  TaskKind measuring_;
  TaskKind making_;
};

}  // namespace boresight::ui
