// SPDX-License-Identifier: Apache-2.0
#include "ui/run/task_runner.h"

#include <algorithm>
#include <atomic>
#include <condition_variable>
#include <deque>
#include <exception>
#include <mutex>
#include <new>
#include <set>
#include <thread>

#include <QCoreApplication>
#include <QEvent>

namespace boresight::ui {

TaskKind::TaskKind() {
  static std::atomic<std::uint64_t> count = 0;
  number_ = ++count;
}

class TaskRunner::Thread {
 public:
  struct Item {
    std::uint64_t kind = 0;
    std::uint64_t number = 0;
    Work work;
    Failure failed;
    std::stop_source stop;
    /// Whether a report has thrown, which ends the task; of the owner's thread.
    std::shared_ptr<bool> broken;
  };

  explicit Thread(TaskRunner& owner) : owner_(owner), thread_([this] { loop(); }) {}

  ~Thread() {
    quit();
    thread_.join();
  }

  void quit() {
    {
      const std::lock_guard lock(mutex_);
      quit_ = true;
      running_.stop.request_stop();
    }
    wake_.notify_all();
  }
  bool isQuitting() const { return quit_; }
  bool hasEnded() const { return ended_; }

  void add(Item item) {
    {
      const std::lock_guard lock(mutex_);
      if (item.kind != 0) drop(item.kind);
      queue_.push_back(std::move(item));
    }
    wake_.notify_all();
  }

  void stop(std::uint64_t kind) {
    const std::lock_guard lock(mutex_);
    if (running_.kind == kind) running_.stop.request_stop();
    for (Item& item : queue_)
      if (item.kind == kind) item.stop.request_stop();
  }

  void cancel(std::uint64_t kind) {
    const std::lock_guard lock(mutex_);
    drop(kind);
  }

  /// The oldest report, on the owner's thread; there is one event for each.
  std::function<void()> takeReport() {
    const std::lock_guard lock(mutex_);
    std::function<void()> report = std::move(reports_.front());
    reports_.pop_front();
    return report;
  }

  /// Of a receiver that throws, too, nothing can be told.
  static void tell(const Failure& failed, const QString& problem) {
    (void)problemOf([&] { failed(problem); });
  }

 private:
  /// Skips waiting tasks and asks the running one to stop; the owner drops its results.
  void drop(std::uint64_t kind) {
    if (running_.kind == kind) running_.stop.request_stop();
    for (Item& item : queue_)
      if (item.kind == kind) item.work = nullptr;
  }

  /// False when it is time to go.
  bool waitForItem(Item& item) {
    std::unique_lock lock(mutex_);
    running_ = {};
    wake_.wait(lock, [this] { return quit_ || !queue_.empty(); });
    if (quit_) return false;
    item = std::move(queue_.front());
    queue_.pop_front();
    running_.kind = item.kind;
    running_.stop = item.stop;
    return true;
  }

  void loop() {
    for (Item item; waitForItem(item); item = {}) {
      const QString error = work(item);
      post([owner = &owner_, kind = item.kind, number = item.number, broken = item.broken,
            failed = item.failed,
            error] { owner->end(kind, number, *broken ? QString() : error, failed); });
    }
    ended_ = true;
  }

  /// Why it failed, or nothing.
  QString work(const Item& item) {
    if (!item.work) return {};
    const Report report = [this, kind = item.kind, number = item.number, broken = item.broken,
                           failed = item.failed, stop = item.stop](auto function) {
      post([owner = &owner_, kind, number, broken, failed, stop,
            function = std::move(function)]() mutable {
        if (*broken || !owner->isUsed(kind, number)) return;
        const QString problem = problemOf(function);
        if (problem.isEmpty()) return;
        *broken = true;  // its end is told once
        stop.request_stop();
        tell(failed, problem);
      });
    };
    return problemOf([&] { item.work(item.stop.get_token(), report); });
  }

  /// Why the function threw, or nothing.
  template <class Function>
  static QString problemOf(const Function& function) {
    try {
      function();
    } catch (const std::bad_alloc&) {
      return tr("Not enough memory; close other sessions or use a smaller image.");
    } catch (const std::exception& exception) {
      return QString::fromUtf8(exception.what());
    } catch (...) {
      return tr("An unknown error.");
    }
    return {};
  }

  /// To be called in the owner's thread; dropped when the owner is gone. The event only signals
  /// that there is a report: data crosses threads under the mutex, where a thread sanitizer sees
  /// it, which does not see Qt's own locks.
  void post(std::function<void()> function) {
    const std::lock_guard lock(mutex_);
    reports_.push_back(std::move(function));
    QCoreApplication::postEvent(&owner_, new QEvent(QEvent::User));
  }

  TaskRunner& owner_;
  std::mutex mutex_;
  std::condition_variable wake_;
  std::atomic<bool> quit_ = false;
  std::atomic<bool> ended_ = false;
  std::deque<Item> queue_;
  std::deque<std::function<void()>> reports_;  ///< not yet taken by the owner
  Item running_;                               ///< its key and stop source
  std::thread thread_;                         ///< last: it starts when everything above is there
};

namespace {

/// Of the UI's thread.
std::set<TaskRunner*>& allRunners() {
  static std::set<TaskRunner*> runners;
  return runners;
}

}  // namespace

TaskRunner::TaskRunner(QObject* parent)
    : QObject(parent), thread_(std::make_unique<Thread>(*this)) {
  allRunners().insert(this);
}

TaskRunner::~TaskRunner() { allRunners().erase(this); }

void TaskRunner::endAll() {
  for (const TaskRunner* runner : allRunners()) runner->thread_->quit();
}

bool TaskRunner::allEnded() {
  return std::ranges::all_of(allRunners(),
                             [](const TaskRunner* runner) { return runner->thread_->hasEnded(); });
}

void TaskRunner::add(std::uint64_t kind, Work work, Failure failed) {
  if (thread_->isQuitting()) return;
  ++count_;
  if (kind != 0) newest_[kind] = count_;
  ++pending_;
  thread_->add({kind, count_, std::move(work), std::move(failed), std::stop_source(),
                std::make_shared<bool>(false)});
  if (pending_ == 1) Q_EMIT busyChanged();
}

void TaskRunner::stop(const TaskKind& kind) { thread_->stop(kind.number_); }

void TaskRunner::cancel(const TaskKind& kind) {
  newest_.erase(kind.number_);
  thread_->cancel(kind.number_);
}

void TaskRunner::customEvent(QEvent*) {
  const std::function<void()> report = thread_->takeReport();
  if (!thread_->isQuitting()) report();
}

bool TaskRunner::isUsed(std::uint64_t kind, std::uint64_t number) const {
  if (kind == 0) return true;
  const auto found = newest_.find(kind);
  return found != newest_.end() && found->second == number;
}

void TaskRunner::end(std::uint64_t kind, std::uint64_t number, const QString& error,
                     const Failure& failed) {
  --pending_;
  if (!error.isEmpty() && isUsed(kind, number)) Thread::tell(failed, error);
  if (pending_ == 0) Q_EMIT busyChanged();
}

}  // namespace boresight::ui
