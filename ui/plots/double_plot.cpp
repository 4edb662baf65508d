// SPDX-License-Identifier: Apache-2.0
#include "ui/plots/double_plot.h"

#include <algorithm>
#include <cmath>
#include <utility>

#include <QEvent>
#include <QFrame>
#include <QMouseEvent>
#include <QVBoxLayout>

#include <qwt_plot.h>
#include <qwt_plot_curve.h>
#include <qwt_plot_grid.h>
#include <qwt_plot_layout.h>
#include <qwt_plot_marker.h>
#include <qwt_scale_draw.h>
#include <qwt_scale_engine.h>
#include <qwt_symbol.h>
#include <qwt_text.h>

#include "ui/plots/plot_colors.h"

namespace boresight::ui {
namespace {

constexpr double kSmallest = 1e-6;

class NamedScale : public QwtScaleDraw {
 public:
  explicit NamedScale(std::function<QString(int)> name_of) : name_of_(std::move(name_of)) {}
  QwtText label(double value) const override {
    return QwtText(name_of_(static_cast<int>(std::lround(value))));
  }

 private:
  std::function<QString(int)> name_of_;
};

}  // namespace

DoublePlot::DoublePlot(const Series& left, const Series& right, QWidget* parent) : QWidget(parent) {
  plot_ = new QwtPlot(this);
  plot_->setMinimumSize(180, 90);
  auto* layout = new QVBoxLayout(this);
  layout->setContentsMargins(0, 0, 0, 0);
  layout->addWidget(plot_);
  plot_->setAxisMaxMinor(QwtPlot::xBottom, 0);
  if (auto* frame = qobject_cast<QFrame*>(plot_->canvas())) frame->setFrameShape(QFrame::NoFrame);
  plot_->canvas()->installEventFilter(this);
  plot_->canvas()->setCursor(Qt::PointingHandCursor);
  plot_->canvas()->setToolTip(tr("Click to go to an iteration."));
  grid_ = new QwtPlotGrid;
  grid_->enableX(false);
  grid_->attach(plot_);
  marker_ = new QwtPlotMarker;
  marker_->setLineStyle(QwtPlotMarker::VLine);
  marker_->attach(plot_);
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
  if (series.logarithmic) plot_->setAxisScaleEngine(axis, new QwtLogScaleEngine);
}

void DoublePlot::setNames(std::function<QString(int)> name_of) {
  name_of_ = name_of;
  plot_->setAxisScaleDraw(QwtPlot::xBottom, new NamedScale(std::move(name_of)));
}

void DoublePlot::setPoints(int place_count, const QVector<QPointF>& left,
                           const QVector<QPointF>& right) {
  place_count_ = place_count;
  fill(left_, left);
  fill(right_, right);
  nameIterations();
  plot_->replot();
}

/// As many names as have room beside each other.
void DoublePlot::nameIterations() {
  const int last = std::max(0, place_count_ - 1);
  const QString widest = (name_of_ ? name_of_(last) : QString::number(last)) + QLatin1Char(' ');
  const int name_px = fontMetrics().horizontalAdvance(widest);
  const double most = std::max(1, plot_->canvas()->width() / name_px);
  const double step = std::max(1.0, std::ceil(place_count_ / most));
  plot_->setAxisScale(QwtPlot::xBottom, -0.4, std::max(1, place_count_) - 0.6, step);
}

void DoublePlot::fill(Curve& curve, const QVector<QPointF>& points) {
  QVector<QPointF> drawn = points;
  if (curve.series.logarithmic)
    for (QPointF& point : drawn) point.setY(std::max(point.y(), kSmallest));
  curve.count = static_cast<int>(drawn.size());
  curve.curve->setSamples(drawn);
  if (curve.count > 0) {
    plot_->setAxisAutoScale(curve.axis);
  } else {
    plot_->setAxisScale(curve.axis, curve.series.logarithmic ? 0.1 : 0.0, 1.0);
  }
}

void DoublePlot::setMarked(int place) {
  marker_->setVisible(place >= 0);
  marker_->setXValue(place);
  plot_->replot();
}

QWidget* DoublePlot::canvas() const { return plot_->canvas(); }

QPoint DoublePlot::canvasPoint(int place) const {
  return {static_cast<int>(std::lround(plot_->transform(QwtPlot::xBottom, place))),
          canvas()->height() / 2};
}

/// The title has the curve's sign and colour, so that no legend takes room.
void DoublePlot::titleAxis(const Curve& curve, const QColor& color) {
  const bool left = curve.axis == QwtPlot::yLeft;
  QwtText title((left ? QStringLiteral("● ") : QStringLiteral("◆ ")) + curve.series.title);
  title.setFont(font());
  title.setColor(color);
  plot_->setAxisTitle(curve.axis, title);
  plot_->setAxisFont(curve.axis, font());
}

void DoublePlot::applyPalette() {
  const PlotColors colors = plotColors(palette());
  plot_->setCanvasBackground(palette().brush(QPalette::Base));
  grid_->setPen(colors.grid, 0.0, Qt::DotLine);
  marker_->setLinePen(colors.cursor, 2.0);
  left_.curve->setPen(colors.first, 1.5, Qt::SolidLine);
  left_.curve->setSymbol(
      new QwtSymbol(QwtSymbol::Ellipse, colors.first, QPen(colors.first), QSize(8, 8)));
  right_.curve->setPen(colors.second, 1.5, Qt::DashLine);
  right_.curve->setSymbol(
      new QwtSymbol(QwtSymbol::Diamond, colors.second, QPen(colors.second), QSize(10, 10)));
  titleAxis(left_, colors.first);
  titleAxis(right_, colors.second);
  plot_->setAxisFont(QwtPlot::xBottom, font());
  plot_->replot();
}

void DoublePlot::changeEvent(QEvent* event) {
  QWidget::changeEvent(event);
  const bool look = event->type() == QEvent::PaletteChange || event->type() == QEvent::FontChange;
  if (look && right_.curve != nullptr) applyPalette();
}

bool DoublePlot::eventFilter(QObject* watched, QEvent* event) {
  if (watched == plot_->canvas() && event->type() == QEvent::Resize) {
    nameIterations();
    QMetaObject::invokeMethod(
        plot_, [plot = plot_] { plot->replot(); }, Qt::QueuedConnection);
  }
  if (watched != plot_->canvas() || event->type() != QEvent::MouseButtonPress)
    return QWidget::eventFilter(watched, event);
  const auto* mouse = static_cast<QMouseEvent*>(event);
  const double place = plot_->invTransform(QwtPlot::xBottom, mouse->pos().x());
  const int clicked = static_cast<int>(std::lround(place));
  if (clicked >= 0 && clicked < place_count_) Q_EMIT chosen(clicked);
  return true;
}

}  // namespace boresight::ui
