// SPDX-License-Identifier: Apache-2.0
#include "ui/run/run_controller.h"

#include <condition_variable>
#include <mutex>
#include <new>
#include <stop_token>
#include <thread>
#include <utility>

namespace boresight::ui {

using sessions::SteppedRun;
using sessions::StepUntil;

/// The thread that works. It holds one order at a time; a newer one replaces it.
class RunController::Worker {
 public:
  explicit Worker(RunController& owner) : owner_(owner), thread_([this] { loop(); }) {}

  ~Worker() {
    {
      const std::lock_guard lock(mutex_);
      quit_ = true;
      stop_.request_stop();
    }
    wake_.notify_all();
    thread_.join();
  }

  void reset(std::uint64_t generation, RunInputs inputs) {
    const std::lock_guard lock(mutex_);
    stop_.request_stop();
    generation_ = generation;
    inputs_ = std::move(inputs);
    fresh_ = true;
    ordered_.reset();
  }

  void advance(StepUntil until) {
    {
      const std::lock_guard lock(mutex_);
      stop_ = std::stop_source();
      ordered_ = until;
    }
    wake_.notify_all();
  }

  void stop() {
    const std::lock_guard lock(mutex_);
    stop_.request_stop();
  }

 private:
  void loop() {
    while (waitForOrder()) {
      try {
        work();
      } catch (const std::bad_alloc&) {
        run_.reset();
        const std::uint64_t generation = working_generation_;
        post([this, generation] {
          owner_.takeFailure(generation, tr("There is not enough memory for this run; close other "
                                            "sessions or use a smaller image."));
        });
      }
    }
  }

  /// False when it is time to go.
  bool waitForOrder() {
    std::unique_lock lock(mutex_);
    wake_.wait(lock, [this] { return quit_ || ordered_.has_value(); });
    if (quit_) return false;
    until_ = *ordered_;
    ordered_.reset();
    token_ = stop_.get_token();
    working_generation_ = generation_;
    if (fresh_) {
      run_.reset();  // before the inputs that it points into
      working_inputs_ = inputs_;
      fresh_ = false;
    }
    return true;
  }

  void work() {
    if (!run_) {
      LocalizationProblem problem = working_inputs_.one->problem();
      if (working_inputs_.camera_from_station_seed)
        problem.camera_from_station_seed = *working_inputs_.camera_from_station_seed;
      run_ = std::make_unique<SteppedRun>(problem, working_inputs_.options);
    }
    // A longer way is gone in iterations, so that people can watch.
    const StepUntil stride = until_ == StepUntil::kEnd ? StepUntil::kIteration : until_;
    do {
      run_->advance(stride, token_);
      const bool halted = run_->finished() || until_ != StepUntil::kEnd || token_.stop_requested();
      postSnapshot(halted);
      if (halted) return;
    } while (true);
  }

  void postSnapshot(bool halted) {
    auto snapshot = std::make_shared<const sessions::RunSnapshot>(run_->snapshot());
    const std::uint64_t generation = working_generation_;
    post([this, generation, snapshot, halted] { owner_.takeResult(generation, snapshot, halted); });
  }

  /// In the owner's thread; dropped when the owner is gone.
  template <class Function>
  void post(Function&& function) {
    QMetaObject::invokeMethod(&owner_, std::forward<Function>(function), Qt::QueuedConnection);
  }

  RunController& owner_;
  std::mutex mutex_;
  std::condition_variable wake_;
  bool quit_ = false;
  bool fresh_ = false;
  std::uint64_t generation_ = 0;
  RunInputs inputs_;
  std::optional<StepUntil> ordered_;
  std::stop_source stop_;

  // The thread's own:
  StepUntil until_ = StepUntil::kEnd;
  std::stop_token token_;
  std::uint64_t working_generation_ = 0;
  RunInputs working_inputs_;
  std::unique_ptr<SteppedRun> run_;

  std::thread thread_;  ///< last: it starts when everything above is there
};

RunController::RunController(QObject* parent)
    : QObject(parent), worker_(std::make_unique<Worker>(*this)) {}

RunController::~RunController() = default;

void RunController::reset(RunInputs inputs) {
  inputs_ = std::move(inputs);
  snapshot_.reset();
  ++generation_;
  worker_->reset(generation_, inputs_);
  setState(inputs_.one ? RunState::kReady : RunState::kEmpty);
  Q_EMIT snapshotChanged();
}

void RunController::advance(StepUntil until) {
  if (state_ != RunState::kReady && state_ != RunState::kHalted) return;
  setState(RunState::kWorking);
  worker_->advance(until);
}

void RunController::stop() { worker_->stop(); }

void RunController::takeResult(std::uint64_t generation, SnapshotPtr snapshot, bool halted) {
  if (generation != generation_) return;
  snapshot_ = std::move(snapshot);
  const bool ended = snapshot_->finished;
  Q_EMIT snapshotChanged();
  if (halted) setState(ended ? RunState::kFinished : RunState::kHalted);
  if (ended) Q_EMIT finished();
}

void RunController::takeFailure(std::uint64_t generation, const QString& message) {
  if (generation != generation_) return;
  setState(RunState::kReady);
  Q_EMIT failed(message);
}

void RunController::setState(RunState state) {
  if (state == state_) return;
  state_ = state;
  Q_EMIT stateChanged();
}

}  // namespace boresight::ui
