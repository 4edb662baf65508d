// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <QString>
#include <QVector>
#include <QWidget>

class QwtPlot;
class QwtPlotGrid;
class QwtPlotHistogram;
class QwtPlotMarker;

namespace boresight::ui {

/// Counts over a symmetric interval: all of them as outlines, a part of them filled in front. Zero
/// is marked. Follows the palette.
class HistogramPlot : public QWidget {
  Q_OBJECT

 public:
  HistogramPlot(const QString& axis_title, const QString& all_title, const QString& part_title,
                QWidget* parent = nullptr);

  /// As many bins as counts (both the same), evenly over -radius ... radius.
  void setCounts(double radius, const QVector<int>& all, const QVector<int>& part);
  int allCount() const { return all_count_; }

 protected:
  void changeEvent(QEvent* event) override;

 private:
  void applyPalette();

  QwtPlot* plot_ = nullptr;
  QwtPlotGrid* grid_ = nullptr;
  QwtPlotHistogram* all_ = nullptr;
  QwtPlotHistogram* part_ = nullptr;
  QwtPlotMarker* zero_ = nullptr;
  QString axis_title_;
  int all_count_ = 0;
};

}  // namespace boresight::ui
