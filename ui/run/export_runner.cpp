// SPDX-License-Identifier: Apache-2.0
#include "ui/run/export_runner.h"

namespace boresight::ui {

ExportRunner::ExportRunner(QObject* parent) : QObject(parent) {
  connect(&runner_, &TaskRunner::failed, this, &ExportRunner::failed);
}

/// Each has a key of its own: none replaces another.
void ExportRunner::add(const ExportJob& job, TaskRunner::Work work) {
  jobs_.push_back(job);
  runner_.run(QStringLiteral("export %1").arg(++count_),
              [this, work = std::move(work)](const std::stop_token& stop,
                                             const TaskRunner::Report& report) {
                try {
                  work(stop, report);
                } catch (...) {
                  report([this] { endFirst(); });
                  throw;
                }
                report([this] { endFirst(); });
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
