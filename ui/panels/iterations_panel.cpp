// SPDX-License-Identifier: Apache-2.0
#include "ui/panels/iterations_panel.h"

#include <cmath>

#include <QtWidgets>

#include "ui_iterations_panel.h"

#include "ui/panels/widgets.h"
#include "ui/plots/double_plot.h"

namespace boresight::ui {

IterationsPanel::IterationsPanel(ViewState& view, QWidget* parent)
    : QWidget(parent), view_(view), ui_(std::make_unique<Ui::IterationsPanel>()) {
  ui_->setupUi(this);
  scrubber_ = new RunScrubber(view_, this);
  ui_->column->insertWidget(1, scrubber_);
  buildTable();
  buildPlots();
  view_.onChange(ViewChange::kSnapshot, this, &IterationsPanel::showSnapshot);
  view_.onChange(ViewChange::kCursor, this, &IterationsPanel::showCursor);
  showSnapshot();
  showCursor();
}

IterationsPanel::~IterationsPanel() = default;

void IterationsPanel::buildTable() {
  setUpTable(*ui_->iterations, model_);
  connect(ui_->iterations->selectionModel(), &QItemSelectionModel::currentRowChanged, this,
          &IterationsPanel::chooseRow);
  auto* hint = new EmptyHint(*ui_->iterations, IterationsModel::rowOf(0));
  hint->setText(
      tr("Run the case to its end (F5), an iteration (F6) or a stage (F7) at a time: each "
         "iteration becomes a row here, and every view shows the chosen one."));
}

void IterationsPanel::buildPlots() {
  corrections_ = new DoublePlot({tr("moved, mm"), true}, {tr("turned, deg"), true});
  fit_ = new DoublePlot({tr("inliers"), true}, {tr("rms, px"), false});
  for (DoublePlot* plot : {corrections_, fit_}) {
    plot->setNames([this](int iteration) { return model_.iterationName(iteration); });
    ui_->plotRow->addWidget(plot);
    connect(plot, &DoublePlot::chosen, this, [this](int iteration) {
      view_.setCursor({iteration, Stage::kFinished});
    });
  }
}

QVector<QPointF> IterationsPanel::pointsOf(IterationsModel::Column column) const {
  QVector<QPointF> points;
  for (int i = 0; i < IterationsModel::iterationOf(model_.rowCount()); ++i) {
    const double value = model_.number(i, column);
    if (!std::isnan(value)) points.append({static_cast<double>(i), value});
  }
  return points;
}

void IterationsPanel::fillPlots() {
  const int count = std::max(0, IterationsModel::iterationOf(model_.rowCount()));
  corrections_->setPoints(count, pointsOf(IterationsModel::kTranslation_mm),
                          pointsOf(IterationsModel::kRotation_deg));
  fit_->setPoints(count, pointsOf(IterationsModel::kInliers), pointsOf(IterationsModel::kRms_px));
}

void IterationsPanel::showSnapshot() {
  showing_ = true;
  model_.setSnapshot(view_.snapshot());
  showing_ = false;
  ui_->runStatus->showRun(view_.snapshot().get());
  ui_->iterations->resizeColumnsToContents();
  ui_->plots->setVisible(model_.rowCount() > IterationsModel::rowOf(0));
  fillPlots();
}

void IterationsPanel::showCursor() {
  const int iteration = view_.cursor().iteration;
  showing_ = true;
  const QModelIndex row = model_.index(IterationsModel::rowOf(iteration), 0);
  ui_->iterations->setCurrentIndex(row);
  if (row.isValid()) ui_->iterations->scrollTo(row);
  showing_ = false;
  corrections_->setMarked(iteration);
  fit_->setMarked(iteration);
  const int count = std::max(0, IterationsModel::iterationOf(model_.rowCount()));
  const QString name = model_.iterationName(iteration);
  scrubber_->setPlace(iteration < 0 ? name
                                    : tr("%1 (%2 of %3)").arg(name).arg(iteration + 1).arg(count));
}

void IterationsPanel::chooseRow(const QModelIndex& current) {
  if (showing_ || !current.isValid()) return;
  view_.setCursor({IterationsModel::iterationOf(current.row()), Stage::kFinished});
}

}  // namespace boresight::ui
