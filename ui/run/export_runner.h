// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <deque>
#include <functional>
#include <utility>

#include <QObject>
#include <QString>

#include "ui/run/task_runner.h"

namespace boresight::ui {

/// An export under way.
struct ExportJob {
  QString name;    ///< "Writing report.pdf"
  QString detail;  ///< what takes the time: "the pose of bc-000004 is measured again"
  int done = 0;
  int of = 0;  ///< 0: nothing to count
};

/// Writes files on a separate thread, one after the other: the views do not wait for them.
class ExportRunner : public QObject {
  Q_OBJECT

 public:
  /// To be called by the writer with the number of parts written, and of all.
  using Progress = std::function<void(int done, int of)>;

  using QObject::QObject;

  /// `write(progress)` returns a value, `done(value)` takes it on this object's thread; if it
  /// throws, failed() is emitted.
  template <class Write, class Done>
  void start(const QString& name, const QString& detail, Write write, Done done) {
    add({name, detail}, [this, write = std::move(write), done = std::move(done)](
                            const std::stop_token&, const TaskRunner::Report& report) {
      const Progress progress = [this, &report](int count, int of) {
        report([this, count, of] { showProgress(count, of); });
      };
      auto value = std::make_shared<decltype(write(progress))>(write(progress));
      report([value, done] { done(std::move(*value)); });
    });
  }
  bool isBusy() const { return !jobs_.empty(); }
  /// Under way and waiting.
  int count() const { return static_cast<int>(jobs_.size()); }
  /// The export under way; isBusy().
  const ExportJob& job() const { return jobs_.front(); }

 Q_SIGNALS:
  void changed();
  void failed(const QString& message);

 private:
  void add(const ExportJob& job, TaskRunner::Work work);
  void showProgress(int done, int of);
  void endFirst();

  std::deque<ExportJob> jobs_;  ///< the one under way first
  TaskRunner runner_;
};

}  // namespace boresight::ui
