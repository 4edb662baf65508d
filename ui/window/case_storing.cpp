// SPDX-License-Identifier: Apache-2.0
// Runs that have ended are written beside the session and noted in it.
#include <utility>

#include <QCoreApplication>
#include <QStringList>

#include "sessions/io/errors.h"
#include "sessions/session/views_run.h"
#include "ui/run/task_runner.h"
#include "ui/state/document.h"
#include "ui/window/case_controller.h"

namespace boresight::ui {
namespace {

constexpr int kPatience_ms = 100;  ///< between looks whether a store has failed

sessions::Session withRuns(sessions::Session session,
                           const std::vector<sessions::RunRecord>& records) {
  for (const sessions::RunRecord& one : records) session = sessions::withRun(session, one);
  return session;
}

}  // namespace

/// Written into the session's folder: one, or one of every view.
std::vector<sessions::RunRecord> CaseController::recordsOf(const EndedRun& ended,
                                                           const std::filesystem::path& file) {
  if (ended.views.empty())
    return {
        sessions::storeRun(ended.session, ended.case_id, *ended.snapshot, file, ended.continued)};
  std::vector<sessions::LocalizationTrace> views;
  for (const ViewState::SnapshotPtr& one : ended.views) views.push_back(*one);
  return sessions::storeViews(ended.session, views, file);
}

void CaseController::store(const EndedRun& ended) {
  struct Stored {
    std::vector<sessions::RunRecord> records;
    QString problem;
  };
  ++storing_;
  // Of a key of its own: no run's storing replaces another's.
  tasks_.start(
      QStringLiteral("store run %1").arg(QString::fromStdString(ended.snapshot->digest)),
      [ended, file = document_.file()](const std::stop_token&) {
        try {
          return Stored{recordsOf(ended, file), {}};
        } catch (const sessions::OutputError& error) {
          return Stored{{}, QString::fromUtf8(error.what())};
        }
      },
      [this, ended, file = document_.file()](const Stored& stored) {
        --storing_;
        // Before it is noted: a failure is told at once, and answered by saving elsewhere.
        unstored_file_ = file;
        unstored_.push_back(ended);
        if (stored.records.empty()) {
          Q_EMIT storeFailed(stored.problem);
          if (!unstored_.empty()) endBatch();  // nor is there room for the next
        } else if (document_.note(withRuns(document_.session(), stored.records),
                                  tr("Run %1").arg(QString::fromStdString(ended.case_id)))) {
          std::erase_if(unstored_,
                        [&](const EndedRun& one) { return one.snapshot == ended.snapshot; });
          Q_EMIT stalenessChanged();
        }
        // A run that was begun meanwhile goes on.
        if (run_.state() != RunState::kWorking && !run_when_loaded_) runNext();
      });
}

/// The session was saved: perhaps there is room now.
void CaseController::storeAgain() {
  for (const EndedRun& ended : std::exchange(unstored_, {})) store(ended);
}

QStringList CaseController::unstoredRuns() const {
  QStringList ids;
  for (const EndedRun& ended : unstored_) ids << QString::fromStdString(ended.case_id);
  return ids;
}

void CaseController::finishStoring() {
  // A store that fails leaves nobody busy.
  while (storing_ && tasks_.isBusy())
    QCoreApplication::processEvents(
        QEventLoop::ExcludeUserInputEvents | QEventLoop::WaitForMoreEvents, kPatience_ms);
}

}  // namespace boresight::ui
