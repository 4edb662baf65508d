// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <map>
#include <memory>
#include <optional>
#include <vector>

#include <QElapsedTimer>
#include <QObject>
#include <QString>
#include <QStringList>

#include "sessions/session/case_run.h"
#include "ui/run/task_runner.h"

namespace boresight::ui {

/// Progress of several cases that run one after another.
struct BatchProgress {
  int done = 0;
  int of = 0;
  QString case_id;                     ///< under way, or empty between two cases
  int iteration = 0;                   ///< of that case, from 1; 0: before the first
  std::optional<double> seconds_left;  ///< from the second case on
};

/// How a batch ended, or was stopped.
struct BatchSummary {
  int of = 0;                   ///< cases that were to be run
  std::map<QString, int> ends;  ///< number of cases by the end of their run: "converged"
  double seconds = 0.0;

  int count() const;  ///< of the cases that were run
};

/// Runs cases in the background, whatever case the views show: inputs are read, run and recorded on
/// a separate thread. One case at a time, so that its owner stores it before the next begins; a
/// stop takes effect at any time, also in between.
class Batch : public QObject {
  Q_OBJECT

 public:
  using TracePtr = std::shared_ptr<const sessions::LocalizationTrace>;

  using QObject::QObject;

  bool isActive() const { return progress_.has_value(); }
  const std::optional<BatchProgress>& progress() const { return progress_; }
  /// Of the last batch, until another begins or it is dropped.
  const std::optional<BatchSummary>& summary() const { return summary_; }
  void dropSummary();

  void start(const QStringList& ids);
  /// Takes the next waiting case; empty when there is none and the batch has ended.
  QString takeNext();
  /// `caseEnded` or `caseFailed` follows, unless the batch is stopped.
  void run(const sessions::Session& session, const QString& id);
  void stop();

 Q_SIGNALS:
  void changed();
  void caseEnded(const QString& id, const boresight::ui::Batch::TracePtr& trace);
  void caseFailed(const QString& id, const QString& message);

 private:
  void count(int iteration);
  void caseDone(const QString& end);

  TaskRunner runner_;
  TaskKind running_;
  QStringList waiting_;
  std::optional<BatchProgress> progress_;
  std::map<QString, int> ends_;
  std::optional<BatchSummary> summary_;
  QElapsedTimer watch_;
};

}  // namespace boresight::ui
