// SPDX-License-Identifier: Apache-2.0
#include "ui/window/job_controller.h"

#include <QShortcut>

#include "sessions/checks/checks.h"
#include "ui/models/text.h"
#include "ui/review/review_controller.h"
#include "ui/run/export_runner.h"
#include "ui/run/run_controller.h"
#include "ui/run/sequence_runner.h"
#include "ui/run/task_runner.h"
#include "ui/state/document.h"
#include "ui/widgets/widgets.h"
#include "ui/window/case_controller.h"

namespace boresight::ui {

namespace {

/// "51 run in 65 s: 50 converged, 1 rejected", with the way to them; of a stopped batch to the
/// rest.
Job endedJob(const BatchSummary& batch) {
  QStringList ends;
  for (const auto& [end, count] : batch.ends) ends << QStringLiteral("%1 %2").arg(count).arg(end);
  const bool whole = batch.count() == batch.of;
  return {
      .name = whole
                  ? JobController::tr("%1 run in %2").arg(batch.of).arg(durationText(batch.seconds))
                  : JobController::tr("Stopped after %1 of %2").arg(batch.count()).arg(batch.of),
      .detail = ends.join(QStringLiteral(", ")),
      .step = whole ? Step::kShowBatch : Step::kRunRest};
}

}  // namespace

JobController::JobController(WindowParts& parts, ReviewController& review, JobStrip& strip,
                             QObject* parent)
    : QObject(parent),
      parts_(parts),
      review_(review),
      strip_(strip),
      escape_(new QShortcut(Qt::Key_Escape, &strip)) {
  connect(&strip_, &JobStrip::stopRequested, this, &JobController::stop);
  const auto refresh = [this] { update(); };
  connectEach(parts_.run, this, refresh, &RunController::stateChanged,
              &RunController::snapshotChanged);
  connect(&parts_.cases, &CaseController::batchChanged, this, refresh);
  parts_.state.onChange(ViewChange::kOtherCase, this, refresh);
  connectEach(parts_.document, this, refresh, &Document::opened, &Document::changed);
  connectEach(review_, this, refresh, &ReviewController::convergenceChanged,
              &ReviewController::checksChanged);
  connect(&parts_.tasks, &TaskRunner::busyChanged, this, refresh);
  connect(&parts_.sequence, &SequenceRunner::changed, this, refresh);
  connect(&parts_.exports, &ExportRunner::changed, this, refresh);
  connect(escape_, &QShortcut::activated, this, &JobController::stop);
  update();
}

Job JobController::runJob() const {
  const auto& trace = parts_.run.snapshot();
  const auto complete = trace ? trace->complete() : 0;
  const QString id = parts_.cases.caseId();
  const RunState state = parts_.run.state();
  if (state == RunState::kWorking)
    return {.name = tr("Running"),
            .detail = tr("%1, iteration %2").arg(id).arg(complete + 1),
            .runs = true};
  if (state == RunState::kHalted)
    return {.name = complete > 0 ? tr("Paused after iteration %1").arg(complete) : tr("Paused")};
  if (const auto& batch = parts_.cases.lastBatch()) return endedJob(*batch);
  if (state != RunState::kFinished || !trace) return {.name = tr("Ready")};
  return {.name = tr("Finished"),
          .detail = tr("%1: %2 iterations, %3 s")
                        .arg(id)
                        .arg(trace->iterations.size())
                        .arg(numberText(trace->seconds.total(), 2))};
}

Job JobController::job() const {
  if (const auto& batch = parts_.cases.batch()) {
    const QString iteration =
        batch->iteration > 0 ? tr(", iteration %1").arg(batch->iteration) : QString();
    return {.name = tr("Running all cases"),
            .detail = batch->case_id.isEmpty() ? QString() : batch->case_id + iteration,
            .done = batch->done,
            .of = batch->of,
            .seconds_left = batch->seconds_left,
            .runs = true};
  }
  const Job run = runJob();
  if (run.runs) return run;
  if (parts_.sequence.isRunning()) {
    const SequenceProgress& sequence = parts_.sequence.progress();
    return {
        .name = tr("Running a sequence"),
        .detail =
            tr("%1 frames/s, %2 lost").arg(numberText(sequence.frames_per_s, 1)).arg(sequence.lost),
        .done = static_cast<int>(sequence.done),
        .of = static_cast<int>(sequence.of),
        .runs = true};
  }
  if (review_.isConvergenceTestRunning())
    return {.name = tr("Convergence test"),
            .done = review_.convergenceSoFar().seeds,
            .of = sessions::kConvergenceSeeds,
            .runs = true};
  if (!parts_.exports.isBusy()) return run;
  const ExportJob& written = parts_.exports.job();
  return {.name = written.name,
          .detail = written.detail,
          .done = written.done,
          .of = written.of,
          .runs = true,
          .stops = false};
}

void JobController::update() {
  const Job next = job();
  if (!(next == strip_.job())) strip_.setJob(next);
  escape_->setEnabled(next.runs && next.stops);  // else it is the tools' and the panels'
  const Document& document = parts_.document;
  strip_.setSaved(!document.isOpen()       ? QString()
                  : document.isUntitled()  ? tr("Not saved yet")
                  : document.isModified()  ? tr("Changes not saved")
                  : !document.isEditable() ? tr("Read only")
                                           : tr("Saved"));
}

void JobController::stop() {
  parts_.sequence.stop();
  review_.stopConvergenceTest();
  parts_.cases.stop();  // reports failures of a batch, which waits for the operator
}

}  // namespace boresight::ui
