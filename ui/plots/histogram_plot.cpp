// SPDX-License-Identifier: Apache-2.0
#include "ui/plots/histogram_plot.h"

#include <numeric>

#include <QEvent>
#include <QFrame>
#include <QVBoxLayout>

#include <qwt_legend.h>
#include <qwt_plot.h>
#include <qwt_plot_grid.h>
#include <qwt_plot_histogram.h>
#include <qwt_plot_marker.h>
#include <qwt_samples.h>
#include <qwt_text.h>

#include "ui/plots/plot_colors.h"

namespace boresight::ui {
namespace {

QVector<QwtIntervalSample> samplesOf(double radius, const QVector<int>& counts) {
  QVector<QwtIntervalSample> samples;
  const double width = counts.isEmpty() ? 0.0 : 2.0 * radius / static_cast<double>(counts.size());
  for (int i = 0; i < counts.size(); ++i) {
    const double from = -radius + i * width;
    samples.append(QwtIntervalSample(counts[i], from, from + width));
  }
  return samples;
}

}  // namespace

HistogramPlot::HistogramPlot(const QString& axis_title, const QString& all_title,
                             const QString& part_title, QWidget* parent)
    : QWidget(parent), axis_title_(axis_title) {
  plot_ = new QwtPlot(this);
  plot_->setMinimumSize(180, 110);
  auto* layout = new QVBoxLayout(this);
  layout->setContentsMargins(0, 0, 0, 0);
  layout->addWidget(plot_);
  plot_->insertLegend(new QwtLegend, QwtPlot::TopLegend);
  if (auto* frame = qobject_cast<QFrame*>(plot_->canvas())) frame->setFrameShape(QFrame::NoFrame);
  grid_ = new QwtPlotGrid;
  grid_->enableX(false);
  grid_->attach(plot_);
  all_ = new QwtPlotHistogram(all_title);
  part_ = new QwtPlotHistogram(part_title);
  all_->attach(plot_);
  part_->attach(plot_);
  zero_ = new QwtPlotMarker;
  zero_->setLineStyle(QwtPlotMarker::VLine);
  zero_->setXValue(0.0);
  zero_->attach(plot_);
  applyPalette();
}

void HistogramPlot::setCounts(double radius, const QVector<int>& all, const QVector<int>& part) {
  all_count_ = std::accumulate(all.begin(), all.end(), 0);
  all_->setSamples(samplesOf(radius, all));
  part_->setSamples(samplesOf(radius, part));
  plot_->setAxisScale(QwtPlot::xBottom, -radius, radius);
  plot_->replot();
}

void HistogramPlot::applyPalette() {
  const PlotColors colors = plotColors(palette());
  plot_->setCanvasBackground(palette().brush(QPalette::Base));
  grid_->setPen(colors.grid, 0.0, Qt::DotLine);
  zero_->setLinePen(colors.cursor, 1.0, Qt::DashLine);
  all_->setPen(colors.second, 1.2);
  all_->setBrush(QBrush(colors.second, Qt::BDiagPattern));
  part_->setPen(QPen(Qt::NoPen));
  part_->setBrush(colors.first);
  QwtText title(axis_title_);
  title.setFont(font());
  plot_->setAxisTitle(QwtPlot::xBottom, title);
  for (const int axis : {QwtPlot::xBottom, QwtPlot::yLeft}) plot_->setAxisFont(axis, font());
  plot_->replot();
}

void HistogramPlot::changeEvent(QEvent* event) {
  QWidget::changeEvent(event);
  const bool look = event->type() == QEvent::PaletteChange || event->type() == QEvent::FontChange;
  if (look && zero_ != nullptr) applyPalette();
}

}  // namespace boresight::ui
