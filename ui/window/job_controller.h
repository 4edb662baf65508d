// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <QObject>
#include <QTimer>

#include "ui/window/window_parts.h"
#include "ui/workspaces/job_strip.h"

class QShortcut;

namespace boresight::ui {

class ReviewController;

/// Updates the job strip with the running jobs, and stops them.
class JobController : public QObject {
  Q_OBJECT

 public:
  JobController(WindowParts& parts, ReviewController& review, JobStrip& strip, QObject* parent);

  Job job() const;
  void update();
  /// Stops all jobs: a run, a batch (also between two cases), a sequence, a convergence test.
  void stop();

 private:
  Job runJob() const;

  WindowParts& parts_;
  ReviewController& review_;
  JobStrip& strip_;
  QShortcut* escape_;
};

}  // namespace boresight::ui
