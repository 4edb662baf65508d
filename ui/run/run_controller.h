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
  kWorking,  ///< the worker runs
  kHalted,   ///< between two slices, can continue
  kFinished,
};

/// Inputs of one run; immutable, shared with the worker.
struct RunInputs {
  std::shared_ptr<const sessions::LoadedCase> one = {};
  sessions::RunPlan plan;
  /// Of the run that is continued: its first iterations, which are repeated without being shown and
  /// must give the same results; and its digest, empty when it was halted.
  std::vector<std::shared_ptr<const sessions::IterationTrace>> kept = {};
  std::string continued = {};
  /// Other views of the case's rig that it is solved together with; read by the worker.
  std::vector<sessions::SessionCase> others = {};
};

/// Runs one localization on a worker thread. Inputs are a snapshot; immutable records come back
/// through signals. The newest request replaces older ones, whose results are dropped; stopping
/// never waits.
class RunController : public QObject {
  Q_OBJECT

 public:
  using SnapshotPtr = std::shared_ptr<const sessions::LocalizationTrace>;

  using QObject::QObject;

  RunState state() const { return state_; }
  /// The latest record; nullptr before the first.
  const SnapshotPtr& snapshot() const { return snapshot_; }
  const RunInputs& inputs() const { return inputs_; }
  /// The latest record of each view of a run of several views, the case's first; else none.
  const std::vector<SnapshotPtr>& views() const { return views_; }

  /// Drops the run, if any; the next step starts with these inputs. Without a case: kEmpty.
  void reset(RunInputs inputs);
  /// Continues until the stage, the iteration or the run is complete. No effect while working,
  /// without a case, or after the end.
  void advance(sessions::StepUntil until);
  /// Halts after the slice under way (20 ms at most at 2048 x 2048).
  void stop();

 Q_SIGNALS:
  void stateChanged();
  /// A stage or an iteration is complete, or the run has halted or ended.
  void snapshotChanged();
  /// The run has ended without a stop.
  void finished();
  /// The worker failed (no memory); a sentence for the operator.
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
  TaskKind running_;
};

}  // namespace boresight::ui
