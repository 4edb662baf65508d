// SPDX-License-Identifier: Apache-2.0
#include "ui/window/case_controller.h"

#include <algorithm>
#include <stdexcept>
#include <utility>

#include "sessions/session/views_run.h"
#include "ui/models/text.h"
#include "ui/run/document_tasks.h"
#include "ui/run/task_runner.h"
#include "ui/state/document.h"
#include "ui/window/run_store.h"

namespace boresight::ui {

using sessions::StepUntil;

namespace {

/// The views have the nudged pose apart from the case that they show.
bool sameButNudge(sessions::SessionCase a, const sessions::SessionCase& b) {
  a.camera_from_station_working = b.camera_from_station_working;
  return a == b;
}

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
                               RunStore& store, TaskRunner& tasks, DocumentTasks& of_document)
    : document_(document),
      state_(state),
      run_(run),
      store_(store),
      tasks_(tasks),
      of_document_(of_document) {
  connect(&document_, &Document::left, this, [this] { endRuns(tr("its session was closed")); });
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
    reportRun(message);
  });
  connect(&batch_, &Batch::changed, this, &CaseController::batchChanged);
  connect(&batch_, &Batch::caseEnded, this,
          [this](const QString& id, const ViewState::SnapshotPtr& trace) {
            store_.keep({.session = batch_session_,
                         .case_id = id.toStdString(),
                         .snapshot = trace,
                         .batch = batches_});
          });
  connect(&batch_, &Batch::caseFailed, this, [this](const QString&, const QString& message) {
    batch_failures_ << message;
    runNext();
  });
  connect(&store_, &RunStore::stored, this, [this](const std::string& case_id, bool of_batch) {
    Q_EMIT stalenessChanged();
    if (of_batch) showRunOf(case_id);
  });
  connect(&store_, &RunStore::blocked, this, &CaseController::endBatch);
  connect(&store_, &RunStore::settled, this, &CaseController::goOnAfter);
}

QString CaseController::caseId() const { return fromText(openId()); }

/// They are of the session as it was when they began.
void CaseController::endRuns(const QString& why) {
  if (batch_.isActive())
    Q_EMIT noted(tr("The batch run was stopped: %1.").arg(why));
  else if (isWorking())
    Q_EMIT noted(tr("The run of %1 was stopped: %2.").arg(caseId(), why));
  batch_.stop();
  batch_.dropSummary();
  leaveCase();
}

void CaseController::documentOpened() {
  endRuns(tr("its session was read again"));  // of one that is left they have ended
  asked_.reset();
  state_.setCase(nullptr);  // not of another document, nor of this one before its recovery
  openFirst();
  reportBatch();
}

/// Drops what was requested for the open case.
void CaseController::leaveCase() {
  tasks_.cancel(reading_);
  dropRunReading();
  run_when_loaded_.reset();
  reads_ = false;
  load_problem_.clear();
  input_concern_.reset();
  dropRun();
}

/// Drops the reading of a run that is to be shown.
void CaseController::dropRunReading() {
  tasks_.cancel(reading_run_);
  tasks_.cancel(showing_run_);
  reads_run_ = false;
}

/// The case that was shown last, else the first.
void CaseController::openFirst() {
  const sessions::Session& session = document_.session();
  std::string first = session.view.case_id;
  if (!session.findCase(first)) first = session.cases.empty() ? "" : session.cases.front()->id;
  if (!first.empty()) return chooseCase(fromText(first));
  if (openId().empty()) return;
  leaveCase();
  state_.setCase(nullptr);
}

void CaseController::documentChanged() {
  if (const sessions::SessionCase* session_case = sessionCase())
    showChange(*session_case);
  else
    openFirst();  // the open case was removed
}

void CaseController::showChange(const sessions::SessionCase& session_case) {
  // Another seed, mask or image than the one that is shown.
  if (!asked_ || !sameButNudge(*asked_, session_case)) load();
  if (!(session_case.camera_from_station_working == working_)) showNudgedPose();
  Q_EMIT stalenessChanged();
}

void CaseController::chooseCase(const QString& id) {
  if (id == caseId() || !document_.session().findCase(id.toStdString())) return;
  if (run_.state() == RunState::kWorking)
    Q_EMIT noted(tr("The run of %1 was stopped: %2 was opened.").arg(caseId(), id));
  leaveCase();
  state_.openCase(id.toStdString());
  load();
}

void CaseController::readAgain() {
  if (!state_.currentCase() && !reads_) load();
}

const sessions::SessionCase* CaseController::sessionCase() const {
  return document_.session().findCase(openId());
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

void CaseController::load() {
  const sessions::SessionCase* session_case = sessionCase();
  if (!session_case) return;
  asked_ = *session_case;
  reads_ = true;
  load_problem_.clear();
  input_concern_.reset();
  tasks_.replace(
      reading_,
      [source = *session_case, before = state_.currentCase()](const std::stop_token&) {
        return before ? sessions::reloadCase(*before, source) : sessions::loadCase(source);
      },
      [this](const ViewState::CasePtr& read) { loaded(read); },
      [this](const QString& problem) { loadFailed(problem); });
}

void CaseController::loadFailed(const QString& message) {
  reads_ = false;
  run_when_loaded_.reset();
  load_problem_ = message;
  Q_EMIT failed(message);
}

void CaseController::loaded(const ViewState::CasePtr& loaded_case) {
  reads_ = false;
  const ViewState::CasePtr before = state_.currentCase();
  const bool same_inputs = before && sessions::inputsDigest(before->source) ==
                                         sessions::inputsDigest(loaded_case->source);
  // A run that has not ended cannot continue with other inputs; a finished one stays and is stale.
  if (!same_inputs && run_.state() == RunState::kWorking)
    Q_EMIT noted(tr("The run of %1 was stopped: its inputs have changed.").arg(caseId()));
  if (!same_inputs) dropRun();
  if (same_inputs || (before && state_.snapshot() && state_.snapshot()->finished)) {
    state_.replaceCase(loaded_case);
    judgeInputs();
    Q_EMIT stalenessChanged();
    return runIfWaiting();
  }
  state_.setCase(loaded_case);
  judgeInputs();
  showNudgedPose();
  loadLatestRun();
}

/// By the run's own checks, before the operator requests a run.
void CaseController::judgeInputs() {
  tasks_.replace(
      judging_,
      [loaded = state_.currentCase()](const std::stop_token&) {
        return std::pair(loaded, sessions::inputConcern(*loaded));
      },
      [this](const std::pair<ViewState::CasePtr, std::optional<sessions::InputConcern>>& judged) {
        if (judged.first != state_.currentCase()) return;
        input_concern_ = judged.second;
        Q_EMIT stalenessChanged();
      },
      reportTo(this, &CaseController::failed));
}

void CaseController::loadLatestRun() {
  const sessions::RunRecord* record = document_.session().lastRunOf(openId());
  reads_run_ = record && !run_when_loaded_;
  if (!reads_run_) {  // it is run now
    Q_EMIT stalenessChanged();
    return runIfWaiting();
  }
  tasks_.replace(
      reading_run_, [run = *record](const std::stop_token&) { return readRun(run); },
      [this](ViewState::SnapshotPtr snapshot) {
        reads_run_ = false;
        if (run_is_prepared_) return;
        state_.setSnapshot(std::move(snapshot));
        Q_EMIT stalenessChanged();
      },
      [this, digest = record->digest](const QString& problem) {
        reads_run_ = false;
        if (!run_is_prepared_) state_.setMissingRun({digest, problem});
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
  const std::string id = openId();
  const sessions::RunRecord* record =
      shown->digest.empty() ? nullptr : sessions::findRun(document_.session(), id, shown->digest);
  if (!record && store_.isStoring())
    return {};  // the run before says nothing of one that has just ended
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
  if (!sessionCase()) return;
  if (!isLoaded()) {
    run_when_loaded_ = until;
    if (!reads_) load();
    return;
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
    return reportRun(QString::fromUtf8(error.what()));
  }
  batch_.dropSummary();
  dropRunReading();  // the run before would be shown over this one
  run_.advance(until);
}

/// Why there is no run. One that is shown stays.
void CaseController::reportRun(const QString& problem) {
  if (!state_.snapshot()) state_.setMissingRun({{}, problem});
  Q_EMIT failed(problem);
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
  return fromText(sessions::whyAlone(document_.session(), openId()));
}

void CaseController::runTogether() {
  start([&] {
    requireLoaded();
    if (!whyAlone().isEmpty()) throw std::runtime_error(whyAlone().toStdString());
    prepareRun({.plan = options(), .others = sessions::otherViews(document_.session(), openId())});
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
  const std::string id = openId();
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
  batch_.stop();
  run_when_loaded_.reset();
  run_.stop();
  reportBatch();
}

void CaseController::reset() {
  run_.stop();
  dropRun();
  dropRunReading();
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
    store_.keep({.session = run_session_,
                 .case_id = run_.inputs().one->source.id,
                 .snapshot = snapshot,
                 .continued = run_.inputs().continued,
                 .views = run_.views()});
}

void CaseController::runAll(const QStringList& ids) {
  if (ids == QStringList{caseId()}) return advance(StepUntil::kEnd);
  batch_failures_.clear();
  ++batches_;
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
  reportBatch();
}

/// What failed in the batch. Last of all: the window's report waits for the operator, and all goes
/// on meanwhile.
void CaseController::reportBatch() {
  if (!batch_failures_.isEmpty())
    Q_EMIT failed(std::exchange(batch_failures_, {}).join(QLatin1Char('\n')));
}

/// A run of a batch is stored, or cannot be stored.
void CaseController::goOnAfter(int batch) {
  if (batch == batches_) runNext();
}

/// Goes on with the batch, if there is one.
void CaseController::runNext() {
  if (!batch_.isActive()) return;
  const QString next = batch_.takeNext();
  batch_session_ = document_.session();
  next.isEmpty() ? endBatch() : batch_.run(batch_session_, next);
}

/// Of a batch, in the views, where they show that case and no other run of it is under way or
/// halted.
void CaseController::showRunOf(const std::string& case_id) {
  const bool under_way = run_.state() == RunState::kWorking || run_.state() == RunState::kHalted;
  if (case_id != openId() || under_way || !isLoaded()) return;
  dropRun();
  loadLatestRun();
}

void CaseController::runIfWaiting() {
  if (const auto until = std::exchange(run_when_loaded_, std::nullopt)) advance(*until);
}

void CaseController::changeInput(const QString& id, sessions::InputKind kind,
                                 const std::filesystem::path& file, const std::string& mesh_unit) {
  const sessions::SessionCase* session_case = document_.session().findCase(id.toStdString());
  if (!session_case) return;
  const QString name = fromText(file.filename().string());
  of_document_.ofCase(
      changing_[{document_.openings(), session_case->id, kind}], session_case->id,
      {tr("%1 for %2").arg(name, id), tr("choose %1 for %2 again").arg(name, id)},
      [before = *session_case, kind, file, mesh_unit](const std::stop_token&) {
        return sessions::withInputFile(before, kind, file, mesh_unit);
      },
      [this, before = *session_case, kind, name, id](const sessions::SessionCase& changed) {
        try {
          if (const auto after = sessions::withInput(document_.session(), kind, before, changed))
            document_.edit(*after, tr("Use %1 for %2").arg(name, id));
          else
            Q_EMIT failed(tr("%1 was not used: that input of %2 has changed since it was chosen.")
                              .arg(name, id));
        } catch (const sessions::InputError& error) {
          Q_EMIT failed(QString::fromUtf8(error.what()));
        }
      },
      reportTo(this, &CaseController::failed));
}

bool CaseController::editCase(const std::string& id,
                              const std::function<void(sessions::SessionCase&)>& change,
                              const QString& text) {
  return document_.session().findCase(id) &&
         document_.edit(sessions::withChanged(document_.session(), id, change),
                        text.arg(fromText(id)));
}

void CaseController::useAsSeed(const Pose& camera_from_station) {
  editCase(
      shownCaseId(document_, state_),
      [&](sessions::SessionCase& changed) { sessions::setSeed(changed, camera_from_station); },
      tr("Move the seed of %1"));
}

void CaseController::runWithUncertainty(const sessions::DeclaredUncertainty& uncertainty) {
  if (editCase(
          shownCaseId(document_, state_),
          [&](sessions::SessionCase& changed) { changed.uncertainty = uncertainty; },
          tr("State the uncertainty of the seed of %1")))
    advance(StepUntil::kEnd);
}

void CaseController::runWithWiderSearch() {
  constexpr double kHalfTurn_deg = 180.0;
  const sessions::SessionCase* shown = shownCase(document_, state_);
  if (!shown) return;
  sessions::DeclaredUncertainty wider = shown->uncertainty;
  wider.rotation_deg.z() = kHalfTurn_deg;
  runWithUncertainty(wider);
}

void CaseController::keepNudgedPose() {
  // In a session that cannot be edited the operator may nudge to look. Where nothing of it was read
  // another session is open.
  if (!asked_ || !document_.readOnlyReason().isEmpty()) return;
  editCase(
      shownCaseId(document_, state_),
      [this](sessions::SessionCase& changed) {
        changed.camera_from_station_working = state_.nudgedPose();
      },
      state_.nudgedPose() ? tr("Nudge the pose of %1") : tr("Drop the nudged pose of %1"));
}

void CaseController::setOptions(const QString& profile, const LocalizerOptions& options) {
  document_.edit(sessions::withOptions(document_.session(), profile.toStdString(), options),
                 tr("Change the configuration"));
}

void CaseController::showRun(const std::string& digest) {
  if (digest.empty()) return;  // findRun would take it for any run
  const sessions::RunRecord* found = sessions::findRun(document_.session(), openId(), digest);
  if (!found || run_.state() == RunState::kWorking) return;
  const bool is_last = sessions::lastRunDigest(document_.session(), openId()) == digest;
  tasks_.replace(
      showing_run_, [run = *found](const std::stop_token&) { return readRun(run); },
      [this](ViewState::SnapshotPtr snapshot) {
        if (!state_.currentCase() || run_.state() == RunState::kWorking) return;
        state_.setSnapshot(std::move(snapshot));
        state_.setCursor(atEndOf(*state_.snapshot()));
      },
      [this, digest, is_last](const QString& problem) {
        // The last run can be rejected where it is reported as missing. One that is shown stays.
        if (is_last && state_.currentCase() && !state_.snapshot() &&
            run_.state() != RunState::kWorking)
          state_.setMissingRun({digest, problem});
        Q_EMIT failed(problem);
      });
}

}  // namespace boresight::ui
