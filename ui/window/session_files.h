// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <filesystem>
#include <optional>
#include <string>
#include <vector>

#include <QObject>
#include <QString>
#include <QStringList>

#include "sessions/session/session.h"
#include "sessions/session/session_maker.h"
#include "ui/window/window_parts.h"

class QWidget;

namespace boresight::ui {

/// What files that were dropped or opened together are.
struct DroppedFiles {
  std::optional<std::filesystem::path> session;
  std::optional<std::filesystem::path> dataset;
  std::optional<std::filesystem::path> results;  ///< of `whs evaluate`
  std::optional<std::filesystem::path> record;   ///< of an onboard run
  sessions::CaseFiles one;                       ///< as far as it goes
  /// Of an image with a label: why that has no camera, or "" where it has one.
  std::optional<std::string> label_camera_remark;
  std::vector<std::string> problems;  ///< one sentence each: files that are nothing known, twice
                                      ///< the same kind

  /// What of a case is still missing, for the operator: "a camera and a seed", or "".
  std::string missing() const;
  bool isCase() const;         ///< an image, a camera, a mesh and a seed
  bool hasCamera() const;      ///< a file of its own, or the label of the image
  bool isRecordAlone() const;  ///< an onboard record, and nothing of a case
  /// Whether these have nothing to do with files of an earlier drop: a whole case, or another image
  /// that comes with files of its own.
  bool beginsAnew(const DroppedFiles& earlier) const;
  /// Names of the files of an earlier drop that these leave in place: "a.png, b.json", or "".
  std::string keptNames(const DroppedFiles& earlier) const;
};

/// Tells files by their content (JSON by its `format`) and by their extension (".whsr" is a
/// record, ".sqlite" holds results). Files of an earlier drop are completed by `earlier`. Two poses
/// are the seed and, if its name says so, the truth.
DroppedFiles classify(const std::vector<std::filesystem::path>& files,
                      const DroppedFiles& earlier = {});

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
  /// Offers the newest session without a name that a program has left and no other has open.
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
  void takeCase(sessions::SessionCase session_case);
  bool askForUnits();
  bool mayLoseRuns();

  QWidget& window_;
  WindowParts parts_;
  DroppedFiles collected_;  ///< of a case that is not complete yet
};

}  // namespace boresight::ui
