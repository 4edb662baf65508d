// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <memory>
#include <vector>

#include <QPointF>
#include <QVector>
#include <QWidget>

#include "ui_iterations_panel.h"
#include "ui_run_scrubber.h"

#include "core/localizer/localizer.h"
#include "sessions/trace/trace.h"
#include "ui/models/rows_model.h"
#include "ui/state/view_state.h"

class QAction;
class QButtonGroup;

namespace boresight::ui {

class DoublePlot;
class EmptyHint;

/// The stages of an iteration that can be shown, up to the one that it reached.
std::vector<Stage> stagesOf(const sessions::IterationTrace& iteration);

/// Index of the stage shown for the cursor: the last one not after it, or 0.
int shownStage(const std::vector<Stage>& stages, Stage cursor);

/// The cursor moved by `steps` stages (negative: back), across iterations, up to the ends. The last
/// stage of an iteration is kFinished, so that a cursor there follows an iteration under way.
RunCursor stageFrom(const sessions::LocalizationTrace& run, const RunCursor& cursor, int steps);

/// Walks the cursor through a run: a slider over the iterations (leftmost: the seed), buttons, and
/// one button per stage of the chosen iteration. The window gives the actions their shortcuts.
class RunScrubber : public QWidget {
  Q_OBJECT

 public:
  enum class Step { kFirst, kPrevious, kNext, kLast, kPreviousStage, kNextStage };
  static constexpr int kStepCount = 6;

  explicit RunScrubber(ViewState& view);

  QAction* action(Step step) const { return actions_[static_cast<std::size_t>(step)]; }

 private:
  void go(Step step);
  void chooseStage(int index);
  void showCursor();
  void showPlace();
  void showStages();

  ViewState& view_;
  std::array<QAction*, kStepCount> actions_{};
  QButtonGroup* stages_ = nullptr;
  Ui::RunScrubber ui_;
};

/// A row: the seed or an iteration.
struct IterationRow {
  QString name;                                           ///< "2.3", or "seed"
  std::shared_ptr<const sessions::IterationTrace> trace;  ///< nullptr: the seed
  QString status;
};

/// A run as a table: the seed, then one row per iteration. A snapshot that continues the former one
/// appends rows and keeps selections.
class IterationsModel : public RowsModel<IterationRow> {
  Q_OBJECT

 public:
  enum Column {
    kNumber,
    kKind,
    kHypothesis,
    kLevel,
    kTranslation_mm,
    kRotation_deg,
    kImage_px,
    kTemplates,
    kMatches,
    kInliers,
    kThreshold_px,
    kBestScore,
    kMeanScore,
    kRms_px,
    kRendering_ms,
    kMatching_ms,
    kPose_ms,
    kStatus,
  };
  using SnapshotPtr = std::shared_ptr<const sessions::LocalizationTrace>;

  IterationsModel();

  void setSnapshot(SnapshotPtr snapshot);

  /// Rows are the cursor's iterations moved by one: the seed is row 0.
  static int rowOf(int iteration) { return iteration + 1; }
  static int iterationOf(int row) { return row - 1; }
  /// "2.3": the third iteration of the second attempt; "seed" for -1.
  QString iterationName(int iteration) const;
  /// A cell's number, unrounded; NaN when there is none.
  double number(int iteration, Column column) const;

 protected:
  QVariant look(const IterationRow& row, int column, int role) const override;

 private:
  SnapshotPtr snapshot_;
};

/// The course of the run as a table and plots. Both show the cursor and move it.
class IterationsPanel : public QWidget {
  Q_OBJECT

 public:
  explicit IterationsPanel(ViewState& view);

  const IterationsModel& model() const { return model_; }

 private:
  void buildTable();
  QVector<QPointF> pointsOf(IterationsModel::Column column) const;
  void showSnapshot();
  void showCursor();

  ViewState& view_;
  IterationsModel model_;
  EmptyHint* hint_ = nullptr;
  DoublePlot* corrections_ = nullptr;
  DoublePlot* fit_ = nullptr;
  bool showing_ = false;  ///< the table is being updated by the cursor, not the operator
  Ui::IterationsPanel ui_;
};

}  // namespace boresight::ui
