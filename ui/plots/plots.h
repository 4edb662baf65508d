// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <functional>

#include <QColor>
#include <QPointF>
#include <QString>
#include <QVector>
#include <QWidget>

#include "ui/plots/plot_colors.h"

class QwtPlot;
class QwtPlotCurve;
class QwtPlotGrid;
class QwtPlotHistogram;
class QwtPlotMarker;

namespace boresight::ui {

class NamedScale;

/// Common parts of plots: horizontal grid lines, a vertical line, and the palette's colours.
class Plot : public QWidget {
  Q_OBJECT

 protected:
  explicit Plot(int least_height_px);

  /// Applies colours and texts of the kind of plot.
  virtual void applyColors(const PlotColors& colors) = 0;
  /// Applies all colours and fonts. To be called once by the constructor of the derived class.
  void applyPalette();
  struct Quantity {
    QString sign;
    QString name;
    QColor color;
  };
  /// Names above the plot, in the colours and with the signs of the curves. Along a low axis the
  /// names would be cut, and a legend would take room.
  void nameQuantities(const Quantity& first, const Quantity& second);
  void changeEvent(QEvent* event) override;

  QwtPlot* plot_;
  QwtPlotGrid* grid_;
  QwtPlotMarker* marker_;
};

/// Two quantities over places 0, 1, 2, ..., each with its own axis: the first on the left (discs,
/// solid line), the second on the right (diamonds, dashed line). A click chooses a place.
class DoublePlot : public Plot {
  Q_OBJECT

 public:
  struct Series {
    QString title;
    bool logarithmic = false;
  };

  DoublePlot(const Series& left, const Series& right);

  /// Names places on the horizontal axis.
  void setNames(std::function<QString(int)> name_of);
  /// Points (place, value), in order; on a logarithmic axis values below 1e-6 are drawn there.
  void setPoints(int place_count, const QVector<QPointF>& left, const QVector<QPointF>& right);
  /// Marks a place; -1: none.
  void setMarked(int place);

  QWidget* canvas() const;
  /// Position of a place on the canvas, at half its height.
  QPoint canvasPoint(int place) const;
  int leftCount() const;

 Q_SIGNALS:
  void chosen(int place);

 protected:
  void applyColors(const PlotColors& colors) override;
  bool eventFilter(QObject* watched, QEvent* event) override;

 private:
  struct Curve {
    Series series;
    QwtPlotCurve* curve = nullptr;
    int axis = 0;
  };
  void addCurve(Curve& curve, const Series& series, int axis);
  void fill(Curve& curve, const QVector<QPointF>& points);
  void nameIterations();

  Curve left_;
  Curve right_;
  int place_count_ = 0;
  NamedScale* names_ = nullptr;
};

/// Counts over a symmetric interval: all of them as outlines, a part of them filled in front. Zero
/// is marked.
class HistogramPlot : public Plot {
  Q_OBJECT

 public:
  HistogramPlot(const QString& axis_title, const QString& all_title, const QString& part_title);

  /// As many bins as counts (both the same), evenly over -radius ... radius.
  void setCounts(double radius, const QVector<int>& all, const QVector<int>& part);
  int allCount() const { return all_count_; }

 protected:
  void applyColors(const PlotColors& colors) override;

 private:
  QwtPlotHistogram* all_ = nullptr;
  QwtPlotHistogram* part_ = nullptr;
  QString axis_title_;
  int all_count_ = 0;
};

}  // namespace boresight::ui
