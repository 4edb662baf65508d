// SPDX-License-Identifier: Apache-2.0
#include "ui/plots/plots.h"

#include <algorithm>
#include <cmath>
#include <numeric>
#include <utility>

#include <QEvent>
#include <QFrame>
#include <QMouseEvent>
#include <QVBoxLayout>

#include <qwt_plot.h>
#include <qwt_plot_curve.h>
#include <qwt_plot_grid.h>
#include <qwt_plot_histogram.h>
#include <qwt_plot_layout.h>
#include <qwt_plot_marker.h>
#include <qwt_samples.h>
#include <qwt_scale_draw.h>
#include <qwt_scale_engine.h>
#include <qwt_symbol.h>
#include <qwt_text.h>
#include <qwt_text_label.h>

namespace boresight::ui {

class NamedScale : public QwtScaleDraw {
 public:
  explicit NamedScale(std::function<QString(int)> name_of) : name_of_(std::move(name_of)) {}
  QwtText label(double value) const override {
    return QwtText(name_of_(static_cast<int>(std::lround(value))));
  }
  /// The names have changed; the scale keeps them by value.
  void forgetNames() { invalidateCache(); }

 private:
  std::function<QString(int)> name_of_;
};

namespace {

constexpr double kSmallest = 1e-6;
constexpr int kMostTicks = 3;  // more overprint each other in a drawer

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

Plot::Plot(int least_height_px)
    : plot_(new QwtPlot(this)), grid_(new QwtPlotGrid), marker_(new QwtPlotMarker) {
  plot_->setMinimumSize(180, least_height_px);
  auto* layout = new QVBoxLayout(this);
  layout->setContentsMargins(0, 0, 0, 0);
  layout->addWidget(plot_);
  if (auto* frame = qobject_cast<QFrame*>(plot_->canvas())) frame->setFrameShape(QFrame::NoFrame);
  grid_->enableX(false);
  grid_->attach(plot_);
  marker_->setLineStyle(QwtPlotMarker::VLine);
  marker_->attach(plot_);
}

void Plot::applyPalette() {
  const PlotColors colors = plotColors(palette());
  plot_->setCanvasBackground(palette().brush(QPalette::Base));
  grid_->setPen(colors.grid, 0.0, Qt::DotLine);
  for (const int axis : {QwtPlot::xBottom, QwtPlot::yLeft, QwtPlot::yRight})
    plot_->setAxisFont(axis, font());
  applyColors(colors);
  plot_->replot();
}

void Plot::nameQuantities(const Quantity& first, const Quantity& second) {
  const auto html = [](const Quantity& quantity) {
    return QStringLiteral("<span style='color:%1'>%2 %3</span>")
        .arg(quantity.color.name(), quantity.sign, quantity.name.toHtmlEscaped());
  };
  QwtText title(html(first) + QStringLiteral("&nbsp;&nbsp;&nbsp;") + html(second),
                QwtText::RichText);
  plot_->titleLabel()->setFont(font());  // Qwt's own is large and bold
  plot_->setTitle(title);
}

void Plot::changeEvent(QEvent* event) {
  QWidget::changeEvent(event);
  if (event->type() == QEvent::PaletteChange || event->type() == QEvent::FontChange) applyPalette();
  // A new style sheet gives the canvas its former colours back after this event.
  if (event->type() == QEvent::StyleChange)
    QMetaObject::invokeMethod(this, &Plot::applyPalette, Qt::QueuedConnection);
}

DoublePlot::DoublePlot(const Series& left, const Series& right) : Plot(90) {
  plot_->setAxisMaxMinor(QwtPlot::xBottom, 0);
  plot_->canvas()->installEventFilter(this);
  plot_->canvas()->setCursor(Qt::PointingHandCursor);
  plot_->canvas()->setToolTip(tr("Click to go to an iteration."));
  addCurve(left_, left, QwtPlot::yLeft);
  addCurve(right_, right, QwtPlot::yRight);
  applyPalette();
  setPoints(0, {}, {});
  setMarked(-1);
}

void DoublePlot::addCurve(Curve& curve, const Series& series, int axis) {
  curve.series = series;
  curve.axis = axis;
  curve.curve = new QwtPlotCurve(series.title);
  curve.curve->setRenderHint(QwtPlotItem::RenderAntialiased);
  curve.curve->setAxes(QwtPlot::xBottom, axis);
  curve.curve->attach(plot_);
  plot_->enableAxis(axis);
  plot_->setAxisMaxMajor(axis, kMostTicks);
  if (series.logarithmic) plot_->setAxisScaleEngine(axis, new QwtLogScaleEngine);
}

void DoublePlot::setNames(std::function<QString(int)> name_of) {
  names_ = new NamedScale(std::move(name_of));
  plot_->setAxisScaleDraw(QwtPlot::xBottom, names_);  // which owns it
}

void DoublePlot::setPoints(int place_count, const QVector<QPointF>& left,
                           const QVector<QPointF>& right) {
  place_count_ = place_count;
  fill(left_, left);
  fill(right_, right);
  nameIterations();
  plot_->replot();
}

/// As many names as fit in a row.
void DoublePlot::nameIterations() {
  if (names_) names_->forgetNames();
  const int last = std::max(0, place_count_ - 1);
  const QString widest =
      (names_ ? names_->label(last).text() : QString::number(last)) + QLatin1Char(' ');
  const int name_px = fontMetrics().horizontalAdvance(widest);
  const double most = std::max(1, plot_->canvas()->width() / name_px);
  const double step = std::max(1.0, std::ceil(place_count_ / most));
  plot_->setAxisScale(QwtPlot::xBottom, -0.4, std::max(1, place_count_) - 0.6, step);
}

void DoublePlot::fill(Curve& curve, const QVector<QPointF>& points) {
  QVector<QPointF> drawn = points;
  if (curve.series.logarithmic)
    for (QPointF& point : drawn) point.setY(std::max(point.y(), kSmallest));
  curve.curve->setSamples(drawn);
  if (!drawn.isEmpty())
    plot_->setAxisAutoScale(curve.axis);
  else
    plot_->setAxisScale(curve.axis, curve.series.logarithmic ? 0.1 : 0.0, 1.0);
}

void DoublePlot::setMarked(int place) {
  marker_->setVisible(place >= 0);
  marker_->setXValue(place);
  plot_->replot();
}

int DoublePlot::leftCount() const { return static_cast<int>(left_.curve->dataSize()); }

QWidget* DoublePlot::canvas() const { return plot_->canvas(); }

QPoint DoublePlot::canvasPoint(int place) const {
  return {static_cast<int>(std::lround(plot_->transform(QwtPlot::xBottom, place))),
          canvas()->height() / 2};
}

void DoublePlot::applyColors(const PlotColors& colors) {
  marker_->setLinePen(colors.cursor, 2.0);
  left_.curve->setPen(colors.first, 1.5, Qt::SolidLine);
  left_.curve->setSymbol(
      new QwtSymbol(QwtSymbol::Ellipse, colors.first, QPen(colors.first), QSize(8, 8)));
  right_.curve->setPen(colors.second, 1.5, Qt::DashLine);
  right_.curve->setSymbol(
      new QwtSymbol(QwtSymbol::Diamond, colors.second, QPen(colors.second), QSize(10, 10)));
  nameQuantities({QStringLiteral("●"), left_.series.title, colors.first},
                 {QStringLiteral("◆"), right_.series.title, colors.second});
}

bool DoublePlot::eventFilter(QObject* watched, QEvent* event) {
  if (event->type() == QEvent::Resize) {
    nameIterations();
    QMetaObject::invokeMethod(plot_, &QwtPlot::replot, Qt::QueuedConnection);
  }
  if (event->type() != QEvent::MouseButtonPress) return QWidget::eventFilter(watched, event);
  const auto* mouse = static_cast<QMouseEvent*>(event);
  const double place = plot_->invTransform(QwtPlot::xBottom, mouse->pos().x());
  const int clicked = static_cast<int>(std::lround(place));
  if (clicked >= 0 && clicked < place_count_) Q_EMIT chosen(clicked);
  return true;
}

HistogramPlot::HistogramPlot(const QString& axis_title, const QString& all_title,
                             const QString& part_title)
    : Plot(110),
      all_(new QwtPlotHistogram(all_title)),
      part_(new QwtPlotHistogram(part_title)),
      axis_title_(axis_title) {
  all_->attach(plot_);
  part_->attach(plot_);
  marker_->setXValue(0.0);
  applyPalette();
}

void HistogramPlot::setCounts(double radius, const QVector<int>& all, const QVector<int>& part) {
  all_count_ = std::accumulate(all.begin(), all.end(), 0);
  all_->setSamples(samplesOf(radius, all));
  part_->setSamples(samplesOf(radius, part));
  plot_->setAxisScale(QwtPlot::xBottom, -radius, radius);
  plot_->replot();
}

void HistogramPlot::applyColors(const PlotColors& colors) {
  marker_->setLinePen(colors.cursor, 1.0, Qt::DashLine);
  all_->setPen(colors.second, 1.2);
  all_->setBrush(QBrush(colors.second, Qt::BDiagPattern));
  part_->setPen(QPen(Qt::NoPen));
  part_->setBrush(colors.first);
  nameQuantities({QStringLiteral("□"), all_->title().text(), colors.second},
                 {QStringLiteral("■"), part_->title().text(), colors.first});
  QwtText title(axis_title_);
  title.setFont(font());
  plot_->setAxisTitle(QwtPlot::xBottom, title);
}

}  // namespace boresight::ui
