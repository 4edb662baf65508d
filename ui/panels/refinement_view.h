// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <QWidget>

#include "sessions/run/sample_statistics.h"

class QTableWidget;

namespace boresight::ui {

class HistogramPlot;

/// What a refinement found along the rendered edges: shares by kind of edge, and how far off the
/// image's edges were.
class RefinementView : public QWidget {
  Q_OBJECT

 public:
  explicit RefinementView(QWidget* parent = nullptr);

  void setIteration(const sessions::IterationTrace& iteration);

 private:
  void fillRow(int row, const QString& name, const sessions::SampleCounts& counts);

  QTableWidget* table_ = nullptr;
  HistogramPlot* histogram_ = nullptr;
};

}  // namespace boresight::ui
