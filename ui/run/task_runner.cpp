// SPDX-License-Identifier: Apache-2.0
#include "ui/run/task_runner.h"

#include <condition_variable>
#include <deque>
#include <exception>
#include <mutex>
#include <thread>

namespace boresight::ui {

class TaskRunner::Thread {
 public:
  explicit Thread(TaskRunner& owner) : owner_(owner), thread_([this] { loop(); }) {}

  ~Thread() {
    {
      const std::lock_guard lock(mutex_);
      quit_ = true;
      running_stop_.request_stop();
    }
    wake_.notify_all();
    thread_.join();
  }

  void add(const QString& key, std::uint64_t number, Task task) {
    {
      const std::lock_guard lock(mutex_);
      if (running_key_ == key) running_stop_.request_stop();
      queue_.push_back({key, number, std::move(task)});
    }
    wake_.notify_all();
  }

  void cancel(const QString& key) {
    const std::lock_guard lock(mutex_);
    if (running_key_ == key) running_stop_.request_stop();
  }

 private:
  struct Item {
    QString key;
    std::uint64_t number = 0;
    Task task;
  };

  void loop() {
    for (;;) {
      Item item;
      std::stop_token token;
      {
        std::unique_lock lock(mutex_);
        wake_.wait(lock, [this] { return quit_ || !queue_.empty(); });
        if (quit_) return;
        item = std::move(queue_.front());
        queue_.pop_front();
        // A newer one of the same kind waits already.
        for (const Item& later : queue_) {
          if (later.key == item.key) item.task = nullptr;
        }
        running_key_ = item.key;
        running_stop_ = std::stop_source();
        token = running_stop_.get_token();
      }
      std::function<void()> done;
      QString error;
      try {
        if (item.task) done = item.task(token);
      } catch (const std::exception& exception) {
        error = QString::fromUtf8(exception.what());
      }
      {
        const std::lock_guard lock(mutex_);
        running_key_.clear();
      }
      QMetaObject::invokeMethod(
          &owner_,
          [owner = &owner_, key = item.key, number = item.number, done, error] {
            owner->take(key, number, done, error);
          },
          Qt::QueuedConnection);
    }
  }

  TaskRunner& owner_;
  std::mutex mutex_;
  std::condition_variable wake_;
  bool quit_ = false;
  std::deque<Item> queue_;
  QString running_key_;
  std::stop_source running_stop_;
  std::thread thread_;  ///< last: it starts when everything above is there
};

TaskRunner::TaskRunner(QObject* parent)
    : QObject(parent), thread_(std::make_unique<Thread>(*this)) {}

TaskRunner::~TaskRunner() = default;

void TaskRunner::enqueue(const QString& key, Task task) {
  newest_[key] = ++count_;
  ++pending_;
  thread_->add(key, count_, std::move(task));
  if (pending_ == 1) Q_EMIT busyChanged();
}

void TaskRunner::cancel(const QString& key) {
  newest_[key] = 0;
  thread_->cancel(key);
}

void TaskRunner::take(const QString& key, std::uint64_t number, const std::function<void()>& done,
                      const QString& error) {
  --pending_;
  if (newest_[key] == number) {
    if (!error.isEmpty()) Q_EMIT failed(error);
    if (done) done();
  }
  if (pending_ == 0) Q_EMIT busyChanged();
}

}  // namespace boresight::ui
