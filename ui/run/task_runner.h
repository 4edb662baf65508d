// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <exception>
#include <functional>
#include <map>
#include <memory>
#include <optional>
#include <stop_token>
#include <utility>

#include <QObject>
#include <QString>

namespace boresight::ui {

/// The one worker thread there is a class for: work for views, off the UI's thread and in the order
/// in which it was asked for. Each kind of work has a key: of one key only the newest counts, an
/// older one is stopped and what it still yields is dropped. Work that must not wait for other work
/// has a runner of its own.
class TaskRunner : public QObject {
  Q_OBJECT

 public:
  /// Has a function called on the runner's own (the UI's) thread, unless the task is dropped.
  using Report = std::function<void(std::function<void()>)>;
  using Work = std::function<void(const std::stop_token&, const Report&)>;

  explicit TaskRunner(QObject* parent = nullptr);
  ~TaskRunner() override;

  /// Work that reports on its way. What it captures must be shared or copied. If it throws,
  /// `failed` says why.
  void run(const QString& key, Work work);

  /// `work(stop_token)` makes a value, `done(value)` takes it on this object's thread.
  template <class Make, class Done>
  void start(const QString& key, Make make, Done done) {
    run(key, [make = std::move(make), done = std::move(done)](const std::stop_token& stop,
                                                              const Report& report) {
      auto value = std::make_shared<decltype(make(stop))>(make(stop));
      report([value, done] { done(std::move(*value)); });
    });
  }
  /// The same; `failed(message)` takes a sentence where the work throws.
  template <class Make, class Done, class Failed>
  void start(const QString& key, Make make, Done done, Failed failed) {
    using Value = decltype(make(std::stop_token()));
    struct Outcome {
      std::optional<Value> value;
      QString problem;
    };
    start(
        key,
        [make = std::move(make)](const std::stop_token& stop) {
          try {
            return Outcome{make(stop), {}};
          } catch (const std::exception& error) {
            return Outcome{std::nullopt, QString::fromUtf8(error.what())};
          }
        },
        [done = std::move(done), failed = std::move(failed)](Outcome outcome) {
          if (outcome.value)
            done(std::move(*outcome.value));
          else
            failed(outcome.problem);
        });
  }

  /// Asks what is under way or waits under this key to stop; what it reports still counts.
  void stop(const QString& key);
  /// Drops what is under way or waits under this key.
  void cancel(const QString& key);
  bool isBusy() const { return pending_ > 0; }

 Q_SIGNALS:
  void busyChanged();
  void failed(const QString& message);

 protected:
  /// A report of the worker has come.
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
