// SPDX-License-Identifier: Apache-2.0
#include "ui/run/batch.h"

#include <utility>

#include "sessions/run/runner.h"
#include "sessions/trace/run_text.h"
#include "ui/models/text.h"

namespace boresight::ui {

int BatchSummary::count() const {
  int cases = 0;
  for (const auto& [end, number] : ends) cases += number;
  return cases;
}

void Batch::start(const QStringList& ids) {
  waiting_ = ids;
  progress_ = BatchProgress{0, static_cast<int>(ids.size()), {}, 0, std::nullopt};
  ends_.clear();
  summary_.reset();
  watch_.start();
  Q_EMIT changed();
}

QString Batch::takeNext() {
  if (!progress_) return {};
  if (waiting_.isEmpty()) {
    stop();
    return {};
  }
  progress_->case_id = waiting_.takeFirst();
  progress_->iteration = 0;
  Q_EMIT changed();
  return progress_->case_id;
}

void Batch::run(const sessions::Session& session, const QString& id) {
  const auto work = [this, session, id](const std::stop_token& stop,
                                        const TaskRunner::Report& report) {
    const auto loaded = sessions::loadCase(sessions::knownCase(session, id.toStdString()));
    sessions::requireRunnable(*loaded);
    sessions::Runner run(
        loaded->problem(),
        sessions::RunPlan{sessions::caseOptions(session, loaded->source, "session")},
        {.level = sessions::RecordLevel::kFull});
    while (!run.finished() && !stop.stop_requested()) {
      run.advance(sessions::StepUntil::kIteration, stop);
      const auto iterations = static_cast<int>(run.trace().iterations.size());
      report([this, iterations] { count(iterations); });
    }
    if (!run.finished()) return;
    auto trace = std::make_shared<const sessions::LocalizationTrace>(run.trace());
    report([this, id, trace] {
      caseDone(fromText(sessions::runHeadline(*trace).head).toLower());
      Q_EMIT caseEnded(id, trace);
    });
  };
  runner_.replace(running_, work, [this, id](const QString& message) {
    if (progress_ && progress_->case_id == id) caseDone(tr("could not be run"));
    Q_EMIT caseFailed(id, message);
  });
}

void Batch::stop() {
  waiting_.clear();
  runner_.cancel(running_);
  if (const auto ended = std::exchange(progress_, std::nullopt)) {
    summary_ = {ended->of, std::exchange(ends_, {}), 1e-3 * static_cast<double>(watch_.elapsed())};
    Q_EMIT changed();
  }
}

void Batch::dropSummary() {
  if (std::exchange(summary_, std::nullopt)) Q_EMIT changed();
}

void Batch::count(int iteration) {
  if (!progress_) return;
  progress_->iteration = iteration;
  Q_EMIT changed();
}

/// Cases take about the same time each.
void Batch::caseDone(const QString& end) {
  if (!progress_) return;
  ++ends_[end];
  ++progress_->done;
  progress_->case_id.clear();
  const double each_s = 1e-3 * static_cast<double>(watch_.elapsed()) / progress_->done;
  progress_->seconds_left = each_s * (progress_->of - progress_->done);
}

}  // namespace boresight::ui
