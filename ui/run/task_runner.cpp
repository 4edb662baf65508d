// SPDX-License-Identifier: Apache-2.0
#include "ui/run/task_runner.h"

#include <condition_variable>
#include <deque>
#include <exception>
#include <mutex>
#include <new>
#include <thread>

#include <QCoreApplication>
#include <QEvent>

namespace boresight::ui {

class TaskRunner::Thread {
 public:
  struct Item {
    QString key;
    std::uint64_t number = 0;
    Work work;
    std::stop_source stop;
  };

  explicit Thread(TaskRunner& owner) : owner_(owner), thread_([this] { loop(); }) {}

  ~Thread() {
    {
      const std::lock_guard lock(mutex_);
      quit_ = true;
      running_.stop.request_stop();
    }
    wake_.notify_all();
    thread_.join();
  }

  void add(Item item) {
    {
      const std::lock_guard lock(mutex_);
      drop(item.key);
      queue_.push_back(std::move(item));
    }
    wake_.notify_all();
  }

  void stop(const QString& key) {
    const std::lock_guard lock(mutex_);
    if (running_.key == key) running_.stop.request_stop();
    for (Item& item : queue_)
      if (item.key == key) item.stop.request_stop();
  }

  void cancel(const QString& key) {
    const std::lock_guard lock(mutex_);
    drop(key);
  }

  /// The oldest report, on the owner's thread; there is one event for each.
  std::function<void()> takeReport() {
    const std::lock_guard lock(mutex_);
    std::function<void()> report = std::move(reports_.front());
    reports_.pop_front();
    return report;
  }

 private:
  /// Skips waiting tasks and asks the running one to stop; the owner drops its results.
  void drop(const QString& key) {
    if (running_.key == key) running_.stop.request_stop();
    for (Item& item : queue_)
      if (item.key == key) item.work = nullptr;
  }

  /// False when it is time to go.
  bool waitForItem(Item& item) {
    std::unique_lock lock(mutex_);
    running_ = {};
    wake_.wait(lock, [this] { return quit_ || !queue_.empty(); });
    if (quit_) return false;
    item = std::move(queue_.front());
    queue_.pop_front();
    running_.key = item.key;
    running_.stop = item.stop;
    return true;
  }

  void loop() {
    for (Item item; waitForItem(item); item = {}) {
      const QString error = work(item);
      post([owner = &owner_, key = item.key, number = item.number, error] {
        owner->end(key, number, error);
      });
    }
  }

  /// Why it failed, or nothing.
  QString work(const Item& item) {
    if (!item.work) return {};
    const Report report = [this, key = item.key, number = item.number](auto function) {
      post([owner = &owner_, key, number, function = std::move(function)] {
        if (owner->isNewest(key, number)) function();
      });
    };
    try {
      item.work(item.stop.get_token(), report);
    } catch (const std::bad_alloc&) {
      return tr("Not enough memory; close other sessions or use a smaller image.");
    } catch (const std::exception& exception) {
      return QString::fromUtf8(exception.what());
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
  bool quit_ = false;
  std::deque<Item> queue_;
  std::deque<std::function<void()>> reports_;  ///< not yet taken by the owner
  Item running_;                               ///< its key and stop source
  std::thread thread_;                         ///< last: it starts when everything above is there
};

TaskRunner::TaskRunner(QObject* parent)
    : QObject(parent), thread_(std::make_unique<Thread>(*this)) {}

TaskRunner::~TaskRunner() = default;

void TaskRunner::run(const QString& key, Work work) {
  newest_[key] = ++count_;
  ++pending_;
  thread_->add({key, count_, std::move(work), std::stop_source()});
  if (pending_ == 1) Q_EMIT busyChanged();
}

void TaskRunner::stop(const QString& key) { thread_->stop(key); }

void TaskRunner::cancel(const QString& key) {
  newest_[key] = 0;
  thread_->cancel(key);
}

void TaskRunner::customEvent(QEvent*) { thread_->takeReport()(); }

bool TaskRunner::isNewest(const QString& key, std::uint64_t number) const {
  const auto found = newest_.find(key);
  return found != newest_.end() && found->second == number;
}

void TaskRunner::end(const QString& key, std::uint64_t number, const QString& error) {
  --pending_;
  if (!error.isEmpty() && isNewest(key, number)) Q_EMIT failed(error);
  if (pending_ == 0) Q_EMIT busyChanged();
}

}  // namespace boresight::ui
