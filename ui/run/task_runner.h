// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <exception>
#include <functional>
#include <map>
#include <memory>
#include <stop_token>
#include <utility>

#include <QObject>
#include <QString>

namespace boresight::ui {

/// A worker thread for tasks of views, which run in the order of their requests. Each kind of task
/// has a key: of one key only the newest task is used; an older one is stopped and its results are
/// dropped. Tasks that must not wait for others need a separate runner.
class TaskRunner : public QObject {
  Q_OBJECT

 public:
  /// Calls a function on the runner's own (the UI's) thread, unless the task is dropped.
  using Report = std::function<void(std::function<void()>)>;
  using Work = std::function<void(const std::stop_token&, const Report&)>;

  explicit TaskRunner(QObject* parent = nullptr);
  ~TaskRunner() override;

  /// Runs a task that reports progress. Its captures must be shared or copied. If it throws,
  /// failed() is emitted.
  void run(const QString& key, Work work);

  /// `work(stop_token)` returns a value, `done(value)` takes it on this object's thread.
  template <class Make, class Done>
  void start(const QString& key, Make make, Done done) {
    run(key, [make = std::move(make), done = std::move(done)](const std::stop_token& stop,
                                                              const Report& report) {
      auto value = std::make_shared<decltype(make(stop))>(make(stop));
      report([value, done] { done(std::move(*value)); });
    });
  }
  /// The same; `failed(message)` is called when the work throws.
  template <class Make, class Done, class Failed>
  void start(const QString& key, Make make, Done done, Failed failed) {
    run(key, [make = std::move(make), done = std::move(done), failed = std::move(failed)](
                 const std::stop_token& stop, const Report& report) {
      try {
        auto value = std::make_shared<decltype(make(stop))>(make(stop));
        report([value, done] { done(std::move(*value)); });
      } catch (const std::exception& error) {
        report([failed, message = QString::fromUtf8(error.what())] { failed(message); });
      }
    });
  }

  /// Asks running and waiting tasks of this key to stop; their reports are still delivered.
  void stop(const QString& key);
  /// Drops running and waiting tasks of this key.
  void cancel(const QString& key);
  bool isBusy() const { return pending_ > 0; }

 Q_SIGNALS:
  void busyChanged();
  void failed(const QString& message);

 protected:
  /// Handles a report of the worker.
  void customEvent(QEvent* event) override;

 private:
  class Thread;

  bool isNewest(const QString& key, std::uint64_t number) const;
  void end(const QString& key, std::uint64_t number, const QString& error);

  std::map<QString, std::uint64_t> newest_;  ///< number of the newest task of each key
  std::uint64_t count_ = 0;
  int pending_ = 0;
  std::unique_ptr<Thread> thread_;
};

}  // namespace boresight::ui
