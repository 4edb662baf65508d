// SPDX-License-Identifier: Apache-2.0
#include "ui/run/run_controller.h"

#include <utility>

namespace boresight::ui {

using sessions::SteppedRun;
using sessions::StepUntil;

namespace {

QString taskKey() { return QStringLiteral("run"); }

}  // namespace

/// One run, touched by the worker alone once it is under way.
struct RunController::Job {
  RunInputs inputs;
  std::unique_ptr<SteppedRun> run;  ///< points into the inputs

  void advance(StepUntil until, const std::stop_token& stop) {
    if (!run) run = std::make_unique<SteppedRun>(inputs.one->problem(), inputs.options);
    run->advance(until, stop);
  }
};

RunController::RunController(QObject* parent) : QObject(parent) {
  connect(&runner_, &TaskRunner::failed, this, &RunController::takeFailure);
}

RunController::~RunController() = default;

void RunController::reset(RunInputs inputs) {
  runner_.cancel(taskKey());
  inputs_ = std::move(inputs);
  snapshot_.reset();
  job_ = std::make_shared<Job>();
  job_->inputs = inputs_;
  setState(inputs_.one ? RunState::kReady : RunState::kEmpty);
  Q_EMIT snapshotChanged();
}

void RunController::advance(StepUntil until) {
  if (state_ != RunState::kReady && state_ != RunState::kHalted) return;
  setState(RunState::kWorking);
  // A longer way is gone in iterations, so that people can watch.
  const StepUntil stride = until == StepUntil::kEnd ? StepUntil::kIteration : until;
  runner_.run(taskKey(), [this, until, stride, job = job_](const std::stop_token& stop,
                                                           const TaskRunner::Report& report) {
    for (bool halted = false; !halted;) {
      job->advance(stride, stop);
      halted = job->run->finished() || until != StepUntil::kEnd || stop.stop_requested();
      auto snapshot = std::make_shared<const sessions::RunSnapshot>(job->run->snapshot());
      report([this, snapshot, halted] { takeResult(snapshot, halted); });
    }
  });
}

void RunController::stop() { runner_.stop(taskKey()); }

void RunController::takeResult(SnapshotPtr snapshot, bool halted) {
  snapshot_ = std::move(snapshot);
  const bool ended = snapshot_->finished;
  Q_EMIT snapshotChanged();
  if (halted) setState(ended ? RunState::kFinished : RunState::kHalted);
  if (ended) Q_EMIT finished();
}

void RunController::takeFailure(const QString& message) {
  job_ = std::make_shared<Job>();
  job_->inputs = inputs_;
  setState(RunState::kReady);
  Q_EMIT failed(message);
}

void RunController::setState(RunState state) {
  if (state == state_) return;
  state_ = state;
  Q_EMIT stateChanged();
}

}  // namespace boresight::ui
