// SPDX-License-Identifier: Apache-2.0
#include "ui/workspaces/job_strip.h"

#include <cmath>

#include <QtWidgets>

#include "ui/style/icons.h"
#include "ui/widgets/widgets.h"

namespace boresight::ui {

QString durationText(double seconds) {
  return seconds < 90.0 ? JobStrip::tr("%1 s").arg(std::max(1.0, std::ceil(seconds)))
                        : JobStrip::tr("%1 min").arg(std::ceil(seconds / 60.0));
}

JobStrip::JobStrip(QWidget* parent) : QFrame(parent) {
  ui_.setupUi(this);
  setFixedHeight(kJobStripHeight);
  ui_.jobStop->setIcon(iconOf(Icon::kStop));
  for (QPushButton* each : {ui_.jobStop, ui_.jobStep}) each->setFixedHeight(kJobStripHeight - 6);
  connect(ui_.jobStop, &QPushButton::clicked, this, &JobStrip::stopRequested);
  connect(ui_.jobStep, &QPushButton::clicked, this, [this] { Q_EMIT stepRequested(job_.step); });
  setJob({.name = tr("Ready")});
}

void JobStrip::setJob(const Job& job) {
  job_ = job;
  ui_.runState->setText(job.name);
  ui_.jobProgress->setVisible(job.runs);
  ui_.jobProgress->setRange(0, job.of);  // without a count it moves to and fro
  ui_.jobProgress->setValue(job.done);
  ui_.jobCount->setVisible(job.runs && job.of > 0);
  ui_.jobCount->setText(tr("%1 of %2 done").arg(job.done).arg(job.of));
  ui_.jobLeft->setVisible(job.runs && job.seconds_left.has_value());
  ui_.jobLeft->setText(job.seconds_left ? tr("%1 left").arg(durationText(*job.seconds_left))
                                        : QString());
  ui_.jobStop->setVisible(job.runs && job.stops);
  showStep(*ui_.jobStep, job.step);
  ui_.jobStep->setVisible(job.step != Step::kNone);
  showDetail();
}

void JobStrip::setNote(const QString& note) {
  note_ = note;
  showDetail();
}

void JobStrip::setPlace(const QString& place) { ui_.place->setText(place); }
void JobStrip::setSaved(const QString& saved) { ui_.savedState->setText(saved); }

void JobStrip::showDetail() {
  const QString text = note_.isEmpty() ? job_.detail : note_;
  layout()->activate();
  ui_.jobDetail->setText(
      ui_.jobDetail->fontMetrics().elidedText(text, Qt::ElideRight, ui_.jobDetail->width()));
  ui_.jobDetail->setToolTip(text);
}

void JobStrip::resizeEvent(QResizeEvent* event) {
  QFrame::resizeEvent(event);
  showDetail();
}

}  // namespace boresight::ui
