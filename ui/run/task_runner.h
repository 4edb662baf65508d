// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <functional>
#include <map>
#include <memory>
#include <stop_token>
#include <utility>

#include <QObject>
#include <QString>

namespace boresight::ui {

/// Work for views, off the UI's thread and in the order in which it was asked for. Each kind of
/// work has a key: of one key only the newest counts, an older one is stopped and its result
/// dropped.
class TaskRunner : public QObject {
  Q_OBJECT

 public:
  explicit TaskRunner(QObject* parent = nullptr);
  ~TaskRunner() override;

  /// `work(stop_token)` makes a value on the runner's thread, `done(value)` takes it on this
  /// object's thread. What `work` captures must be shared or copied. If it throws, `failed` says
  /// why.
  template <class Work, class Done>
  void start(const QString& key, Work work, Done done) {
    enqueue(key, [work = std::move(work), done = std::move(done)](const std::stop_token& stop) {
      auto value = std::make_shared<decltype(work(stop))>(work(stop));
      return std::function<void()>([value, done] { done(std::move(*value)); });
    });
  }
  /// Drops what is under way or waits under this key.
  void cancel(const QString& key);
  bool isBusy() const { return pending_ > 0; }

 Q_SIGNALS:
  void busyChanged();
  void failed(const QString& message);

 private:
  using Task = std::function<std::function<void()>(const std::stop_token&)>;
  class Thread;

  void enqueue(const QString& key, Task task);
  void take(const QString& key, std::uint64_t number, const std::function<void()>& done,
            const QString& error);

  std::map<QString, std::uint64_t> newest_;  ///< number of the newest task of each key
  std::uint64_t count_ = 0;
  int pending_ = 0;
  std::unique_ptr<Thread> thread_;
};

}  // namespace boresight::ui
