// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <filesystem>
#include <memory>
#include <string>
#include <vector>

#include <QObject>
#include <QString>
#include <QStringList>

#include "sessions/session/session.h"
#include "ui/run/document_tasks.h"
#include "ui/run/task_runner.h"
#include "ui/state/view_state.h"

namespace boresight::ui {

/// All that is needed to store a run that has ended.
struct EndedRun {
  sessions::Session session;  ///< from which it was run
  std::string case_id;
  ViewState::SnapshotPtr snapshot;
  std::string continued = {};  ///< digest of the run that it continues, or empty
  std::vector<ViewState::SnapshotPtr> views = {};  ///< of several that were solved as one
  int batch = 0;  ///< the batch that waits for it to be stored; 0: none
};

/// Stores ended runs in the session's folder and lists them in the session. A run that cannot be
/// stored is kept, and is tried again whenever the session is saved, there or elsewhere. Has a
/// thread of its own: finished work does not wait for files that are read.
class RunStore : public QObject {
  Q_OBJECT

 public:
  explicit RunStore(Document& document);

  /// From its end on it is known as a run that is not stored.
  void keep(EndedRun ended);
  /// Cases of ended runs that could not be stored.
  QStringList unstored() const;
  /// The same with those that are being stored.
  QStringList waiting() const;
  /// Why the last of them could not be stored, one sentence; or empty.
  QString unstoredReason() const;
  /// The thread in which runs are written.
  TaskRunner& runner() { return runner_; }
  /// Whether a run that has ended is being stored.
  bool isStoring() const;

 Q_SIGNALS:
  /// The session lists the run; `of_batch`: of a batch.
  void stored(const std::string& case_id, bool of_batch);
  /// A run cannot be stored in the session; one sentence.
  void storeFailed(const QString& message);
  /// It can still not be stored after the operator was told so.
  void blocked();
  /// The batch that waited for a run need not wait any more.
  void settled(int batch);
  /// A run is lost; one sentence.
  void failed(const QString& message);

 private:
  struct Waiting {
    EndedRun run;
    int batch = 0;  ///< that waits for it
    bool storing = true;
    std::filesystem::path file = {};  ///< the session's, in whose folder it is written
    QString problem = {};             ///< why it could not be stored
  };
  using WaitingPtr = std::shared_ptr<Waiting>;

  void store(const WaitingPtr& waiting);
  void take(const WaitingPtr& waiting, const std::vector<sessions::RunRecord>& records);
  void takeFailure(const WaitingPtr& waiting, const QString& problem);
  bool isElsewhereNow(const WaitingPtr& waiting);
  void storeAgain();
  bool noteRuns(const std::vector<sessions::RunRecord>& records);
  void settle(const WaitingPtr& waiting);

  Document& document_;
  std::vector<WaitingPtr> waiting_;      ///< being stored, or with a problem
  std::filesystem::path unstored_file_;  ///< where one could not be stored
  TaskRunner runner_;
  DocumentTasks of_document_;
};

}  // namespace boresight::ui
