// SPDX-License-Identifier: Apache-2.0
#include "ui/panels/iterations_panel.h"

#include <cmath>

#include <QtWidgets>

#include "ui/panels/banner.h"
#include "ui/panels/widgets.h"
#include "ui/plots/double_plot.h"

namespace boresight::ui {

IterationsPanel::IterationsPanel(ViewState& view, QWidget* parent) : QWidget(parent), view_(view) {
  auto* column = new QVBoxLayout(this);
  column->setContentsMargins(4, 4, 4, 4);
  banner_ = new Banner(QStringLiteral("standing"), this);
  column->addWidget(banner_);
  scrubber_ = new RunScrubber(view_, this);
  column->addWidget(scrubber_);
  auto* splitter = new QSplitter(Qt::Horizontal, this);
  buildTable();
  splitter->addWidget(table_);
  plots_ = buildPlots();
  splitter->addWidget(plots_);
  splitter->setStretchFactor(0, 1);
  splitter->setStretchFactor(1, 1);
  splitter->setChildrenCollapsible(false);
  column->addWidget(splitter, 1);

  view_.onChange(ViewChange::kSnapshot, this, &IterationsPanel::showSnapshot);
  view_.onChange(ViewChange::kCursor, this, &IterationsPanel::showCursor);
  showSnapshot();
  showCursor();
}

void IterationsPanel::buildTable() {
  table_ = newTable("iterations", tr("Iterations"), model_, this);
  connect(table_->selectionModel(), &QItemSelectionModel::currentRowChanged, this,
          &IterationsPanel::chooseRow);
  auto* hint = new EmptyHint(*table_, IterationsModel::rowOf(0));
  hint->setText(
      tr("Run the case to its end (F5), an iteration (F6) or a stage (F7) at a time: each "
         "iteration becomes a row here, and every view shows the chosen one."));
}

QWidget* IterationsPanel::buildPlots() {
  auto* plots = new QWidget(this);
  auto* row = new QHBoxLayout(plots);
  row->setContentsMargins(0, 0, 0, 0);
  corrections_ = new DoublePlot({tr("moved, mm"), true}, {tr("turned, deg"), true});
  fit_ = new DoublePlot({tr("inliers"), true}, {tr("rms, px"), false});
  for (DoublePlot* plot : {corrections_, fit_}) {
    plot->setNames([this](int iteration) { return model_.iterationName(iteration); });
    row->addWidget(plot);
    connect(plot, &DoublePlot::chosen, this, [this](int iteration) {
      view_.setCursor({iteration, Stage::kFinished});
    });
  }
  return plots;
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
  banner_->showRun(view_.snapshot().get());
  table_->resizeColumnsToContents();
  plots_->setVisible(model_.rowCount() > IterationsModel::rowOf(0));
  fillPlots();
}

void IterationsPanel::showCursor() {
  const int iteration = view_.cursor().iteration;
  showing_ = true;
  const QModelIndex row = model_.index(IterationsModel::rowOf(iteration), 0);
  table_->setCurrentIndex(row);
  if (row.isValid()) table_->scrollTo(row);
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

void IterationsPanel::changeEvent(QEvent* event) {
  QWidget::changeEvent(event);
  if (event->type() == QEvent::PaletteChange && banner_ != nullptr)
    banner_->showRun(view_.snapshot().get());
}

}  // namespace boresight::ui
