// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <filesystem>
#include <functional>
#include <map>
#include <memory>
#include <optional>
#include <string>
#include <tuple>
#include <utility>
#include <vector>

#include <QObject>
#include <QString>
#include <QStringList>

#include "core/localizer/localizer_options.h"
#include "sessions/run/runner.h"
#include "sessions/session/case_inputs.h"
#include "ui/run/batch.h"
#include "ui/run/run_controller.h"
#include "ui/state/view_state.h"

namespace boresight::ui {

class Document;
class DocumentTasks;
class RunStore;

/// Connects document, worker and view state: a chosen case is read and shown with its latest run; a
/// run is shown while it proceeds, and is given to the store when it ends.
class CaseController : public QObject {
  Q_OBJECT

 public:
  CaseController(Document& document, ViewState& state, RunController& run, RunStore& store,
                 TaskRunner& tasks, DocumentTasks& of_document);

  /// Id of the open case, shown or being read; or empty.
  QString caseId() const;
  /// Whether the open case is run as soon as it is read.
  bool runsSoon() const { return run_when_loaded_.has_value(); }
  /// Whether the last run of the shown case is being read.
  bool readsRun() const { return reads_run_; }
  /// Why the case could not be read, or empty.
  const QString& loadProblem() const { return load_problem_; }
  /// The options of the next run of the case.
  LocalizerOptions options() const;
  /// A sentence when the shown run was made with other options or inputs; else empty.
  QString staleness() const;
  /// Why the case cannot be run together with other views, one sentence; empty when it can.
  QString whyAlone() const;
  /// Whether a run or a batch is under way.
  bool isWorking() const { return run_.state() == RunState::kWorking || batch_.isActive(); }
  /// The batch under way, from reading its first case to storing its last run; else empty.
  const std::optional<BatchProgress>& batch() const { return batch_.progress(); }
  /// How the last batch ended; empty while one runs, and from the next run on.
  const std::optional<BatchSummary>& lastBatch() const { return batch_.summary(); }
  /// Input that a run of the shown case would reject; empty while that is not known.
  const std::optional<sessions::InputConcern>& inputConcern() const { return input_concern_; }
  /// Why the shown case cannot be run, or empty.
  QString whyNotRunnable() const;

 public Q_SLOTS:
  /// Opens another case: no case is shown until it is read. A batch continues.
  void chooseCase(const QString& id);
  /// Runs the open case; as soon as it is read where it is not.
  void advance(boresight::sessions::StepUntil until);
  /// Reads the open case again where it could not be read.
  void readAgain();
  /// Runs the open case as soon as it is read.
  void runOnceLoaded() { run_when_loaded_ = sessions::StepUntil::kEnd; }
  /// Keeps the shown run's iterations before this one and computes the following ones with the
  /// current options.
  void rerunFrom(int iteration);
  /// Runs the case by this plan instead of the session's options.
  void runPlan(const boresight::sessions::RunPlan& plan);
  /// Halts the run and ends the batch, also while one of its cases is read or stored.
  void stop();
  /// Drops the shown run; the next step starts a new one.
  void reset();
  /// Runs the case from its seed, with the current inputs and options.
  void runAgain();
  /// Runs cases in the background: the shown case stays, and its run is shown when it has ended.
  void runAll(const QStringList& ids);
  /// Runs the cases that have no run with their current inputs and options.
  void runRest();
  /// Runs the case to its end together with the other views of its rig, as one pose; each gets its
  /// own run.
  void runTogether();
  /// Replaces a case's input by another file, once that is read; no other input of it changes.
  void changeInput(const QString& id, boresight::sessions::InputKind kind,
                   const std::filesystem::path& file, const std::string& mesh_unit);
  /// Sets the seed of the shown case.
  void useAsSeed(const boresight::Pose& camera_from_station);
  /// Sets the seed's uncertainty in the shown case, and runs it again.
  void runWithUncertainty(const boresight::sessions::DeclaredUncertainty& uncertainty);
  /// The same with any rotation of the seed about the view axis allowed.
  void runWithWiderSearch();
  /// Makes the nudged pose an edit of the document, at the end of a gesture.
  void keepNudgedPose();
  /// Shows an earlier run of the case instead of the latest.
  void showRun(const std::string& digest);
  void setOptions(const QString& profile, const boresight::LocalizerOptions& options);

 Q_SIGNALS:
  /// Reading or running something failed; one sentence.
  void failed(const QString& message);
  /// A remark for the operator; one sentence.
  void noted(const QString& message);
  void stalenessChanged();
  /// A batch has begun, continued with its next case, or ended.
  void batchChanged();

 private:
  void documentOpened();
  void endRuns(const QString& why);
  void reportBatch();
  void documentChanged();
  void leaveCase();
  void dropRunReading();
  void openFirst();
  void showChange(const sessions::SessionCase& session_case);
  std::string openId() const { return state_.opening().id; }
  const sessions::SessionCase* sessionCase() const;
  bool isLoaded() const;
  void dropRun();
  /// Edits the case that the operator saw; `text` names the undo step, %1 being the case. False
  /// when nothing was edited.
  bool editCase(const std::string& id, const std::function<void(sessions::SessionCase&)>& change,
                const QString& text);
  void load();
  void loaded(const ViewState::CasePtr& loaded_case);
  void loadFailed(const QString& message);
  void judgeInputs();
  void loadLatestRun();
  void prepareRun(RunInputs inputs);
  void start(const std::function<void()>& prepare,
             sessions::StepUntil until = sessions::StepUntil::kEnd);
  void requireLoaded() const;
  void prepareRerun(int iteration);
  void storeRun();
  void runNext();
  void endBatch();
  void goOnAfter(int batch);
  void showRunOf(const std::string& case_id);
  void runIfWaiting();
  void reportRun(const QString& problem);
  void showNudgedPose();

  Document& document_;
  ViewState& state_;
  RunController& run_;
  RunStore& store_;
  TaskRunner& tasks_;
  DocumentTasks& of_document_;
  TaskKind reading_;
  TaskKind judging_;
  TaskKind reading_run_;
  TaskKind showing_run_;
  /// By opening of a session, case and input. Another file of an input drops a change of it that is
  /// under way; a change in a session that is left reports that it was not used.
  std::map<std::tuple<int, std::string, sessions::InputKind>, TaskKind> changing_;
  QString load_problem_;
  std::optional<sessions::InputConcern> input_concern_;
  std::optional<Pose> working_;  ///< camera_from_station of the document that the views have
  std::optional<sessions::SessionCase> asked_;  ///< the case read last, or being read
  bool reads_ = false;                          ///< `asked_` is being read
  bool reads_run_ = false;                      ///< the last run of the open case is being read
  bool run_is_prepared_ = false;
  bool is_new_run_ = false;        ///< from the seed, and nothing of it is shown yet
  sessions::Session run_session_;  ///< of the prepared run
  std::optional<sessions::StepUntil> run_when_loaded_;  ///< of the open case
  Batch batch_;
  int batches_ = 0;                  ///< number of the newest batch
  sessions::Session batch_session_;  ///< of the case under way
  QStringList batch_failures_;       ///< reported together at its end
};

}  // namespace boresight::ui
