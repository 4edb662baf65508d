// SPDX-License-Identifier: Apache-2.0
#include "ui/workspaces/result_panel.h"

#include <QtWidgets>

#include "core/base/math.h"
#include "sessions/text/text_table.h"
#include "sessions/trace/run_text.h"
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
    : QWidget(parent), state_(state), quality_(quality) {
  ui_.setupUi(this);
  agreement_ = {ui_.agreementName, ui_.agreementValue, ui_.agreementBar, ui_.agreementNeeded};
  precision_ = {ui_.precisionName, ui_.precisionValue, ui_.precisionBar, ui_.precisionNeeded};
  for (const Figure& figure : {agreement_, precision_}) setUpFigure(figure);
  ui_.resultPose->setColumnCount(4);
  styleTable(*ui_.resultPose);
  ui_.resultPose->setAlternatingRowColors(false);
  ui_.resultPose->setSelectionMode(QAbstractItemView::NoSelection);
  ui_.resultPose->setHorizontalHeaderLabels({QString(), tr("x"), tr("y"), tr("z")});
  ui_.resultPose->horizontalHeader()->setSectionResizeMode(QHeaderView::Stretch);
  ui_.resultPose->horizontalHeader()->setSectionResizeMode(0, QHeaderView::ResizeToContents);
  ui_.resultPose->setMinimumWidth(kNarrow.run_side - 24);  // of whole numbers
  state_.onChange(ViewChange::kSnapshot | ViewChange::kCase | ViewChange::kCursor, this,
                  &ResultPanel::showRun);
  connect(&quality_, &QualityController::changed, this, &ResultPanel::showQuality);
  showRun();
}

void ResultPanel::setUpFigure(const Figure& figure) {
  QFont large = font();
  large.setPointSizeF(kHeadlineSize);
  large.setBold(true);
  figure.value->setFont(large);
  figure.needed->setMinimumHeight(kNeededLines * fontMetrics().lineSpacing());
}

void ResultPanel::clear(const Figure& figure, const QString& name) {
  figure.name->setText(name);
  figure.value->setText(QStringLiteral("–"));
  figure.needed->clear();
  figure.bar->clear();
}

void ResultPanel::showRun() {
  showAgreement();
  showQuality();
  showPose();
}

void ResultPanel::showAgreement() {
  const auto run = state_.snapshot();
  clear(agreement_, tr("Edges that agree"));
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
  clear(precision_, tr("Pose known to"));
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
  ui_.rejectedPose->setVisible(rejected);
  ui_.poseHeading->setVisible(!rejected);  // one line in either case: nothing below moves
  ui_.resultPose->setEnabled(!rejected);
  ui_.resultPose->setVisible(pose.has_value());
  if (!pose) return;
  ui_.resultPose->setRowCount(0);
  const auto add = [this](const QString& name, const Eigen::Vector3d& values) {
    addRow(*ui_.resultPose,
           {name, numberText(values.x(), 3), numberText(values.y(), 3), numberText(values.z(), 3)});
  };
  add(tr("Position, mm"), 1e3 * pose->translation_m);
  add(tr("Rotation, deg"), rotationLog(pose->rotation) / kDegree_rad);
}

}  // namespace boresight::ui
