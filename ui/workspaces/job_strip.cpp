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

JobStrip::JobStrip(QWidget* parent)
    : QFrame(parent),
      name_(named(new QLabel, "runState")),
      progress_(named(new QProgressBar, "jobProgress")),
      count_(named(new QLabel, "jobCount")),
      left_(named(new QLabel, "jobLeft")),
      stop_(named(new QPushButton(iconOf(Icon::kStop), tr("Stop")), "jobStop",
                  tr("Stop all jobs, also between two cases of a batch (Esc, F8)"))),
      step_(named(new QPushButton, "jobStep")),
      detail_(named(new QLabel, "jobDetail")),
      place_(named(new QLabel, "place")),
      saved_(named(new QLabel, "savedState")) {
  setObjectName(QStringLiteral("jobStrip"));
  setFixedHeight(kJobStripHeight);
  progress_->setTextVisible(false);
  progress_->setFixedWidth(120);
  progress_->setFixedHeight(6);
  for (QPushButton* each : {stop_, step_}) each->setFixedHeight(kJobStripHeight - 6);
  detail_->setSizePolicy(QSizePolicy::Ignored, QSizePolicy::Preferred);
  auto* row = new QHBoxLayout(this);
  row->setContentsMargins(12, 0, 12, 0);
  row->setSpacing(12);
  for (QWidget* each : std::initializer_list<QWidget*>{name_, progress_, count_, left_, stop_})
    row->addWidget(each);
  row->addWidget(detail_, 1);
  row->addWidget(step_);
  row->addWidget(place_);
  row->addWidget(saved_);
  connect(stop_, &QPushButton::clicked, this, &JobStrip::stopRequested);
  connect(step_, &QPushButton::clicked, this, [this] { Q_EMIT stepRequested(job_.step); });
  setJob({tr("Ready"), {}, 0, 0, std::nullopt, false});
}

void JobStrip::setJob(const Job& job) {
  job_ = job;
  name_->setText(job.name);
  progress_->setVisible(job.runs);
  progress_->setRange(0, job.of);  // without a count it moves to and fro
  progress_->setValue(job.done);
  count_->setVisible(job.runs && job.of > 0);
  count_->setText(tr("%1 of %2 done").arg(job.done).arg(job.of));
  left_->setVisible(job.runs && job.seconds_left.has_value());
  left_->setText(job.seconds_left ? tr("%1 left").arg(durationText(*job.seconds_left)) : QString());
  stop_->setVisible(job.runs && job.stops);
  const StepInfo& info = stepInfo(job.step);
  step_->setText(QCoreApplication::translate("Step", info.text));
  step_->setToolTip(QCoreApplication::translate("Step", info.help));
  step_->setIcon(iconOf(info.icon));
  step_->setVisible(job.step != Step::kNone);
  showDetail();
}

void JobStrip::setNote(const QString& note) {
  note_ = note;
  showDetail();
}

void JobStrip::setPlace(const QString& place) { place_->setText(place); }
void JobStrip::setSaved(const QString& saved) { saved_->setText(saved); }

void JobStrip::showDetail() {
  const QString text = note_.isEmpty() ? job_.detail : note_;
  layout()->activate();
  detail_->setText(detail_->fontMetrics().elidedText(text, Qt::ElideRight, detail_->width()));
  detail_->setToolTip(text);
}

void JobStrip::resizeEvent(QResizeEvent* event) {
  QFrame::resizeEvent(event);
  showDetail();
}

}  // namespace boresight::ui
