// SPDX-License-Identifier: Apache-2.0
#include "ui/run/export_runner.h"

namespace boresight::ui {

void ExportRunner::add(const ExportJob& job, TaskRunner::Work work) {
  jobs_.push_back(job);
  runner_.queue(
      [this, work = std::move(work)](const std::stop_token& stop,
                                     const TaskRunner::Report& report) {
        work(stop, report);
        report([this] { endFirst(); });
      },
      [this](const QString& message) {
        endFirst();
        Q_EMIT failed(message);
      });
  Q_EMIT changed();
}

void ExportRunner::showProgress(int done, int of) {
  jobs_.front().done = done;
  jobs_.front().of = of;
  Q_EMIT changed();
}

void ExportRunner::endFirst() {
  jobs_.pop_front();
  Q_EMIT changed();
}

}  // namespace boresight::ui
