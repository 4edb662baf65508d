// SPDX-License-Identifier: Apache-2.0
#include "ui/workspaces/result_panel.h"

#include <QtWidgets>

#include "core/base/math.h"
#include "sessions/text/text_table.h"
#include "sessions/trace/acceptance.h"
#include "ui/models/text.h"
#include "ui/review/quality_controller.h"
#include "ui/state/view_state.h"
#include "ui/style/theme.h"
#include "ui/widgets/limit_bar.h"
#include "ui/widgets/widgets.h"

namespace boresight::ui {
namespace {

constexpr int kNeededLines = 2;  ///< their room is kept, so that nothing below moves

}  // namespace

ResultPanel::ResultPanel(ViewState& state, QualityController& quality, QWidget* parent)
    : QWidget(parent),
      state_(state),
      quality_(quality),
      rejected_(named(new QLabel, "rejectedPose")),
      heading_(new QLabel(tr("Camera from station"))),
      pose_(named(new QTableWidget(2, 4), "resultPose")) {
  auto* figures = new QHBoxLayout;
  figures->setSpacing(16);
  agreement_ = addFigure(*figures);
  precision_ = addFigure(*figures);
  styleTable(*pose_);
  pose_->setAlternatingRowColors(false);
  pose_->setSelectionMode(QAbstractItemView::NoSelection);
  pose_->setFocusPolicy(Qt::NoFocus);
  pose_->setHorizontalHeaderLabels({QString(), tr("x"), tr("y"), tr("z")});
  for (int column = 1; column < pose_->columnCount(); ++column)
    pose_->horizontalHeaderItem(column)->setTextAlignment(Qt::AlignRight | Qt::AlignVCenter);
  pose_->horizontalHeader()->setSectionResizeMode(QHeaderView::Stretch);
  pose_->horizontalHeader()->setSectionResizeMode(0, QHeaderView::ResizeToContents);
  pose_->setMinimumWidth(kNarrow.run_side - 24);  // of whole numbers
  rejected_->setText(tr("✗ Rejected: this pose is not a result."));
  auto* column = new QVBoxLayout(this);
  column->addLayout(figures);
  column->addWidget(rejected_);
  column->addWidget(heading_);
  column->addWidget(pose_, 1);
  state_.onChange(ViewChange::kSnapshot | ViewChange::kCase | ViewChange::kCursor, this,
                  &ResultPanel::showRun);
  connect(&quality_, &QualityController::changed, this, &ResultPanel::showQuality);
  showRun();
}

ResultPanel::Figure ResultPanel::addFigure(QHBoxLayout& row) {
  Figure figure{new QLabel, new QLabel, new LimitBar, new QLabel};
  QFont large = font();
  large.setPointSizeF(kHeadlineSize);
  large.setBold(true);
  figure.value->setFont(large);
  figure.needed->setWordWrap(true);
  figure.needed->setAlignment(Qt::AlignLeft | Qt::AlignTop);
  figure.needed->setMinimumHeight(kNeededLines * fontMetrics().lineSpacing());
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
  showQuality();
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
  agreement_.value->setText(probable ? fromText(sessions::probabilityPercent(run->probability))
                                     : tr("%1 %").arg(numberText(value, 1)));
  agreement_.needed->setText(tr("needed: %1 % or more").arg(numberText(needed, 1)));
  agreement_.bar->setFigure(value, needed, value >= needed);
}

void ResultPanel::showQuality() {
  const auto& quality = quality_.quality();
  precision_.name->setText(tr("Pose known to"));
  precision_.value->setText(QStringLiteral("–"));
  precision_.needed->clear();
  precision_.bar->clear();
  if (!quality) return;
  const sessions::PrecisionFigure* worst = quality->worst();
  precision_.needed->setText(fromText(
      worst ? quality->sigmasText() + " " + worst->where + worst->place : quality->text()));
  if (!worst) return;
  precision_.value->setText(fromText(worst->text()));
  precision_.bar->setFigure(*worst->found, *worst->required, worst->holds());
  QStringList all;
  for (const sessions::PrecisionFigure& figure : quality->figures)
    if (figure.judged()) all << fromText(figure.text() + " " + figure.where + figure.place);
  precision_.needed->setToolTip(all.join(QLatin1Char('\n')));
}

/// A run that ended without a result has a pose nonetheless: of its last iteration.
void ResultPanel::showPose() {
  const auto run = state_.snapshot();
  const auto pose = poseOf(state_, state_.iteration() ? PoseRole::kEstimate : PoseRole::kSeed);
  const bool rejected = run && run->finished && !run->converged() && state_.iteration();
  rejected_->setVisible(rejected);
  heading_->setVisible(!rejected);  // one line in either case: nothing below moves
  pose_->setEnabled(!rejected);
  pose_->setVisible(pose.has_value());
  if (!pose) return;
  const auto row = [this](int index, const QString& name, const Eigen::Vector3d& values) {
    const auto cell = [&](int column, const QString& text) {
      auto* item = new QTableWidgetItem(text);
      item->setTextAlignment(
          static_cast<int>((column > 0 ? Qt::AlignRight : Qt::AlignLeft) | Qt::AlignVCenter));
      pose_->setItem(index, column, item);
    };
    cell(0, name);
    for (int i = 0; i < 3; ++i) cell(i + 1, numberText(values[i], 3));
  };
  row(0, tr("Position, mm"), 1e3 * pose->translation_m);
  row(1, tr("Rotation, deg"), rotationLog(pose->rotation) / kDegree_rad);
}

}  // namespace boresight::ui
