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
#include "ui/window/case_controller.h"

namespace boresight::ui {

namespace {

/// "51 run in 65 s: 50 converged, 1 rejected", with the way to them; of a stopped batch to the
/// rest.
Job endedJob(const BatchSummary& batch) {
  QStringList ends;
  for (const auto& [end, count] : batch.ends) ends << QStringLiteral("%1 %2").arg(count).arg(end);
  const bool whole = batch.count() == batch.of;
  Job job;
  job.name = whole
                 ? JobController::tr("%1 run in %2").arg(batch.of).arg(durationText(batch.seconds))
                 : JobController::tr("Stopped after %1 of %2").arg(batch.count()).arg(batch.of);
  job.detail = ends.join(QStringLiteral(", "));
  job.step = whole ? Step::kShowBatch : Step::kRunRest;
  return job;
}

}  // namespace

JobController::JobController(const WindowParts& parts, ReviewController& review, JobStrip& strip,
                             QObject* parent)
    : QObject(parent),
      parts_(parts),
      review_(review),
      strip_(strip),
      escape_(new QShortcut(Qt::Key_Escape, &strip)) {
  connect(&strip_, &JobStrip::stopRequested, this, &JobController::stop);
  connect(&parts_.run, &RunController::stateChanged, this, &JobController::update);
  connect(&parts_.run, &RunController::snapshotChanged, this, &JobController::update);
  connect(&parts_.cases, &CaseController::batchChanged, this, &JobController::update);
  connect(&parts_.cases, &CaseController::caseChosen, this, &JobController::update);
  connect(&parts_.tasks, &TaskRunner::busyChanged, this, &JobController::update);
  connect(&parts_.document, &Document::opened, this, &JobController::update);
  connect(&parts_.document, &Document::changed, this, &JobController::update);
  connect(&parts_.sequence, &SequenceRunner::changed, this, &JobController::update);
  connect(&parts_.exports, &ExportRunner::changed, this, &JobController::update);
  connect(&review_, &ReviewController::convergenceChanged, this, &JobController::update);
  connect(&review_, &ReviewController::checksChanged, this, &JobController::update);
  connect(escape_, &QShortcut::activated, this, &JobController::stop);
  update();
}

Job JobController::runJob() const {
  Job job;
  job.runs = parts_.run.state() == RunState::kWorking;
  const auto& trace = parts_.run.snapshot();
  const QString id = parts_.cases.caseId();
  if (job.runs) {
    job.name = tr("Running");
    const auto iteration = trace ? trace->complete() + 1 : 1;
    job.detail = tr("%1, iteration %2").arg(id).arg(iteration);
  } else if (parts_.run.state() == RunState::kHalted) {
    const auto complete = trace ? trace->complete() : 0;
    job.name = complete > 0 ? tr("Paused after iteration %1").arg(complete) : tr("Paused");
  } else if (const auto& batch = parts_.cases.lastBatch()) {
    return endedJob(*batch);
  } else if (parts_.run.state() == RunState::kFinished && trace) {
    job.name = tr("Finished");
    job.detail = tr("%1: %2 iterations, %3 s")
                     .arg(id)
                     .arg(trace->iterations.size())
                     .arg(numberText(trace->seconds.total(), 2));
  } else {
    job.name = tr("Ready");
  }
  return job;
}

Job JobController::job() const {
  if (const auto& batch = parts_.cases.batch()) {
    Job job{tr("Running all cases"), {}, batch->done, batch->of, batch->seconds_left, true};
    if (!batch->case_id.isEmpty())
      job.detail = batch->iteration > 0
                       ? tr("%1, iteration %2").arg(batch->case_id).arg(batch->iteration)
                       : batch->case_id;
    return job;
  }
  const Job run = runJob();
  if (!run.runs && parts_.sequence.isRunning()) {
    const SequenceProgress& sequence = parts_.sequence.progress();
    return {tr("Running a sequence"),
            tr("%1 frames/s, %2 lost").arg(numberText(sequence.frames_per_s, 1)).arg(sequence.lost),
            static_cast<int>(sequence.done),
            static_cast<int>(sequence.of),
            std::nullopt,
            true};
  }
  if (run.runs) return run;
  if (review_.isConvergenceTestRunning())
    return {tr("Convergence test"),      {},           review_.convergenceSoFar().seeds,
            sessions::kConvergenceSeeds, std::nullopt, true};
  if (!parts_.exports.isBusy()) return run;
  const ExportJob& written = parts_.exports.job();
  Job job{written.name, written.detail, written.done, written.of, std::nullopt, true};
  job.stops = false;
  return job;
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
  parts_.cases.stop();
  parts_.sequence.stop();
  review_.stopConvergenceTest();
}

}  // namespace boresight::ui
