// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <memory>

#include <QPointF>
#include <QVector>
#include <QWidget>

#include "ui/models/iterations_model.h"
#include "ui/panels/run_scrubber.h"
#include "ui/state/view_state.h"

namespace boresight::ui {

namespace Ui {
class IterationsPanel;
}

class DoublePlot;

/// The run as it went: where it stands, a scrubber, a table, plots. All of them show the cursor and
/// move it.
class IterationsPanel : public QWidget {
  Q_OBJECT

 public:
  explicit IterationsPanel(ViewState& view, QWidget* parent = nullptr);
  ~IterationsPanel() override;

  const IterationsModel& model() const { return model_; }
  RunScrubber& scrubber() const { return *scrubber_; }

 private:
  void buildTable();
  void buildPlots();
  QVector<QPointF> pointsOf(IterationsModel::Column column) const;
  void fillPlots();
  void showSnapshot();
  void showCursor();
  void chooseRow(const QModelIndex& current);

  ViewState& view_;
  IterationsModel model_;
  RunScrubber* scrubber_ = nullptr;
  DoublePlot* corrections_ = nullptr;
  DoublePlot* fit_ = nullptr;
  bool showing_ = false;  ///< the table follows the cursor, not a person
  const std::unique_ptr<Ui::IterationsPanel> ui_;
};

}  // namespace boresight::ui
