// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <optional>

#include <QFrame>
#include <QString>

#include "ui_job_strip.h"

#include "ui/workspaces/step.h"

namespace boresight::ui {

/// The running job, or the last one.
struct Job {
  QString name;         ///< "Running all cases", "Ready"
  QString detail = {};  ///< "bc-000035, iteration 2"
  int done = 0;
  int of = 0;  ///< 0: nothing to count
  std::optional<double> seconds_left = {};
  bool runs = false;
  bool stops = true;        ///< on request, while it runs
  Step step = Step::kNone;  ///< offered while nothing runs

  bool operator==(const Job&) const = default;
};

/// "3 s", "2 min".
QString durationText(double seconds);

/// Strip below every workspace: the running job, its progress, and a Stop button; at the right the
/// position of the pointer and whether the session is saved.
class JobStrip : public QFrame {
  Q_OBJECT

 public:
  explicit JobStrip(QWidget* parent = nullptr);

  void setJob(const Job& job);
  const Job& job() const { return job_; }
  /// Shows a temporary remark instead of the detail.
  void setNote(const QString& note);
  void setPlace(const QString& place);
  void setSaved(const QString& saved);
  QPushButton& stop() { return *ui_.jobStop; }

 Q_SIGNALS:
  void stopRequested();
  void stepRequested(boresight::ui::Step step);

 protected:
  void resizeEvent(QResizeEvent* event) override;

 private:
  void showDetail();

  Job job_;
  QString note_;
  Ui::JobStrip ui_;
};

}  // namespace boresight::ui
