// SPDX-License-Identifier: Apache-2.0
#include "ui/window/case_controller.h"

#include <algorithm>
#include <stdexcept>
#include <utility>

#include <QCoreApplication>

#include "sessions/io/files/errors.h"
#include "sessions/session/views_run.h"
#include "ui/models/text.h"
#include "ui/run/task_runner.h"
#include "ui/state/document.h"

namespace boresight::ui {

using sessions::StepUntil;

namespace {

/// The views have the nudged pose apart from the case that they show.
bool sameButNudge(sessions::SessionCase a, const sessions::SessionCase& b) {
  a.camera_from_station_working = b.camera_from_station_working;
  return a == b;
}

constexpr int kPatience_ms = 100;  ///< between looks whether a store has failed

void requirePlan(const sessions::RunPlan& plan) {
  const std::string problem = sessions::planProblem(plan);
  if (!problem.empty()) throw std::runtime_error(problem + ".");
}

ViewState::SnapshotPtr readRun(const sessions::RunRecord& run) {
  return std::make_shared<const sessions::LocalizationTrace>(sessions::loadSnapshot(run));
}

/// The cursor after the last iteration.
RunCursor atEndOf(const sessions::LocalizationTrace& run) {
  return {static_cast<int>(run.iterations.size()) - 1, Stage::kFinished};
}

}  // namespace

CaseController::CaseController(Document& document, ViewState& state, RunController& run,
                               TaskRunner& tasks, QObject* parent)
    : QObject(parent), document_(document), state_(state), run_(run), tasks_(tasks) {
  connect(&document_, &Document::opened, this, &CaseController::documentOpened);
  connect(&document_, &Document::changed, this, &CaseController::documentChanged);
  connect(&run_, &RunController::snapshotChanged, this, [this] {
    if (!run_.snapshot()) return;
    state_.setSnapshot(run_.snapshot());
    if (std::exchange(is_new_run_, false))  // wherever the run before was looked at
      state_.setCursor(atEndOf(*run_.snapshot()));
  });
  connect(&run_, &RunController::finished, this, &CaseController::storeRun);
  connect(&run_, &RunController::failed, this, [this](const QString& message) {
    run_is_prepared_ = false;
    Q_EMIT failed(message);
  });
  connect(&batch_, &Batch::changed, this, &CaseController::batchChanged);
  connect(&batch_, &Batch::caseEnded, this,
          [this](const QString& id, const ViewState::SnapshotPtr& trace) {
            store({batch_session_, id.toStdString(), trace, {}, {}, true});
          });
  connect(&batch_, &Batch::caseFailed, this, [this](const QString&, const QString& message) {
    batch_failures_ << message;
    runNext();
  });
}

void CaseController::documentOpened() {
  case_id_.clear();
  endBatch();
  batch_.dropSummary();
  unstored_.clear();
  const sessions::Session& session = document_.session();
  std::string first = session.view.case_id;
  if (!session.findCase(first)) first = session.cases.empty() ? "" : session.cases.front()->id;
  state_.setCase(nullptr);  // not of another document, nor of this one before its recovery
  if (!first.empty()) return chooseCase(fromText(first));
  run_.reset({});
  Q_EMIT caseChosen(QString());
}

void CaseController::documentChanged() {
  // The session was saved: perhaps there is room now.
  if (!unstored_.empty() && (document_.file() != unstored_file_ || !document_.isModified()))
    for (const EndedRun& ended : std::exchange(unstored_, {})) store(ended);
  const sessions::SessionCase* session_case = sessionCase();
  if (!session_case) return documentOpened();
  // Another seed, mask or image than the one that is shown.
  if (!asked_ || !sameButNudge(*asked_, *session_case)) load(case_id_);
  if (!(session_case->camera_from_station_working == working_)) showNudgedPose();
  Q_EMIT stalenessChanged();
}

void CaseController::chooseCase(const QString& id) {
  if (id == case_id_) return;
  case_id_ = id;
  dropRun();
  Q_EMIT caseChosen(id);
  load(id);
}

const sessions::SessionCase* CaseController::sessionCase() const {
  return document_.session().findCase(case_id_.toStdString());
}

void CaseController::dropRun() {
  run_.reset({});
  run_is_prepared_ = false;
}

/// Whether the case that the views have is the document's as it is now.
bool CaseController::isLoaded() const {
  const sessions::SessionCase* session_case = sessionCase();
  return session_case && state_.currentCase() &&
         sameButNudge(state_.currentCase()->source, *session_case);
}

void CaseController::showNudgedPose() {
  const sessions::SessionCase* session_case = sessionCase();
  working_ = session_case ? session_case->camera_from_station_working : std::nullopt;
  const ViewState::CasePtr& shown = state_.currentCase();
  if (shown && session_case && shown->source.id == session_case->id &&
      state_.nudgedPose() != working_)
    state_.setNudgedPose(working_);
}

void CaseController::load(const QString& id) {
  const sessions::SessionCase* session_case = document_.session().findCase(id.toStdString());
  if (!session_case) return;
  asked_ = *session_case;
  load_problem_.clear();
  input_concern_.reset();
  const ViewState::CasePtr before = state_.currentCase();
  tasks_.start(
      QStringLiteral("load case"),
      [source = *session_case, before](const std::stop_token&) {
        return before && before->source.id == source.id ? sessions::reloadCase(*before, source)
                                                        : sessions::loadCase(source);
      },
      [this, id](std::shared_ptr<const sessions::LoadedCase> read) { loaded(id, std::move(read)); },
      [this, id](const QString& problem) { loadFailed(id, problem); });
}

/// The case that was shown before is not shown under this one's name.
void CaseController::loadFailed(const QString& id, const QString& message) {
  if (id != case_id_) return;
  run_when_loaded_.reset();
  load_problem_ = message;
  const ViewState::CasePtr& shown = state_.currentCase();
  if (shown && fromText(shown->source.id) != id) state_.setCase(nullptr);
  Q_EMIT failed(message);
}

void CaseController::loaded(const QString& id,
                            std::shared_ptr<const sessions::LoadedCase> loaded_case) {
  if (id != case_id_) return;
  dropRun();
  const ViewState::CasePtr& before = state_.currentCase();
  const bool edited = before && before->source.id == loaded_case->source.id;
  // A run that has not ended cannot continue with other inputs; a finished one stays and is stale.
  if (edited && state_.snapshot() && state_.snapshot()->finished) {
    state_.replaceCase(std::move(loaded_case));
    judgeInputs();
    Q_EMIT stalenessChanged();
    return runIfWaiting();
  }
  state_.setCase(std::move(loaded_case));
  judgeInputs();
  showNudgedPose();
  loadLatestRun(id);
}

/// By the run's own checks, before the operator requests a run.
void CaseController::judgeInputs() {
  tasks_.start(
      QStringLiteral("judge inputs"),
      [loaded = state_.currentCase()](const std::stop_token&) {
        return std::pair(loaded, sessions::inputConcern(*loaded));
      },
      [this](const std::pair<ViewState::CasePtr, std::optional<sessions::InputConcern>>& judged) {
        if (judged.first != state_.currentCase()) return;
        input_concern_ = judged.second;
        Q_EMIT stalenessChanged();
      });
}

void CaseController::loadLatestRun(const QString& id) {
  const sessions::RunRecord* record = document_.session().lastRunOf(id.toStdString());
  reads_run_ = record && !run_when_loaded_;
  if (!reads_run_) {  // it is run now
    Q_EMIT stalenessChanged();
    return runIfWaiting();
  }
  tasks_.start(
      QStringLiteral("load run"), [run = *record](const std::stop_token&) { return readRun(run); },
      [this, id](ViewState::SnapshotPtr snapshot) {
        reads_run_ = false;
        if (id != case_id_ || run_is_prepared_) return;
        state_.setSnapshot(std::move(snapshot));
        Q_EMIT stalenessChanged();
      },
      [this](const QString& problem) {
        reads_run_ = false;
        Q_EMIT failed(problem);
      });
}

LocalizerOptions CaseController::options() const {
  const sessions::SessionCase* session_case = sessionCase();
  if (!session_case) return sessions::sessionOptions(document_.session(), document_.file());
  return sessions::caseOptions(document_.session(), *session_case, document_.file());
}

QString CaseController::staleness() const {
  const ViewState::SnapshotPtr& shown = state_.snapshot();
  if (!shown || shown->replayed) return {};
  const std::string id = case_id_.toStdString();
  const sessions::RunRecord* record =
      shown->digest.empty() ? nullptr : sessions::findRun(document_.session(), id, shown->digest);
  if (!record && storing_) return {};  // the run before says nothing of one that has just ended
  if (!record) record = document_.session().lastRunOf(id);
  if (!record) return {};
  const sessions::Staleness stale =
      sessions::stalenessOf(*record, document_.session(), document_.file());
  if (stale.inputs_changed && stale.options_changed)
    return tr("The run was made with other inputs and options.");
  if (stale.inputs_changed) return tr("The run was made with other inputs.");
  return stale.options_changed ? tr("The run was made with other options.") : QString();
}

void CaseController::prepareRun(RunInputs inputs) {
  inputs.one = state_.currentCase();
  run_.reset(std::move(inputs));
  run_session_ = document_.session();
  run_is_prepared_ = true;
  is_new_run_ = run_.inputs().kept.empty();
}

void CaseController::advance(StepUntil until) {
  if (!state_.currentCase()) return;
  if (!isLoaded()) {
    run_when_loaded_ = until;
    return load(case_id_);
  }
  start(
      [&] {
        if (!run_is_prepared_ || run_.state() == RunState::kFinished)
          prepareRun({.plan = options()});
      },
      until);
}

/// Advances what `prepare` makes ready; an exception of it is reported instead.
void CaseController::start(const std::function<void()>& prepare, StepUntil until) {
  if (!state_.currentCase() || run_.state() == RunState::kWorking) return;
  try {
    sessions::requireRunnable(*state_.currentCase());
    prepare();
  } catch (const std::exception& error) {
    Q_EMIT failed(QString::fromUtf8(error.what()));
    return;
  }
  batch_.dropSummary();
  run_.advance(until);
}

void CaseController::requireLoaded() const {
  if (!isLoaded()) throw std::runtime_error(tr("The case is still being read.").toStdString());
}

void CaseController::runPlan(const sessions::RunPlan& plan) {
  start([&] {
    requireLoaded();
    requirePlan(plan);
    prepareRun({.plan = plan});
  });
}

QString CaseController::whyNotRunnable() const {
  const sessions::SessionCase* session_case = sessionCase();
  if (!session_case) return tr("Open a case first");
  if (input_concern_) return fromText(input_concern_->text);
  return session_case->has_seed
             ? QString()
             : tr("The case has no seed: annotate it, then use the solved pose as its seed");
}

QString CaseController::whyAlone() const {
  return fromText(sessions::whyAlone(document_.session(), case_id_.toStdString()));
}

void CaseController::runTogether() {
  start([&] {
    requireLoaded();
    if (!whyAlone().isEmpty()) throw std::runtime_error(whyAlone().toStdString());
    prepareRun({.plan = options(),
                .others = sessions::otherViews(document_.session(), case_id_.toStdString())});
  });
}

void CaseController::rerunFrom(int iteration) {
  if (!state_.snapshot() || run_.state() == RunState::kWorking) return;
  if (iteration < 1) return runAgain();
  start([&] { prepareRerun(iteration); });
}

void CaseController::prepareRerun(int iteration) {
  const sessions::LocalizationTrace& shown = *state_.snapshot();
  if (shown.replayed)
    throw std::runtime_error(
        tr("The onboard run is shown; run the case on the ground first.").toStdString());
  if (!shown.views.empty())
    throw std::runtime_error(
        tr("The shown run was made with other views: run it with them again from the start.")
            .toStdString());
  const auto kept = static_cast<std::size_t>(iteration);
  const std::string id = case_id_.toStdString();
  const sessions::RunRecord* record = document_.session().lastRunOf(id);
  const bool is_recorded = record && record->digest == shown.digest;
  if (!isLoaded() || (is_recorded && record->inputs_sha256 !=
                                         sessions::inputsDigest(*document_.session().findCase(id))))
    throw std::runtime_error(
        tr("The shown run was made with other inputs: run again from the start.").toStdString());
  if (kept >= shown.iterations.size())
    throw std::runtime_error(tr("The shown run has no such iteration.").toStdString());
  RunInputs inputs;
  inputs.plan = sessions::continuedPlan(shown.plan(), iteration, options());
  inputs.kept.assign(shown.iterations.begin(), shown.iterations.begin() + iteration);
  inputs.continued = shown.digest;
  requirePlan(inputs.plan);
  prepareRun(std::move(inputs));
}

void CaseController::stop() {
  endBatch();
  run_when_loaded_.reset();
  run_.stop();
}

void CaseController::reset() {
  run_.stop();
  dropRun();
  state_.setSnapshot(nullptr);
  Q_EMIT stalenessChanged();
}

void CaseController::runAgain() {
  reset();
  advance(StepUntil::kEnd);
}

void CaseController::storeRun() {
  run_is_prepared_ = false;
  if (const auto snapshot = run_.snapshot())
    store({run_session_, case_id_.toStdString(), snapshot, run_.inputs().continued, run_.views()});
}

/// Written into the session's folder: one, or one of every view.
std::vector<sessions::RunRecord> CaseController::recordsOf(const EndedRun& ended,
                                                           const std::filesystem::path& file) {
  if (ended.views.empty())
    return {
        sessions::storeRun(ended.session, ended.case_id, *ended.snapshot, file, ended.continued)};
  std::vector<sessions::LocalizationTrace> views;
  for (const ViewState::SnapshotPtr& snapshot_ptr : ended.views) views.push_back(*snapshot_ptr);
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
      QStringLiteral("store run %1").arg(fromText(ended.snapshot->digest)),
      [ended, file = document_.file()](const std::stop_token&) {
        try {
          return Stored{recordsOf(ended, file), {}};
        } catch (const sessions::OutputError& error) {
          return Stored{{}, QString::fromUtf8(error.what())};
        }
      },
      [this, ended, file = document_.file()](const Stored& stored) {
        --storing_;
        // Before it is recorded: a failure is reported at once, and the answer is to save
        // elsewhere.
        unstored_file_ = file;
        unstored_.push_back(ended);
        if (stored.records.empty()) {
          Q_EMIT storeFailed(stored.problem);
          if (!unstored_.empty()) endBatch();  // nor is there room for the next
        } else if (noteRuns(stored.records)) {
          std::erase_if(unstored_, [&](const EndedRun& ended_run) {
            return ended_run.snapshot == ended.snapshot;
          });
          Q_EMIT stalenessChanged();
          if (ended.of_batch) showRunOf(ended.case_id);
        }
        if (ended.of_batch) runNext();
      });
}

bool CaseController::noteRuns(const std::vector<sessions::RunRecord>& records) {
  const auto with_runs = [&records](const sessions::Session& session) {
    sessions::Session after = session;
    for (const sessions::RunRecord& run : records) after = sessions::withRun(after, run);
    return after;
  };
  return document_.note(with_runs, tr("Run %1").arg(fromText(records.front().case_id)));
}

QStringList CaseController::unstoredRuns() const {
  QStringList ids;
  for (const EndedRun& ended : unstored_) ids << fromText(ended.case_id);
  return ids;
}

void CaseController::finishStoring() {
  // A store that fails leaves nothing busy.
  while (storing_ && tasks_.isBusy())
    QCoreApplication::processEvents(
        QEventLoop::ExcludeUserInputEvents | QEventLoop::WaitForMoreEvents, kPatience_ms);
}

void CaseController::runAll(const QStringList& ids) {
  if (ids == QStringList{case_id_}) return advance(StepUntil::kEnd);
  batch_failures_.clear();
  batch_.start(ids);
  runNext();
}

void CaseController::runRest() {
  const sessions::Session& session = document_.session();
  QStringList ids;
  for (const auto& each : session.cases) {
    const sessions::RunRecord* run = session.lastRunOf(each->id);
    if (!run || sessions::stalenessOf(*run, session, document_.file()).stale())
      ids << fromText(each->id);
  }
  if (ids.isEmpty())
    Q_EMIT failed(tr("Every case has a run with its current inputs and options."));
  else
    runAll(ids);
}

void CaseController::endBatch() {
  batch_.stop();
  if (!batch_failures_.isEmpty())
    Q_EMIT failed(std::exchange(batch_failures_, {}).join(QLatin1Char('\n')));
}

/// Goes on with the batch, if there is one.
void CaseController::runNext() {
  if (!batch_.isActive()) return;
  const QString next = batch_.takeNext();
  batch_session_ = document_.session();
  next.isEmpty() ? endBatch() : batch_.run(batch_session_, next);
}

/// Of a batch, in the views, where they show that case and no other run of it is under way.
void CaseController::showRunOf(const std::string& case_id) {
  if (case_id != case_id_.toStdString() || run_.state() == RunState::kWorking || !isLoaded())
    return;
  dropRun();
  loadLatestRun(case_id_);
}

void CaseController::runIfWaiting() {
  if (const auto until = std::exchange(run_when_loaded_, std::nullopt)) advance(*until);
}

void CaseController::changeInput(const QString& id, sessions::InputKind kind,
                                 const std::filesystem::path& file, const std::string& mesh_unit) {
  const sessions::SessionCase* session_case = document_.session().findCase(id.toStdString());
  if (!session_case) return;
  tasks_.start(
      QStringLiteral("change input"),
      [before = *session_case, kind, file, mesh_unit](const std::stop_token&) {
        return sessions::withInputFile(before, kind, file, mesh_unit);
      },
      [this, id, file](sessions::SessionCase changed) {
        document_.edit(sessions::withCase(document_.session(), std::move(changed)),
                       tr("Use %1 for %2").arg(fromText(file.filename().string()), id));
      },
      [this](const QString& problem) { Q_EMIT failed(problem); });
}

bool CaseController::editCase(const std::function<void(sessions::SessionCase&)>& change,
                              const QString& text) {
  return sessionCase() &&
         document_.edit(sessions::withChanged(document_.session(), case_id_.toStdString(), change),
                        text.arg(case_id_));
}

void CaseController::useAsSeed(const Pose& camera_from_station) {
  editCase(
      [&](sessions::SessionCase& changed) {
        changed.has_seed = true;
        changed.camera_from_station_seed = camera_from_station;
        changed.camera_from_station_working.reset();
      },
      tr("Move the seed of %1"));
}

void CaseController::runWithUncertainty(const sessions::DeclaredUncertainty& uncertainty) {
  if (editCase([&](sessions::SessionCase& changed) { changed.uncertainty = uncertainty; },
               tr("State the uncertainty of the seed of %1")))
    advance(StepUntil::kEnd);
}

void CaseController::runWithWiderSearch() {
  constexpr double kHalfTurn_deg = 180.0;
  const sessions::SessionCase* session_case = sessionCase();
  if (!session_case) return;
  sessions::DeclaredUncertainty wider = session_case->uncertainty;
  wider.rotation_deg.z() = kHalfTurn_deg;
  runWithUncertainty(wider);
}

void CaseController::keepNudgedPose() {
  const sessions::SessionCase* shown = shownCase(document_, state_);
  // In a session that cannot be edited the operator may nudge to look. Without a chosen case
  // another session is open.
  if (!shown || case_id_.isEmpty() || !document_.readOnlyReason().isEmpty()) return;
  const auto nudge = [this](sessions::SessionCase& changed) {
    changed.camera_from_station_working = state_.nudgedPose();
  };
  const QString text =
      state_.nudgedPose() ? tr("Nudge the pose of %1") : tr("Drop the nudged pose of %1");
  const std::string id = shown->id;  // another case may be chosen already
  document_.edit(sessions::withChanged(document_.session(), id, nudge), text.arg(fromText(id)));
}

void CaseController::setOptions(const QString& profile, const LocalizerOptions& options) {
  document_.edit(sessions::withOptions(document_.session(), profile.toStdString(), options),
                 tr("Change the configuration"));
}

void CaseController::showRun(const std::string& digest) {
  if (digest.empty()) return;  // findRun would take it for any run
  const sessions::RunRecord* found =
      sessions::findRun(document_.session(), case_id_.toStdString(), digest);
  if (!found || run_.state() == RunState::kWorking) return;
  tasks_.start(
      QStringLiteral("load run"), [run = *found](const std::stop_token&) { return readRun(run); },
      [this, id = case_id_](ViewState::SnapshotPtr snapshot) {
        if (id != case_id_) return;
        state_.setSnapshot(std::move(snapshot));
        state_.setCursor(atEndOf(*state_.snapshot()));
      });
}

}  // namespace boresight::ui
