// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <functional>

#include <QPointF>
#include <QString>
#include <QVector>
#include <QWidget>

class QwtPlot;
class QwtPlotCurve;
class QwtPlotGrid;
class QwtPlotMarker;

namespace boresight::ui {

/// Two quantities over places 0, 1, 2, ..., each with its own axis: the first on the left (discs,
/// solid line), the second on the right (diamonds, dashed line). A click chooses a place. Follows
/// the palette.
class DoublePlot : public QWidget {
  Q_OBJECT

 public:
  struct Series {
    QString title;
    bool logarithmic = false;
  };

  DoublePlot(const Series& left, const Series& right, QWidget* parent = nullptr);

  /// Names places on the horizontal axis.
  void setNames(std::function<QString(int)> name_of);
  /// Points (place, value), in order; on a logarithmic axis values below 1e-6 are drawn there.
  void setPoints(int place_count, const QVector<QPointF>& left, const QVector<QPointF>& right);
  /// Marks a place; -1: none.
  void setMarked(int place);

  QWidget* canvas() const;
  /// Where a place is on the canvas; half way up.
  QPoint canvasPoint(int place) const;
  int leftCount() const { return left_.count; }

 Q_SIGNALS:
  void chosen(int place);

 protected:
  void changeEvent(QEvent* event) override;
  bool eventFilter(QObject* watched, QEvent* event) override;

 private:
  struct Curve {
    Series series;
    QwtPlotCurve* curve = nullptr;
    int axis = 0;
    int count = 0;
  };

  void addCurve(Curve& curve, const Series& series, int axis);
  void fill(Curve& curve, const QVector<QPointF>& points);
  void applyPalette();
  void nameIterations();
  void titleAxis(const Curve& curve, const QColor& color);

  QwtPlot* plot_ = nullptr;
  QwtPlotGrid* grid_ = nullptr;
  QwtPlotMarker* marker_ = nullptr;
  Curve left_;
  Curve right_;
  int place_count_ = 0;
  std::function<QString(int)> name_of_;
};

}  // namespace boresight::ui
