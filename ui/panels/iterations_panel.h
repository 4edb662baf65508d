// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <QPointF>
#include <QVector>
#include <QWidget>

#include "ui/models/iterations_model.h"
#include "ui/panels/run_scrubber.h"
#include "ui/state/view_state.h"

class QTableView;

namespace boresight::ui {

class DoublePlot;
class Banner;

/// The run as it went: where it stands, a scrubber, a table, plots. All of them show the cursor and
/// move it.
class IterationsPanel : public QWidget {
  Q_OBJECT

 public:
  explicit IterationsPanel(ViewState& view, QWidget* parent = nullptr);

  const IterationsModel& model() const { return model_; }
  RunScrubber& scrubber() const { return *scrubber_; }

 protected:
  void changeEvent(QEvent* event) override;

 private:
  void buildTable();
  QWidget* buildPlots();
  QVector<QPointF> pointsOf(IterationsModel::Column column) const;
  void fillPlots();
  void showSnapshot();
  void showCursor();
  void chooseRow(const QModelIndex& current);

  ViewState& view_;
  IterationsModel model_;
  Banner* banner_ = nullptr;
  RunScrubber* scrubber_ = nullptr;
  QTableView* table_ = nullptr;
  QWidget* plots_ = nullptr;
  DoublePlot* corrections_ = nullptr;
  DoublePlot* fit_ = nullptr;
  bool showing_ = false;  ///< the table follows the cursor, not a person
};

}  // namespace boresight::ui
