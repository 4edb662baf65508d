// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <memory>
#include <string>
#include <vector>

#include <QObject>
#include <QString>

#include "sessions/run/runner.h"
#include "sessions/session/views_run.h"
#include "sessions/trace/trace.h"
#include "ui/run/task_runner.h"

namespace boresight::ui {

enum class RunState {
  kEmpty,    ///< no case
  kReady,    ///< nothing has run yet
  kWorking,  ///< the worker is at it
  kHalted,   ///< between two slices, can go on
  kFinished,
};

/// What one run works on; immutable, shared with the worker.
struct RunInputs {
  std::shared_ptr<const sessions::LoadedCase> one = {};
  sessions::RunPlan plan;
  /// Of the run that is gone on from: its first iterations, which are run again without being shown
  /// and must come out as they are here; and its digest, empty when it was halted.
  std::vector<std::shared_ptr<const sessions::IterationTrace>> kept = {};
  std::string continued = {};
  /// Other views of the case's rig that it is solved together with; read by the worker.
  std::vector<sessions::SessionCase> others = {};
};

/// Runs one localization off the UI's thread. Inputs go in as a snapshot, records that never change
/// come back through signals; the newest order wins, what an older one still yields is dropped, and
/// stopping never waits.
class RunController : public QObject {
  Q_OBJECT

 public:
  using SnapshotPtr = std::shared_ptr<const sessions::LocalizationTrace>;

  explicit RunController(QObject* parent = nullptr);

  RunState state() const { return state_; }
  /// The latest record; nullptr before the first.
  const SnapshotPtr& snapshot() const { return snapshot_; }
  const RunInputs& inputs() const { return inputs_; }
  /// Of a run of several views, the latest record of each, the case's first; else none.
  const std::vector<SnapshotPtr>& views() const { return views_; }

  /// Drops the run, if any; the next step begins again from these. Without a case: kEmpty.
  void reset(RunInputs inputs);
  /// Goes on until the stage, the iteration or the run is complete. Nothing while working, without
  /// a case, or after the end.
  void advance(sessions::StepUntil until);
  /// Halts after the slice under way (20 ms at most at 2048 x 2048).
  void stop();

 Q_SIGNALS:
  void stateChanged();
  /// A stage or an iteration is complete, or the run has halted or ended.
  void snapshotChanged();
  /// The run has ended by itself.
  void finished();
  /// The worker could not go on (no memory); a sentence for the operator.
  void failed(const QString& message);

 private:
  struct Job;

  void takeResult(std::vector<SnapshotPtr> records, bool halted);
  void takeFailure(const QString& message);
  void setState(RunState state);

  RunState state_ = RunState::kEmpty;
  RunInputs inputs_;
  SnapshotPtr snapshot_;
  std::vector<SnapshotPtr> views_;
  std::shared_ptr<Job> job_;
  TaskRunner runner_;
};

}  // namespace boresight::ui
