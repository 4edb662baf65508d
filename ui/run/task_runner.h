// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <functional>
#include <map>
#include <memory>
#include <stop_token>
#include <type_traits>
#include <utility>

#include <QObject>
#include <QString>

namespace boresight::ui {

/// A kind of task: of one kind only the newest task of a runner is used. A member of the object
/// that starts the tasks.
class TaskKind {
 public:
  TaskKind();

 private:
  friend class TaskRunner;
  std::uint64_t number_;
};

/// Takes the failure of a task: one sentence for the operator.
template <class Function>
concept FailureReceiver = std::is_invocable_v<Function, const QString&>;

/// Emits a signal of `receiver` when a task fails.
template <class Receiver>
auto reportTo(Receiver* receiver, void (Receiver::*signal)(const QString&)) {
  return [receiver, signal](const QString& message) { Q_EMIT(receiver->*signal)(message); };
}

/// A worker thread for tasks, which run in the order of their requests. A task is queued, or
/// replaces the earlier task of its kind, which is stopped and whose results are dropped. Every
/// task names the receiver of its failure. Tasks that must not wait for others need a separate
/// runner.
class TaskRunner : public QObject {
  Q_OBJECT

 public:
  /// Calls a function on the runner's own (the UI's) thread, unless the task is dropped.
  using Report = std::function<void(std::function<void()>)>;
  using Work = std::function<void(const std::stop_token&, const Report&)>;

  explicit TaskRunner(QObject* parent = nullptr);
  ~TaskRunner() override;

  /// Runs a task that reports progress. Its captures must be shared or copied. `failed(message)` is
  /// called once, on this object's thread, when it, or a function that it reports, throws; after
  /// such a function the task is stopped, and nothing more of it is delivered.
  template <FailureReceiver Failed>
  void queue(Work work, Failed failed) {
    add(0, std::move(work), std::move(failed));
  }
  template <FailureReceiver Failed>
  void replace(const TaskKind& kind, Work work, Failed failed) {
    add(kind.number_, std::move(work), std::move(failed));
  }

  /// `make(stop_token)` returns a value, `done(value)` takes it on this object's thread.
  template <class Make, class Done, FailureReceiver Failed>
  void queue(Make make, Done done, Failed failed) {
    add(0, workOf(std::move(make), std::move(done)), std::move(failed));
  }
  template <class Make, class Done, FailureReceiver Failed>
  void replace(const TaskKind& kind, Make make, Done done, Failed failed) {
    add(kind.number_, workOf(std::move(make), std::move(done)), std::move(failed));
  }

  /// Asks the task of this kind to stop; its reports are still delivered.
  void stop(const TaskKind& kind);
  /// Drops the task of this kind: neither its reports nor its failure are delivered.
  void cancel(const TaskKind& kind);
  bool isBusy() const { return pending_ > 0; }

  /// For the end of the program: the tasks of every runner are asked to stop, those that wait are
  /// dropped, and no runner takes or delivers anything from now on.
  static void endAll();
  /// Whether every runner has ended after endAll(): a file that is being read is read first.
  static bool allEnded();

 Q_SIGNALS:
  void busyChanged();

 protected:
  /// Handles a report of the worker.
  void customEvent(QEvent* event) override;

 private:
  class Thread;
  using Failure = std::function<void(const QString&)>;

  template <class Make, class Done>
  static Work workOf(Make make, Done done) {
    return [make = std::move(make), done = std::move(done)](const std::stop_token& stop,
                                                            const Report& report) {
      auto value = std::make_shared<decltype(make(stop))>(make(stop));
      report([value, done] { done(std::move(*value)); });
    };
  }
  /// `kind` 0: of no kind.
  void add(std::uint64_t kind, Work work, Failure failed);
  bool isUsed(std::uint64_t kind, std::uint64_t number) const;
  void end(std::uint64_t kind, std::uint64_t number, const QString& error, const Failure& failed);

  std::map<std::uint64_t, std::uint64_t> newest_;  ///< number of the newest task of each kind
  std::uint64_t count_ = 0;
  int pending_ = 0;
  std::unique_ptr<Thread> thread_;
};

}  // namespace boresight::ui
