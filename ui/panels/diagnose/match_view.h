// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <memory>

#include <QWidget>

#include "ui_match_view.h"

#include "sessions/trace/match_details.h"
#include "sessions/trace/score_map.h"
#include "sessions/trace/trace.h"
#include "ui/models/rows_model.h"
#include "ui/run/task_runner.h"

namespace boresight::ui {

/// The templates of one iteration and their results, one row each, in their order.
class TemplatesModel : public RowsModel<sessions::MatchDetails> {
  Q_OBJECT

 public:
  enum Column {
    kNumber,
    kX_px,
    kY_px,
    kDepth_m,
    kDistinctness,
    kDx_px,
    kDy_px,
    kScore,
    kEdgeShare,
    kEmptyShare,
    kMargin,
    kResidual_px,
    kVerdict,
    kBorder,
  };
  /// Filter of the listed templates.
  enum class Show { kAll, kInliers, kOutliers, kLowMargin, kAtBorder, kNotSearched };

  TemplatesModel();

  /// nullptr, or an iteration without templates: no rows.
  void setIteration(const sessions::IterationTrace* iteration);
  /// "inlier", "outlier", "found", "not searched".
  static QString verdictOf(const sessions::MatchDetails& details);
  /// The names of `Show`, in its order.
  static QStringList showNames();
  bool isShown(int row, Show show) const;

 protected:
  QVariant look(const sessions::MatchDetails& row, int column, int role) const override;

 private:
  bool reached_match_ = false;
};

/// Details of one match: its template, the image found, their agreement, the scores around it, and
/// the figures.
class MatchView : public QWidget {
  Q_OBJECT

 public:
  explicit MatchView(QWidget* parent = nullptr);

  /// The iteration must hold the template. Its score map is computed on a worker thread.
  void showMatch(std::shared_ptr<const sessions::EdgeMapTrace> edges,
                 std::shared_ptr<const sessions::IterationTrace> iteration, int template_index);
  /// Whether the score map is still being computed.
  bool isComputing() const { return runner_.isBusy(); }
  /// Shows a sentence instead.
  void showNote(const QString& note);

 private:
  void showPictures(const sessions::EdgeMapTrace& edges, const sessions::IterationTrace& iteration,
                    std::size_t index, const Match* match);
  void showFigures(const sessions::IterationTrace& iteration,
                   const sessions::MatchDetails& details);

  Ui::MatchView ui_;
  TaskRunner runner_;
  TaskKind scoring_;
};

}  // namespace boresight::ui
