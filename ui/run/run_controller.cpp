// SPDX-License-Identifier: Apache-2.0
#include "ui/run/run_controller.h"

#include <algorithm>
#include <stdexcept>
#include <utility>

namespace boresight::ui {

using sessions::Runner;
using sessions::StepUntil;

/// One run, touched by the worker alone once it is under way.
struct RunController::Job {
  RunInputs inputs;
  std::shared_ptr<const sessions::LoadedViews> read;  ///< of several views
  std::unique_ptr<Runner> run;                        ///< points into the inputs or what was read

  bool finished() const { return run && run->finished(); }

  /// Of the case, or of every view.
  std::vector<SnapshotPtr> records() const {
    std::vector<SnapshotPtr> records;
    for (const sessions::LocalizationTrace& trace : run->traces())
      records.push_back(std::make_shared<const sessions::LocalizationTrace>(trace));
    return records;
  }

  /// False when it was stopped before the iteration from which the run continues.
  bool advance(StepUntil until, const std::stop_token& stop) {
    const sessions::RunSettings watched{.level = sessions::RecordLevel::kStages};
    if (!run && inputs.others.empty()) {
      run = std::make_unique<Runner>(inputs.one->problem(), inputs.plan, watched);
    } else if (!run) {
      read = sessions::loadViews(inputs.one, inputs.others);
      if (stop.stop_requested()) return false;
      run = std::make_unique<Runner>(read->problem(), inputs.plan.options, read->ids(), watched);
    }
    if (!catchUp(stop)) return false;
    run->advance(until, stop);
    return true;
  }

  /// Runs the kept iterations of another run again; false when it was stopped on the way.
  bool catchUp(const std::stop_token& stop) {
    const std::size_t kept = inputs.kept.size();
    if (run->trace().complete() >= kept) return true;
    while (run->trace().complete() < kept && !run->finished() && !stop.stop_requested())
      run->advance(StepUntil::kIteration, stop);
    if (run->trace().complete() < kept && !run->finished()) return false;
    if (!hasKept())
      throw std::runtime_error(
          RunController::tr("The recorded iterations are from another version of the program and "
                            "cannot be repeated. Run again from the start.")
              .toStdString());
    return true;
  }

  bool hasKept() const {
    const auto& result = run->trace().iterations;
    return result.size() >= inputs.kept.size() &&
           std::equal(inputs.kept.begin(), inputs.kept.end(), result.begin(),
                      [](const auto& kept, const auto& iteration) {
                        return kept->camera_from_station == iteration->camera_from_station;
                      });
  }
};

void RunController::reset(RunInputs inputs) {
  runner_.cancel(running_);
  inputs_ = std::move(inputs);
  snapshot_.reset();
  views_.clear();
  job_ = std::make_shared<Job>(Job{inputs_, nullptr, nullptr});
  setState(inputs_.one ? RunState::kReady : RunState::kEmpty);
  Q_EMIT snapshotChanged();
}

void RunController::advance(StepUntil until) {
  if (state_ != RunState::kReady && state_ != RunState::kHalted) return;
  setState(RunState::kWorking);
  // A longer way is gone in iterations, so that the operator can watch.
  const StepUntil stride = until == StepUntil::kEnd ? StepUntil::kIteration : until;
  const auto work = [this, until, stride, job = job_](const std::stop_token& stop,
                                                      const TaskRunner::Report& report) {
    for (bool halted = false; !halted;) {
      std::vector<SnapshotPtr> records;
      if (job->advance(stride, stop)) records = job->records();
      halted = job->finished() || until != StepUntil::kEnd || stop.stop_requested();
      report([this, records, halted] { takeResult(records, halted); });
    }
  };
  runner_.replace(running_, work, [this](const QString& message) { takeFailure(message); });
}

void RunController::stop() { runner_.stop(running_); }

void RunController::takeResult(std::vector<SnapshotPtr> records, bool halted) {
  if (records.empty()) return setState(RunState::kHalted);
  snapshot_ = records.front();
  views_ = inputs_.others.empty() ? std::vector<SnapshotPtr>() : std::move(records);
  const bool ended = snapshot_->finished;
  Q_EMIT snapshotChanged();
  if (halted) setState(ended ? RunState::kFinished : RunState::kHalted);
  if (ended) Q_EMIT finished();
}

/// A run that has ended or halted before its receiver failed is not begun again.
void RunController::takeFailure(const QString& message) {
  if (state_ != RunState::kWorking) {
    Q_EMIT failed(message);
    return;
  }
  job_ = std::make_shared<Job>(Job{inputs_, nullptr, nullptr});
  setState(RunState::kReady);
  Q_EMIT failed(message);
}

void RunController::setState(RunState state) {
  if (state == state_) return;
  state_ = state;
  Q_EMIT stateChanged();
}

}  // namespace boresight::ui
