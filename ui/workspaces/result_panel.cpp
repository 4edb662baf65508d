// SPDX-License-Identifier: Apache-2.0
#include "ui/workspaces/result_panel.h"

#include <algorithm>
#include <cmath>

#include <QtWidgets>

#include "core/base/math.h"
#include "sessions/run/acceptance.h"
#include "ui/models/text.h"
#include "ui/panels/widgets.h"
#include "ui/state/view_state.h"
#include "ui/style/theme.h"

namespace boresight::ui {

void LimitBar::setFigure(double value, double limit, bool passed) {
  value_ = value;
  limit_ = limit;
  passed_ = passed;
  update();
}

void LimitBar::clear() { setFigure(0.0, 0.0, false); }

void LimitBar::paintEvent(QPaintEvent*) {
  QPainter painter(this);
  painter.setRenderHint(QPainter::Antialiasing);
  const QRectF track(0, (height() - 6) / 2.0, width(), 6);
  painter.setPen(Qt::NoPen);
  painter.setBrush(QColor(theme().line));
  painter.drawRoundedRect(track, 3, 3);
  if (limit_ <= 0.0) return;
  const double end = std::max(value_, 2.0 * limit_);
  QRectF bar = track;
  bar.setWidth(track.width() * std::clamp(value_ / end, 0.0, 1.0));
  painter.setBrush(QColor(passed_ ? theme().success : theme().failure));
  painter.drawRoundedRect(bar, 3, 3);
  const double tick = track.width() * limit_ / end;
  painter.fillRect(QRectF(tick - 1, 0, 2, height()), QColor(theme().text));
}

ResultPanel::ResultPanel(ViewState& state, QWidget* parent)
    : QWidget(parent), state_(state), pose_(named(new QTableWidget(4, 4), "resultPose")) {
  auto* figures = new QHBoxLayout;
  figures->setSpacing(16);
  agreement_ = addFigure(*figures);
  sigma_ = addFigure(*figures);
  styleTable(*pose_);
  pose_->setAlternatingRowColors(false);
  pose_->setSelectionMode(QAbstractItemView::NoSelection);
  pose_->setFocusPolicy(Qt::NoFocus);
  pose_->setHorizontalHeaderLabels({tr("Camera from station"), tr("x"), tr("y"), tr("z")});
  pose_->horizontalHeader()->setSectionResizeMode(QHeaderView::Stretch);
  pose_->horizontalHeader()->setSectionResizeMode(0, QHeaderView::ResizeToContents);
  auto* column = new QVBoxLayout(this);
  column->setContentsMargins(12, 8, 12, 8);
  column->setSpacing(8);
  column->addLayout(figures);
  column->addWidget(pose_, 1);
  state_.onChange(ViewChange::kSnapshot | ViewChange::kCase | ViewChange::kCursor, this,
                  &ResultPanel::showRun);
  showRun();
}

ResultPanel::Figure ResultPanel::addFigure(QHBoxLayout& row) {
  Figure figure{new QLabel, new QLabel, new LimitBar, new QLabel};
  QFont large = font();
  large.setPointSizeF(kHeadlineSize);
  large.setBold(true);
  figure.value->setFont(large);
  auto* column = new QVBoxLayout;
  column->setSpacing(2);
  for (QWidget* each :
       std::initializer_list<QWidget*>{figure.name, figure.value, figure.bar, figure.needed})
    column->addWidget(each);
  column->addStretch(1);
  row.addLayout(column, 1);
  return figure;
}

void ResultPanel::showRun() {
  showAgreement();
  showSigma();
  showPose();
}

void ResultPanel::showAgreement() {
  const auto run = state_.snapshot();
  agreement_.name->setText(tr("Edges that agree"));
  agreement_.value->setText(QStringLiteral("–"));
  agreement_.needed->clear();
  agreement_.bar->clear();
  if (!run || !run->finished || run->iterations.empty()) return;
  const auto& limits = run->lastOptions().support;
  const bool probable = sessions::hasProbability(*run);
  const double value = 100.0 * (probable ? run->probability : run->support.share());
  const double needed = 100.0 * (probable ? limits.min_probability : limits.min_support);
  if (probable) agreement_.name->setText(tr("Probability of the pose"));
  agreement_.value->setText(tr("%1 %").arg(numberText(value, 1)));
  agreement_.needed->setText(tr("needed: %1 % or more").arg(numberText(needed, 1)));
  agreement_.bar->setFigure(value, needed, value >= needed);
}

void ResultPanel::showSigma() {
  const auto run = state_.snapshot();
  sigma_.name->setText(tr("Position, 1 sigma at the camera"));
  sigma_.name->setToolTip(tr("Worst axis, by the image alone"));
  sigma_.value->setText(QStringLiteral("–"));
  sigma_.needed->clear();
  sigma_.bar->clear();
  if (!run || !run->converged()) return;
  const double value_mm = 1e3 * std::sqrt(run->covariance.diagonal().tail<3>().maxCoeff());
  sigma_.value->setText(tr("%1 mm").arg(numberText(value_mm, 3)));
  const auto& requirement = state_.currentCase()->source.requirement;
  if (!requirement || !requirement->lateral_mm) return;
  const double allowed_mm = *requirement->lateral_mm;
  sigma_.needed->setText(tr("allowed: %1 mm or less").arg(numberText(allowed_mm, 3)));
  sigma_.bar->setFigure(value_mm, allowed_mm, value_mm <= allowed_mm);
}

void ResultPanel::showPose() {
  const auto run = state_.snapshot();
  const auto pose = poseOf(state_, state_.iteration() ? PoseRole::kEstimate : PoseRole::kSeed);
  pose_->setVisible(pose.has_value());
  if (!pose) return;
  const auto row = [this](int index, const QString& name, const Eigen::Vector3d& values) {
    const auto cell = [&](int column, const QString& text) {
      auto* item = new QTableWidgetItem(text);
      item->setTextAlignment((column > 0 ? Qt::AlignRight : Qt::AlignLeft) | Qt::AlignVCenter);
      pose_->setItem(index, column, item);
    };
    cell(0, name);
    for (int i = 0; i < 3; ++i) cell(i + 1, numberText(values[i], 3));
  };
  const bool converged = run && run->converged();
  const Vector6d sigma = converged ? Vector6d(run->covariance.diagonal().cwiseMax(0.0).cwiseSqrt())
                                   : Vector6d::Zero();
  pose_->setRowCount(0);
  pose_->setRowCount(converged ? 4 : 2);
  int next = 0;
  row(next++, tr("Position, mm"), 1e3 * pose->translation_m);
  if (converged) row(next++, tr("1 sigma, mm"), 1e3 * sigma.tail<3>());
  row(next++, tr("Rotation, deg"), rotationLog(pose->rotation) / kDegree_rad);
  if (converged) row(next++, tr("1 sigma, mrad"), 1e3 * sigma.head<3>());
}

}  // namespace boresight::ui
