// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <filesystem>
#include <functional>
#include <memory>
#include <optional>
#include <string>
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

/// Connects document, worker and view state: a chosen case is read and shown with its latest run; a
/// run is shown while it proceeds and stored when it ends.
class CaseController : public QObject {
  Q_OBJECT

 public:
  CaseController(Document& document, ViewState& state, RunController& run, TaskRunner& tasks,
                 QObject* parent = nullptr);

  const QString& caseId() const { return case_id_; }
  /// Whether the case is run as soon as it is read.
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
  /// Shows another case; a batch continues.
  void chooseCase(const QString& id);
  void advance(boresight::sessions::StepUntil until);
  /// Runs the case that is being read as soon as it is loaded.
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
  /// Cases of ended runs that could not be stored in the session's folder (no room); they are
  /// stored as soon as the session is saved, there or elsewhere.
  QStringList unstoredRuns() const;
  /// Waits until a run that has ended is stored in the session, so that it is not lost.
  void finishStoring();
  /// Replaces a case's input by another file, once that is read.
  void changeInput(const QString& id, boresight::sessions::InputKind kind,
                   const std::filesystem::path& file, const std::string& mesh_unit);
  void useAsSeed(const boresight::Pose& camera_from_station);
  /// Sets the seed's uncertainty, and runs the case again.
  void runWithUncertainty(const boresight::sessions::DeclaredUncertainty& uncertainty);
  /// The same with any rotation of the seed about the view axis allowed.
  void runWithWiderSearch();
  /// Makes the nudged pose an edit of the document, at the end of a gesture.
  void keepNudgedPose();
  /// Shows an earlier run of the case instead of the latest.
  void showRun(const std::string& digest);
  void setOptions(const QString& profile, const boresight::LocalizerOptions& options);

 Q_SIGNALS:
  void caseChosen(const QString& id);
  /// Reading, running or storing something failed; one sentence.
  void failed(const QString& message);
  /// There is no room for a run in the session's folder; one sentence.
  void storeFailed(const QString& message);
  void stalenessChanged();
  /// A batch has begun, continued with its next case, or ended.
  void batchChanged();

 private:
  /// All that is needed to store a run.
  struct EndedRun {
    sessions::Session session;  ///< from which it was run
    std::string case_id;
    ViewState::SnapshotPtr snapshot;
    std::string continued;                      ///< digest of the run that it continues, or empty
    std::vector<ViewState::SnapshotPtr> views;  ///< of several that were solved as one
    bool of_batch = false;
  };

  void documentOpened();
  void documentChanged();
  const sessions::SessionCase* sessionCase() const;
  bool isLoaded() const;
  void dropRun();
  /// Edits the shown case; `text` names the undo step, %1 being the case. False when nothing was
  /// edited.
  bool editCase(const std::function<void(sessions::SessionCase&)>& change, const QString& text);
  void load(const QString& id);
  void loaded(const QString& id, std::shared_ptr<const sessions::LoadedCase> loaded_case);
  void loadFailed(const QString& id, const QString& message);
  void judgeInputs();
  void loadLatestRun(const QString& id);
  void prepareRun(RunInputs inputs);
  void start(const std::function<void()>& prepare,
             sessions::StepUntil until = sessions::StepUntil::kEnd);
  void requireLoaded() const;
  void prepareRerun(int iteration);
  void storeRun();
  static std::vector<sessions::RunRecord> recordsOf(const EndedRun& ended,
                                                    const std::filesystem::path& file);
  void store(const EndedRun& ended);
  bool noteRuns(const std::vector<sessions::RunRecord>& records);
  void runNext();
  void endBatch();
  void showRunOf(const std::string& case_id);
  void runIfWaiting();
  void showNudgedPose();

  Document& document_;
  ViewState& state_;
  RunController& run_;
  TaskRunner& tasks_;
  QString case_id_;
  QString load_problem_;
  std::optional<sessions::InputConcern> input_concern_;
  std::optional<Pose> working_;  ///< camera_from_station of the document that the views have
  std::optional<sessions::SessionCase> asked_;  ///< the case read last, or being read
  bool reads_run_ = false;
  bool run_is_prepared_ = false;
  bool is_new_run_ = false;  ///< from the seed, and nothing of it is shown yet
  int storing_ = 0;
  std::vector<EndedRun> unstored_;
  std::filesystem::path unstored_file_;  ///< where there was no room
  sessions::Session run_session_;        ///< of the prepared run
  std::optional<sessions::StepUntil> run_when_loaded_;
  Batch batch_;
  sessions::Session batch_session_;  ///< of the case under way
  QStringList batch_failures_;       ///< reported together at its end
};

}  // namespace boresight::ui
