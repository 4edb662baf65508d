// SPDX-License-Identifier: Apache-2.0
#include "ui/window/run_store.h"

#include <algorithm>
#include <utility>

#include "sessions/session/case_run.h"
#include "sessions/session/views_run.h"
#include "ui/models/text.h"
#include "ui/state/document.h"

namespace boresight::ui {
namespace {

/// Written into the session's folder: one, or one of every view.
std::vector<sessions::RunRecord> recordsOf(const EndedRun& ended,
                                           const std::filesystem::path& file) {
  if (ended.views.empty())
    return {
        sessions::storeRun(ended.session, ended.case_id, *ended.snapshot, file, ended.continued)};
  std::vector<sessions::LocalizationTrace> views;
  for (const ViewState::SnapshotPtr& snapshot : ended.views) views.push_back(*snapshot);
  return sessions::storeViews(ended.session, views, file);
}

}  // namespace

RunStore::RunStore(Document& document) : document_(document), of_document_(document, runner_) {
  connect(&document_, &Document::left, this, [this] { waiting_.clear(); });
  connect(&document_, &Document::changed, this, &RunStore::storeAgain);
  connect(&of_document_, &DocumentTasks::failed, this, &RunStore::failed);
}

void RunStore::keep(EndedRun ended) {
  const int batch = ended.batch;
  waiting_.push_back(std::make_shared<Waiting>(Waiting{std::move(ended), batch}));
  store(waiting_.back());
}

void RunStore::store(const WaitingPtr& waiting) {
  waiting->storing = true;
  waiting->problem.clear();
  waiting->file = document_.file();
  const QString id = fromText(waiting->run.case_id);
  of_document_.ofDocument(
      {tr("The run of %1").arg(id), tr("run %1 again").arg(id)},
      [run = waiting->run, file = document_.file()](const std::stop_token&) {
        return recordsOf(run, file);
      },
      [this, waiting](const std::vector<sessions::RunRecord>& records) { take(waiting, records); },
      [this, waiting](const QString& problem) { takeFailure(waiting, problem); });
}

void RunStore::take(const WaitingPtr& waiting, const std::vector<sessions::RunRecord>& records) {
  if (isElsewhereNow(waiting)) return;
  // Before it is recorded: a failure is reported at once, and the answer is to save elsewhere.
  waiting->storing = false;
  waiting->problem = tr("The session could not be written.");
  unstored_file_ = document_.file();
  if (noteRuns(records)) {
    std::erase(waiting_, waiting);
    Q_EMIT stored(waiting->run.case_id, waiting->run.batch != 0);
  }
  settle(waiting);
}

void RunStore::takeFailure(const WaitingPtr& waiting, const QString& problem) {
  if (isElsewhereNow(waiting)) return;
  waiting->storing = false;
  waiting->problem = problem;
  unstored_file_ = document_.file();
  Q_EMIT storeFailed(problem);
  if (!unstored().isEmpty()) Q_EMIT blocked();  // nor can the next be stored
  settle(waiting);
}

/// Whether the run has another place by now: none, where its case was removed; the folder of the
/// session's new name, in which it is stored again.
bool RunStore::isElsewhereNow(const WaitingPtr& waiting) {
  if (!document_.session().findCase(waiting->run.case_id)) {
    waiting->storing = false;
    std::erase(waiting_, waiting);
    Q_EMIT failed(tr("The run of %1 is not kept: the case was removed meanwhile.")
                      .arg(fromText(waiting->run.case_id)));
    settle(waiting);
    return true;
  }
  if (waiting->file == document_.file()) return false;
  store(waiting);
  return true;
}

/// The session was saved: perhaps there is room now.
void RunStore::storeAgain() {
  if (document_.file() == unstored_file_ && document_.isModified()) return;
  for (const WaitingPtr& waiting : std::vector(waiting_))
    if (!waiting->storing) store(waiting);
}

/// A batch waits for one run at a time, once.
void RunStore::settle(const WaitingPtr& waiting) {
  if (const int batch = std::exchange(waiting->batch, 0)) Q_EMIT settled(batch);
}

bool RunStore::isStoring() const {
  return std::ranges::any_of(waiting_, [](const WaitingPtr& waiting) { return waiting->storing; });
}

bool RunStore::noteRuns(const std::vector<sessions::RunRecord>& records) {
  const auto with_runs = [&records](const sessions::Session& session) {
    sessions::Session after = session;
    for (const sessions::RunRecord& run : records) after = sessions::withRun(after, run);
    return after;
  };
  return document_.note(with_runs, tr("Run %1").arg(fromText(records.front().case_id)));
}

QStringList RunStore::unstored() const {
  QStringList ids;
  for (const WaitingPtr& waiting : waiting_)
    if (!waiting->storing) ids << fromText(waiting->run.case_id);
  return ids;
}

QStringList RunStore::waiting() const {
  QStringList ids;
  for (const WaitingPtr& waiting : waiting_) ids << fromText(waiting->run.case_id);
  return ids;
}

QString RunStore::unstoredReason() const {
  QString reason;
  for (const WaitingPtr& waiting : waiting_)
    if (!waiting->storing) reason = waiting->problem;
  return reason;
}

}  // namespace boresight::ui
